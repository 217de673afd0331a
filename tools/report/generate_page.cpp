#include "report/fit_report.h"
#include "report/growth_content.h"
#include "report/page_content.h"
#include "report/pages.h"

namespace vmesh::tool {
namespace {

PageSurface reference_surface(const TriMesh& mesh) { return {"reference", mesh, {}, true}; }

void add_fit_facts(Page& page, const FitReport& fit) {
  page.facts.push_back({"To the reference, mm, mean / 95 %", mean_and_max(fit.after.mean(), fit.after.p95())});
  page.facts.push_back({"The same before the fit", mean_and_max(fit.before.mean(), fit.before.p95())});
  page.facts.push_back({"Hausdorff to it, mm", short_number(fit.after.hausdorff.upper())});
}

void add_places(Page& page, const GenerateReport& report, const PageSurface& surface) {
  add_defects(page, report.result->defects);
  if (report.fit) {
    add_farthest(page, report.fit->after.hausdorff);
    add_unmatched(page, *report.fit, kMarksOfEach);
  } else {
    add_farthest_from_vessels(page, report.deviation, surface);
  }
  add_largest(page, surface, "EquiangleSkewness", "Skew triangle", "", kMarksOfEach);
  add_unproven(page, report.result->error);
  add_contacts(page, report.contacts, "Vessels touched");
  if (report.separation) add_separation(page, *report.separation);
}

void add_facts(Page& page, const GenerateReport& report) {
  const TriMesh& mesh = report.result->mesh;
  page.facts = {
      {"Sound", report.result->is_sound() ? "yes" : "no"},
      {"Vertices", std::to_string(mesh.vertices.size())},
      {"Skewness, mean / max", mean_and_max(report.measurement.skewness.mean, report.measurement.skewness.max)}};
  if (report.fit) return add_fit_facts(page, *report.fit);
  add_facts_of(page, report.deviation);
  page.facts.push_back({"Centerline", std::to_string(report.cleaned->centerline.nodes().size()) + " nodes"});
}

}  // namespace

Page page_of(const GenerateReport& report, const Centerline& grown, MeshAttributes attributes,
             const TriMesh* reference) {
  const GenerateArguments& arguments = *report.arguments;
  const TriMesh& mesh = report.result->mesh;
  Page page = make_page("generate", arguments.output, arguments.common);
  page.options = describe(arguments);
  const VesselField field(grown, arguments.production.growth.blend);
  add_vessel_distances(*report.result, field, report.wall_vertices, attributes);
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
