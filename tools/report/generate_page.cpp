#include <algorithm>
#include <limits>
#include <span>

#include "vmesh/evaluation/vessel_distance.h"

#include "report/fit_report.h"
#include "report/page_content.h"
#include "report/pages.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kMostDefects = 10;

PageSurface reference_surface(const TriMesh& mesh) { return {"reference", mesh, {}, true}; }

void add_fit_facts(Page& page, const FitReport& fit) {
  page.facts.push_back({"To the reference, mm, mean / 95 %", mean_and_max(fit.after.mean(), fit.after.p95())});
  page.facts.push_back({"The same before the fit", mean_and_max(fit.before.mean(), fit.before.p95())});
  page.facts.push_back({"Hausdorff to it, mm", short_number(fit.after.hausdorff.upper())});
}

void add_contacts(Page& page, const std::vector<Contact>& contacts, const char* label) {
  for (const Contact& contact : std::span(contacts).first(std::min(kMarksOfEach, contacts.size())))
    page.places.push_back({label, short_number(contact.depth) + " mm deep", contact.position, "", ""});
}

/// "crossing faces"
std::string words(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

void add_places(Page& page, const GenerateReport& report, const PageSurface& surface) {
  const std::vector<Defect>& defects = report.result->defects;
  for (const Defect& defect : std::span(defects).first(std::min(kMostDefects, defects.size())))
    page.places.push_back(
        {"Defect: " + words(to_string(defect.kind)), std::to_string(defect.count), defect.position, "", ""});
  if (report.fit) {
    add_farthest(page, report.fit->after.hausdorff);
    add_unmatched(page, *report.fit, kMarksOfEach);
  } else {
    page.places.push_back({"Farthest from the vessels, in their radii",
                           short_number(report.deviation.max_relative) + " radii", report.deviation.max_at,
                           "relative_distance", ""});
    add_largest(page, surface, "volume_distance", "Vertex far from the vessels", " mm", kMarksOfEach);
  }
  add_largest(page, surface, "EquiangleSkewness", "Skew triangle", "", kMarksOfEach);
  for (const UnprovenPlace& place : report.result->error.unproven_places)
    page.places.push_back({"Limit not proven", std::to_string(place.faces) + " faces", place.position, "", ""});
  add_contacts(page, report.contacts, "Vessels touched");
  if (!report.separation) return;
  add_contacts(page, report.separation->left, "Vessels still touch");
  const std::vector<VesselMove>& moves = report.separation->moves;
  for (const VesselMove& move : std::span(moves).first(std::min(kMarksOfEach, moves.size())))
    page.places.push_back(
        {"Vessel moved aside", short_number(move.displacement.norm()) + " mm", move.position, "", ""});
}

/// To the vessels: in mm, and for each by its own radius. Caps and what goes on from ends are not of the wall.
void add_distances(const GenerateReport& report, const Centerline& grown, MeshAttributes& attributes) {
  const GenerateResult& result = *report.result;
  const VesselField field(grown, report.arguments->production.growth.blend);
  MeshAttribute mm{"volume_distance", vertex_vessel_distances(result.mesh, field)}, radii{"relative_distance", {}};
  for (std::size_t v = report.wall_vertices; v < mm.values.size(); ++v)
    mm.values[v] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t v = 0; v < mm.values.size(); ++v) radii.values.push_back(mm.values[v] / result.radius[v]);
  attributes.vertex.push_back(std::move(mm));
  attributes.vertex.push_back(std::move(radii));
}

void add_facts(Page& page, const GenerateReport& report) {
  const TriMesh& mesh = report.result->mesh;
  page.facts = {
      {"Sound", report.result->is_sound() ? "yes" : "no"},
      {"Vertices", std::to_string(mesh.vertices.size())},
      {"Skewness, mean / max", mean_and_max(report.measurement.skewness.mean, report.measurement.skewness.max)}};
  if (report.fit) return add_fit_facts(page, *report.fit);
  page.facts.push_back(
      {"Faces to the vessels, mm, mean / max", mean_and_max(report.deviation.mean_mm, report.deviation.max_mm)});
  page.facts.push_back(
      {"The same in radii, mean / max", mean_and_max(report.deviation.mean_relative, report.deviation.max_relative)});
  page.facts.push_back({"Centerline", std::to_string(report.cleaned->centerline.nodes().size()) + " nodes"});
}

}  // namespace

Page page_of(const GenerateReport& report, const Centerline& grown, MeshAttributes attributes,
             const TriMesh* reference) {
  const GenerateArguments& arguments = *report.arguments;
  const TriMesh& mesh = report.result->mesh;
  Page page = make_page("generate", arguments.output, arguments.common);
  page.options = describe(arguments);
  add_distances(report, grown, attributes);
  if (reference && report.fit)
    attributes.vertex.push_back({"distance", vertex_distances(mesh, ClosestPointIndex(*reference))});
  page.surfaces.push_back({"surface", mesh, std::move(attributes)});
  if (reference) page.surfaces.push_back(reference_surface(*reference));
  page.centerline = report.cleaned->centerline;
  page.warnings = report.warnings;
  page.warnings.insert(page.warnings.end(), report.problems.begin(), report.problems.end());
  add_facts(page, report);
  add_places(page, report, page.surfaces.front());
  add_histograms(page, page.surfaces.front());
  page.tables = tables_of(to_json(report));
  return page;
}

Page page_of(const CommonArguments& common, const FitReport& report, const Json& summary, const TriMesh& mesh,
             MeshAttributes attributes, const TriMesh& reference, const Centerline& centerline) {
  Page page = make_page("fit", summary["output"].get<std::string>(), common);
  page.options = summary["options"].get<std::string>();
  attributes.vertex.push_back({"distance", vertex_distances(mesh, ClosestPointIndex(reference))});
  page.surfaces = {{"surface", mesh, std::move(attributes)}, reference_surface(reference)};
  page.centerline = centerline;
  page.warnings = summary["warnings"].get<std::vector<std::string>>();
  page.facts = {{"Vertices", std::to_string(mesh.vertices.size())},
                {"Skewness, mean / max",
                 mean_and_max(summary["skewness"]["mean"].get<double>(), summary["skewness"]["max"].get<double>())}};
  add_fit_facts(page, report);
  add_farthest(page, report.after.hausdorff);
  add_unmatched(page, report, kMarksOfEach);
  add_largest(page, page.surfaces.front(), "distance", "Vertex far from the reference", " mm", kMarksOfEach);
  add_largest(page, page.surfaces.front(), "EquiangleSkewness", "Skew triangle", "", kMarksOfEach);
  add_histograms(page, page.surfaces.front());
  page.tables = tables_of(summary);
  return page;
}

}  // namespace vmesh::tool
