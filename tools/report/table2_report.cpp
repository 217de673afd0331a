#include "report/table2_report.h"

#include "vmesh/comparison/paper_table.h"

#include "report/evaluation_report.h"

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
  json["spacing_mm"] = tool::to_json(source.spacing);
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
  return {{"hausdorff_mm", tool::to_json(h)},
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
          {"skewness", tool::to_json(row.skewness)},
          {"distance", row.distance ? to_json(*row.distance) : Json()},
          {"soundness", row.soundness ? to_json(*row.soundness) : Json()},
          {"paper", row.method <= SurfaceMethod::high_resolution ? to_json(paper_row(row.method)) : Json()}};
}

Json to_json(const TableDemand& demand) {
  return {{"what", demand.what},
          {"found", demand.found},
          {demand.below ? "below" : "at_most", demand.limit},
          {"met", demand.met()}};
}

Json to_json(const PaperFigure& figure) {
  return {{"surface", to_string(figure.method)},
          {"what", figure.what},
          {"here", figure.ours},
          {"paper", figure.paper},
          {"worse", figure.worse()}};
}

}  // namespace

Json to_json(const Table2Report& report) {
  const auto convert = [](const auto& element) { return to_json(element); };
  return {{"schema", "vmesh.table2/1"},
          {"generator", generator_json()},
          {"source", to_json(report.source)},
          {"centerline", to_json(report.centerline)},
          {"tolerance_mm", report.tolerance_mm},
          {"rows", list_json(report.comparison.rows, convert)},
          {"demands", list_json(check_demands(report.comparison), convert)},
          {"against_paper", list_json(compare_with_paper(report.comparison), convert)},
          {"warnings", report.warnings}};
}

