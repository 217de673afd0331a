#include "vmesh/comparison/paper_table.h"

#include "report/evaluation_report.h"
#include "report/table2_report.h"

namespace vmesh::tool {
namespace {

Json to_json(const SourceFile& file) {
  return file.path.empty() ? Json() : Json{{"file", file.path}, {"sha256", file.sha256}};
}

Json to_json(const Table2Source& source) {
  Json json = {{"vessels", source.vessels},
               {"reference", to_json(source.reference)},
               {"centerline", to_json(source.centerline)},
               {"contour_of", nullptr},
               {"extraction", source.extraction ? tool::to_json(*source.extraction) : Json()}};
  if (source.contour_of.empty()) return json;
  json["contour_of"] = source.contour_of;
  json["spacing_mm"] = {source.spacing.x(), source.spacing.y(), source.spacing.z()};
  json["components"] = source.components;
  return json;
}

Json to_json(const PaperRow& row) {
  return {{"vertices", row.vertices},
          {"faces", row.faces},
          {"skewness", {{"mean", row.skewness_mean}, {"max", row.skewness_max}}},
          {"hausdorff_mm", row.hausdorff_mm ? Json(*row.hausdorff_mm) : Json()}};
}

Json to_json(const ReferenceDistance& distance) {
  const Hausdorff& h = distance.hausdorff;
  return {{"hausdorff_mm", {{"lower", h.lower()}, {"upper", h.upper()}}},
          {"from_surface", side_json(h.forward, distance.from_surface)},
          {"from_reference", side_json(h.backward, distance.from_reference)}};
}

Json to_json(const SurfaceSoundness& soundness) {
  const Topology& topology = soundness.topology;
  return {{"closed", topology.closed},     {"manifold", topology.manifold},
          {"oriented", topology.oriented}, {"components", topology.components},
          {"genus", topology.genus},       {"self_intersections", soundness.self_intersections}};
}

Json to_json(const MethodRow& row) {
  return {{"surface", to_string(row.method)},
          {"around", row.around > 0 ? Json(row.around) : Json()},
          {"vertices", row.mesh.vertices.size()},
          {"faces", row.mesh.faces.size()},
          {"skewness", {{"mean", row.skewness.mean}, {"max", row.skewness.max}}},
          {"distance", row.distance ? to_json(*row.distance) : Json()},
          {"soundness", row.soundness ? to_json(*row.soundness) : Json()},
          {"paper", row.method <= SurfaceMethod::high_resolution ? to_json(paper_row(row.method)) : Json()}};
}

Json rows_json(const MethodComparison& comparison) {
  Json rows = Json::array();
  for (const MethodRow& row : comparison.rows) rows.push_back(to_json(row));
  return rows;
}

Json demands_json(const MethodComparison& comparison) {
  Json demands = Json::array();
  for (const TableDemand& demand : check_demands(comparison))
    demands.push_back({{"what", demand.what},
                       {"found", demand.found},
                       {demand.below ? "below" : "at_most", demand.limit},
                       {"met", demand.met()}});
  return demands;
}

Json paper_json(const MethodComparison& comparison) {
  Json figures = Json::array();
  for (const PaperFigure& figure : compare_with_paper(comparison))
    figures.push_back({{"surface", to_string(figure.method)},
                       {"what", figure.what},
                       {"here", figure.ours},
                       {"paper", figure.paper},
                       {"worse", figure.worse()}});
  return figures;
}

}  // namespace

Json to_json(const Table2Report& report) {
  return {{"schema", "vmesh.table2/1"},
          {"generator", generator_json()},
          {"source", to_json(report.source)},
          {"centerline", to_json(report.centerline)},
          {"tolerance_mm", report.tolerance_mm},
          {"rows", rows_json(report.comparison)},
          {"demands", demands_json(report.comparison)},
          {"against_paper", paper_json(report.comparison)},
          {"warnings", report.warnings}};
}

}  // namespace vmesh::tool
