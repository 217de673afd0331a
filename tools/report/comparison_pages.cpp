#include <algorithm>
#include <span>

#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/sampled_distance.h"

#include "report/page_content.h"
#include "report/pages.h"

namespace vmesh::tool {
namespace {

void add_defects(Page& page, const TriMesh& mesh, const DefectReport& defects) {
  PlacesApart apart(mesh);
  std::size_t crossings = 0;
  for (const IntersectingFaces& pair : defects.self_intersections) {
    if (crossings == kMarksOfEach) break;
    if (!apart.take(pair.position)) continue;
    ++crossings;
    page.places.push_back({"Faces " + std::to_string(pair.first) + " and " + std::to_string(pair.second) + " cross", "",
                           pair.position, "", ""});
  }
  const auto add = [&](const std::vector<Index>& faces, const char* label) {
    for (const Index face : std::span(faces).first(std::min(kMarksOfEach, faces.size())))
      page.places.push_back({label, "face " + std::to_string(face), mesh.vertices[mesh.faces[face][0]], "", ""});
  };
  add(defects.degenerate_faces, "Face without area");
  add(defects.duplicate_faces, "Face that is there twice");
}

void add_places(Page& page, const EvaluationReport& report, const TriMesh& mesh) {
  add_defects(page, mesh, report.defects);
  if (report.reference) add_farthest(page, report.reference->hausdorff);
  if (report.volume) {
    const VesselDistance& d = report.volume->distance;
    page.places.push_back({"Farthest from the vessels", short_number(d.from_mesh.mm.max) + " mm", d.from_mesh.max_at,
                           "volume_distance", ""});
    page.places.push_back({"Of the vessels, farthest from the surface", short_number(d.from_volume.mm.max) + " mm",
                           d.from_volume.max_at, "volume_distance", ""});
  }
  add_largest(page, page.surfaces.front(), "EquiangleSkewness", "Skew triangle", "", kMarksOfEach);
}

void add_facts(Page& page, const EvaluationReport& report) {
  const Distribution skewness = summarize(report.measures.equiangle_skewness);
  const Topology& topology = report.defects.topology;
  page.facts = {{"Vertices", std::to_string(report.vertices)},
                {"Closed, manifold", topology.closed && topology.manifold ? "yes" : "no"},
                {"Skewness, mean / max", mean_and_max(skewness.mean, skewness.max)},
                {"Crossing pairs of faces", std::to_string(report.defects.self_intersections.size())}};
  if (report.reference) {
    const ReferenceComparison& r = *report.reference;
    page.facts.push_back(
        {"To the reference, mm, mean / 95 %", mean_and_max(r.forward.distance.mean, r.forward.distance.p95)});
    page.facts.push_back({"Hausdorff to it, mm", short_number(r.hausdorff.upper())});
  }
  if (report.volume) {
    const VesselDistanceSide& side = report.volume->distance.from_mesh;
    page.facts.push_back({"To the vessels, mm, mean / max", mean_and_max(side.mm.mean, side.mm.max)});
    page.facts.push_back({"In vessel radii, mean / max", mean_and_max(side.relative.mean, side.relative.max)});
  }
}

PageSurface surface_of(const MethodRow& row, const ClosestPointIndex& other) {
  PageSurface surface{name_of(row), row.mesh, {}, !row.distance};
  surface.attributes.vertex = {{"distance", vertex_distances(row.mesh, other)}};
  surface.attributes.face = {{"EquiangleSkewness", equiangle_skewness(row.mesh)}};
  return surface;
}

/// Ours first, the reference last.
void add_surfaces(Page& page, const MethodComparison& comparison) {
  const MethodRow& reference = comparison.row(SurfaceMethod::marching_cubes);
  const ClosestPointIndex to_reference(reference.mesh);
  const ClosestPointIndex to_low(comparison.row(SurfaceMethod::low_resolution).mesh);
  for (const MethodRow& row : comparison.rows)
    if (row.around > 0) page.surfaces.push_back(surface_of(row, to_reference));
  for (const MethodRow& row : comparison.rows)
    if (row.around == 0) page.surfaces.push_back(surface_of(row, row.distance ? to_reference : to_low));
  std::stable_partition(page.surfaces.begin(), page.surfaces.end(), [](const PageSurface& s) { return !s.reference; });
}

void add_farthest(Page& page, const MethodRow& row) {
  if (!row.distance) return;
  const OneSidedHausdorff& side = row.distance->hausdorff.larger();
  page.places.push_back({"Hausdorff distance of " + name_of(row), short_number(side.upper) + " mm", side.witness.from,
                         "distance", name_of(row)});
}

}  // namespace

Page page_of(const CommonArguments& common, const EvaluationReport& report, const TriMesh& mesh,
             MeshAttributes attributes, const TriMesh* reference, const Centerline* centerline) {
  Page page = make_page("evaluate", report.file, common);
  page.surfaces.push_back({"surface", mesh, std::move(attributes)});
  if (reference) page.surfaces.push_back({"reference", *reference, {}, true});
  if (centerline) page.centerline = *centerline;
  page.warnings = report.warnings;
  add_facts(page, report);
  add_places(page, report, mesh);
  add_histograms(page, page.surfaces.front());
  page.tables = to_tables(report);
  return page;
}

Page page_of(const CommonArguments& common, const Table2Report& report) {
  const MethodComparison& comparison = report.comparison;
  Page page = make_page("table2", report.source.vessels, common);
  page.title = report.source.vessels;
  add_surfaces(page, comparison);
  page.centerline = report.centerline;
  page.warnings = report.warnings;
  const MethodRow &low = comparison.row(SurfaceMethod::low_resolution),
                  &cubes = comparison.row(SurfaceMethod::marching_cubes);
  page.facts = {{"Low resolution", std::to_string(low.mesh.vertices.size()) + " vertices"},
                {"Marching cubes", std::to_string(cubes.mesh.vertices.size()) + " vertices"},
                {"Skewness of low, mean / max", mean_and_max(low.skewness.mean, low.skewness.max)},
                {"Hausdorff of low, mm", short_number(low.distance->hausdorff.upper())}};
  for (const MethodRow& row : comparison.rows) add_farthest(page, row);
  add_largest(page, page.surfaces.front(), "EquiangleSkewness", "Skew triangle", "", kMarksOfEach);
  add_histograms(page, page.surfaces.front());
  page.tables = to_tables(report);
  return page;
}

Page page_of(const CommonArguments& common, const std::filesystem::path& input, const Centerline& centerline,
             const std::vector<TradeoffPoint>& points, std::vector<ReportTable> tables) {
  Page page = make_page("tradeoff", input, common);
  page.centerline = centerline;
  page.facts = {{"Surfaces", std::to_string(points.size())},
                {"Centerline", std::to_string(centerline.nodes().size()) + " nodes"}};
  page.pictures = {{"Mean error against time and against vertices", plot_tradeoff(points)}};
  page.tables = std::move(tables);
  return page;
}

Page page_of(const CommonArguments& common, const std::filesystem::path& script, const Json& summary,
             const TriMesh& rest, const TriMesh& moved, MeshAttributes attributes, const Centerline& centerline,
             PageFrames frames) {
  Page page = make_page("deform", script, common);
  page.facts = {{"Frames", std::to_string(summary["frames"].get<std::size_t>())},
                {"Vertices", std::to_string(rest.vertices.size())},
                {"Largest displacement, mm", short_number(summary["largest_displacement_mm"].get<double>())},
                {"Centerline", std::to_string(centerline.nodes().size()) + " nodes"}};
  if (frames.every() > 1)
    page.warnings = {"Of every " + std::to_string(frames.every()) +
                     " frames one is shown, so that the page stays small."};
  const PageSurface last{"surface", moved, attributes};
  page.surfaces.push_back({"surface", rest, std::move(attributes)});
  page.centerline = centerline;
  add_largest(page, last, "displacement", "At the end", " mm", kMarksOfEach);
  add_histograms(page, last);
  page.tables = tables_of(summary);
  page.frames = std::move(frames);
  return page;
}

}  // namespace vmesh::tool