namespace {

using Row = std::vector<std::string>;

std::string interval(double lower, double upper) {
  return format_lower_bound(lower) + " to " + format_upper_bound(upper);
}

ReportTable source_table(const Table2Report& report) {
  const Table2Source& source = report.source;
  const Centerline& centerline = report.centerline;
  ReportTable table{"source", "Vessels: " + source.vessels, {"property", "value"}, {}};
  const auto add = [&](const char* name, const std::string& value) { table.rows.push_back({name, value}); };
  if (source.contour_of.empty()) {
    add("reference", "the surface as it came");
  } else {
    add("reference",
        "marching cubes of " + (source.contour_of == "grey" ? std::string("grey values") : "a binary volume"));
    add("voxels, mm", format_number(source.spacing.x()) + " x " + format_number(source.spacing.y()) + " x " +
                          format_number(source.spacing.z()));
    add("components of the contour", std::to_string(source.components));
  }
  add("centerline", source.extraction ? "extracted from the reference" : "given");
  add("its nodes", std::to_string(centerline.nodes().size()));
  add("its components", std::to_string(centerline.component_count()));
  add("its loops", std::to_string(centerline.cycle_rank()));
  if (!source.extraction) return table;
  add("reference to the boundary of its vessels, mean, mm", format_number(source.extraction->wall.mean));
  add("the same at 95 %, mm", format_number(source.extraction->wall.percentile_95));
  add("parts of the reference that were joined", std::to_string(source.extraction->joined.size()));
  add("parts that were left out", std::to_string(source.extraction->left_out));
  return table;
}

Row our_row(const MethodRow& row) {
  Row cells = {name_of(row), std::to_string(row.mesh.vertices.size()), std::to_string(row.mesh.faces.size()),
               format_number(row.skewness.mean), format_number(row.skewness.max)};
  if (!row.distance) {
    cells.resize(9, "-");
    return cells;
  }
  const Hausdorff& h = row.distance->hausdorff;
  const Distribution& sampled = row.distance->from_reference.distance;
  cells.push_back(interval(h.lower(), h.upper()));
  for (const double value : {sampled.mean, sampled.rms, sampled.p95}) cells.push_back(format_number(value));
  return cells;
}

Row row_of_paper(SurfaceMethod method) {
  const PaperRow& row = paper_row(method);
  return {std::string(to_string(method)) + ", paper",
          std::to_string(row.vertices),
          std::to_string(row.faces),
          format_number(row.skewness_mean),
          format_number(row.skewness_max),
          row.hausdorff_mm ? format_number(*row.hausdorff_mm) : "-",
          "-",
          "-",
          "-"};
}

ReportTable main_table(const MethodComparison& comparison) {
  ReportTable table{
      "table2",
      "Table 2; Hausdorff distance both ways, guaranteed; mean, RMS and 95 % of samples of the reference; "
      "the paper's are of other vessels",
      {"surface", "vertices", "faces", "skewness, mean", "skewness, max", "Hausdorff, mm", "mean, mm", "RMS, mm",
       "95 %, mm"},
      {}};
  for (const MethodRow& row : comparison.rows) {
    table.rows.push_back(our_row(row));
    if (row.method <= SurfaceMethod::high_resolution) table.rows.push_back(row_of_paper(row.method));
  }
  return table;
}

Row direction_row(const std::string& name, const OneSidedHausdorff& side, const SampledDistance& sampled) {
  Row row = {name, interval(side.lower, side.upper)};
  for (const double value : {sampled.distance.mean, sampled.distance.rms, sampled.distance.p95}) {
    row.push_back(format_number(value));
  }
  row.push_back(format_point(side.witness.from));
  return row;
}

ReportTable directions_table(const MethodComparison& comparison) {
  ReportTable table{
      "directions", "Distances each way, mm", {"from, to", "Hausdorff", "mean", "RMS", "95 %", "farthest point"}, {}};
  for (const MethodRow& row : comparison.rows) {
    if (!row.distance) continue;
    const ReferenceDistance& distance = *row.distance;
    const std::string name = name_of(row);
    table.rows.push_back(direction_row(name + " to reference", distance.hausdorff.forward, distance.from_surface));
    table.rows.push_back(direction_row("reference to " + name, distance.hausdorff.backward, distance.from_reference));
  }
  return table;
}

ReportTable soundness_table(const MethodComparison& comparison) {
  ReportTable table{"soundness",
                    "Whether the surfaces are sound",
                    {"surface", "closed", "manifold", "components", "genus", "intersecting pairs of faces"},
                    {}};
  for (const MethodRow& row : comparison.rows) {
    if (!row.soundness) continue;
    const Topology& topology = row.soundness->topology;
    table.rows.push_back({name_of(row), yes_no(topology.closed), yes_no(topology.manifold),
                          std::to_string(topology.components), std::to_string(topology.genus),
                          std::to_string(row.soundness->self_intersections)});
  }
  return table;
}

ReportTable demands_table(const MethodComparison& comparison) {
  ReportTable table{"demands", "Demanded of the low resolution", {"what", "found", "demanded", "met"}, {}};
  for (const TableDemand& demand : check_demands(comparison)) {
    table.rows.push_back({std::string(demand.what), format_number(demand.found),
                          (demand.below ? "below " : "at most ") + format_number(demand.limit), yes_no(demand.met())});
  }
  return table;
}

ReportTable paper_table(const MethodComparison& comparison) {
  ReportTable table{"paper", worse_than_paper(comparison), {"what", "here", "paper", "worse"}, {}};
  for (const PaperFigure& figure : compare_with_paper(comparison)) {
    table.rows.push_back({std::string(to_string(figure.method)).append(": ").append(figure.what),
                          format_number(figure.ours), format_number(figure.paper), yes_no(figure.worse())});
  }
  return table;
}

}  // namespace

std::string name_of(const MethodRow& row) {
  return std::string(to_string(row.method)) + (row.around > 0 ? ", " + std::to_string(row.around) + " around" : "");
}

std::string worse_than_paper(const MethodComparison& comparison) {
  std::string text;
  for (const PaperFigure& figure : compare_with_paper(comparison)) {
    if (!figure.worse()) continue;
    if (!text.empty()) text += "; ";
    text += std::string(to_string(figure.method)).append(", ").append(figure.what).append(": ") +
            format_number(figure.ours) + " against " + format_number(figure.paper);
  }
  return text.empty() ? "No figure is worse than the paper's" : "Worse than the paper's: " + text;
}

std::vector<ReportTable> to_tables(const Table2Report& report) {
  const MethodComparison& comparison = report.comparison;
  return {source_table(report),        main_table(comparison),    directions_table(comparison),
          soundness_table(comparison), demands_table(comparison), paper_table(comparison)};
}

}  // namespace vmesh::tool
