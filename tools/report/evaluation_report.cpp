#include "report/evaluation_report.h"

#include <tbb/parallel_for.h>

namespace vmesh::tool {
namespace {

using tool::to_json;

constexpr std::size_t kListed = 1000;  // elements of a list of places
constexpr std::size_t kBins = 20;

Json to_json(const Distribution& d) {
  return {{"count", d.count}, {"min", d.min}, {"p5", d.p5},   {"p25", d.p25},   {"median", d.median}, {"p75", d.p75},
          {"p95", d.p95},     {"p99", d.p99}, {"max", d.max}, {"mean", d.mean}, {"rms", d.rms}};
}

Json to_json(const Histogram& histogram) {
  return {{"low", histogram.low}, {"high", histogram.high}, {"counts", histogram.counts}};
}

Json measures_json(const std::vector<MeasureSummary>& summaries) {
  Json json = Json::object();
  for (const auto& [name, distribution, histogram] : summaries) {
    json[name] = to_json(distribution);
    json[name]["histogram"] = to_json(histogram);
  }
  return json;
}

Json topology_json(const Topology& topology) {
  return {{"closed", topology.closed},
          {"manifold", topology.manifold},
          {"oriented", topology.oriented},
          {"outward", topology.outward},
          {"components", topology.components},
          {"genus", topology.genus},
          {"boundary_edges", topology.boundary_edges},
          {"boundary_loops", topology.boundary_loops},
          {"edges_of_three_faces_or_more", topology.crowded_edges},
          {"euler_characteristic", topology.euler_characteristic}};
}

Json first_of(const std::vector<Index>& faces) {
  return list_json(
      faces, [](Index face) { return face; }, kListed);
}

Json defects_json(const DefectReport& defects) {
  const auto of_pair = [](const IntersectingFaces& pair) {
    return Json{{"faces", {pair.first, pair.second}}, {"near", to_json(pair.position)}};
  };
  Json valence = Json::object();
  for (const auto& [edges, vertices] : defects.vertices_of_valence) valence[std::to_string(edges)] = vertices;
  return {{"degenerate_faces", defects.degenerate_faces.size()},
          {"first_degenerate_faces", first_of(defects.degenerate_faces)},
          {"duplicate_faces", defects.duplicate_faces.size()},
          {"first_duplicate_faces", first_of(defects.duplicate_faces)},
          {"self_intersections", defects.self_intersections.size()},
          {"first_self_intersections", list_json(defects.self_intersections, of_pair, kListed)},
          {"vertices_of_valence", valence}};
}

}  // namespace

std::vector<MeasureSummary> summarize_measures(const FaceMeasures& measures) {
  struct Measure {
    const char* name;
    const std::vector<double>* values;
    double low, high;
  };
  std::vector<Measure> all;
  for_each_face_measure(measures, [&](const char* name, const std::vector<double>& values, double low, double high) {
    all.push_back({name, &values, low, high});
  });
  std::vector<MeasureSummary> summaries(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    auto [name, values, low, high] = all[i];
    const Distribution distribution = summarize(*values);
    if (low == high) low = distribution.min, high = distribution.max;
    summaries[i] = {name, distribution, make_histogram(*values, low, high, kBins)};
  });
  return summaries;
}

Json side_json(const OneSidedHausdorff& side, const SampledDistance& sampled) {
  return {{"hausdorff_mm", interval_json(side.lower, side.upper)},
          {"farthest",
           {{"at", to_json(side.witness.from)},
            {"face", side.witness.from_face},
            {"closest", to_json(side.witness.to)},
            {"closest_face", side.witness.to_face}}},
          {"sampled_mm", to_json(sampled.distance)},
          {"samples_per_mm2", sampled.samples_per_mm2}};
}

namespace {

Json to_json(const ReferenceComparison& reference) {
  return {{"against", "reference surface"},
          {"file", reference.file},
          {"faces", reference.faces},
          {"tolerance_mm", reference.tolerance_mm},
          {"hausdorff_mm", tool::to_json(reference.hausdorff)},
          {"from_surface", side_json(reference.hausdorff.forward, reference.forward)},
          {"from_reference", side_json(reference.hausdorff.backward, reference.backward)}};
}

Json to_json(const VesselDistanceSide& side) {
  return {{"sampled_mm", to_json(side.mm)},
          {"sampled_in_local_radii", to_json(side.relative)},
          {"max_at", to_json(side.max_at)},
          {"max_in_local_radii_at", to_json(side.max_relative_at)},
          {"samples_per_mm2", side.samples_per_mm2}};
}

Json to_json(const VolumeComparison& volume) {
  return {{"against", "round-cone volume of the centerline"},
          {"file", volume.file},
          {"from_surface", to_json(volume.distance.from_mesh)},
          {"from_volume", to_json(volume.distance.from_volume)}};
}

Json to_json(const std::vector<CheckedRequirement>& requirements) {
  return list_json(requirements, [](const CheckedRequirement& requirement) {
    return Json{{"requirement", requirement.text}, {"found", requirement.found}, {"met", requirement.met}};
  });
}

}  // namespace

Json to_json(const EvaluationReport& report) {
  return {{"schema", "vmesh.evaluation/1"},
          {"generator", generator_json()},
          {"input", {{"file", report.file}, {"sha256", report.sha256}}},
          {"vertices", report.vertices},
          {"faces", report.faces},
          {"area_mm2", report.area_mm2},
          {"enclosed_volume_mm3", report.volume_mm3 ? Json(*report.volume_mm3) : Json()},
          {"topology", topology_json(report.defects.topology)},
          {"defects", defects_json(report.defects)},
          {"face_measures", measures_json(report.measure_summaries)},
          {"reference", report.reference ? to_json(*report.reference) : Json()},
          {"volume", report.volume ? to_json(*report.volume) : Json()},
          {"requirements", to_json(report.requirements)},
          {"warnings", report.warnings}};
}

namespace {

using Row = std::vector<std::string>;

const std::vector<std::string> kDistributionColumns = {"mean", "rms", "min", "5 %", "median", "95 %", "99 %", "max"};

Row distribution_row(const std::string& name, const Distribution& d) {
  Row row = {name};
  for (const double value : {d.mean, d.rms, d.min, d.p5, d.median, d.p95, d.p99, d.max}) {
    row.push_back(format_number(value));
  }
  return row;
}

ReportTable distribution_table(const std::string& key, const std::string& title, const std::string& what) {
  ReportTable table{key, title, {what}, {}};
  table.columns.insert(table.columns.end(), kDistributionColumns.begin(), kDistributionColumns.end());
  return table;
}

ReportTable sampled_table(const std::string& key, const std::string& title) {
  ReportTable table = distribution_table(key, title, "direction");
  table.columns.push_back("samples per mm^2");
  return table;
}

Row sampled_row(const std::string& name, const Distribution& d, double samples_per_mm2) {
  Row row = distribution_row(name, d);
  row.push_back(format_number(samples_per_mm2));
  return row;
}

ReportTable surface_table(const EvaluationReport& report) {
  const Topology& topology = report.defects.topology;
  const bool has_genus = topology.closed && topology.manifold && topology.oriented;
  return {"surface",
          "Surface " + report.file,
          {"property", "value"},
          {{"vertices", std::to_string(report.vertices)},
           {"faces", std::to_string(report.faces)},
           {"area, mm^2", format_number(report.area_mm2)},
           {"enclosed volume, mm^3", report.volume_mm3 ? format_number(*report.volume_mm3) : "not defined"},
           {"closed", yes_no(topology.closed)},
           {"manifold", yes_no(topology.manifold)},
           {"oriented", yes_no(topology.oriented)},
           {"outward", yes_no(topology.outward)},
           {"components", std::to_string(topology.components)},
           {"genus", has_genus ? std::to_string(topology.genus) : "not defined"},
           {"boundary loops", std::to_string(topology.boundary_loops)},
           {"boundary edges", std::to_string(topology.boundary_edges)},
           {"edges of three faces or more", std::to_string(topology.crowded_edges)},
           {"degenerate faces", std::to_string(report.defects.degenerate_faces.size())},
           {"duplicate faces", std::to_string(report.defects.duplicate_faces.size())},
           {"intersecting pairs of faces", std::to_string(report.defects.self_intersections.size())}}};
}

ReportTable measures_table(const std::vector<MeasureSummary>& summaries) {
  ReportTable table = distribution_table("faces", "Faces", "measure");
  for (const MeasureSummary& of : summaries) table.rows.push_back(distribution_row(of.name, of.distribution));
  return table;
}

Row hausdorff_row(const std::string& name, const OneSidedHausdorff& side) {
  return {name, format_lower_bound(side.lower), format_upper_bound(side.upper), format_point(side.witness.from),
          format_point(side.witness.to)};
}

void add_tables(const ReferenceComparison& reference, std::vector<ReportTable>& tables) {
  const Hausdorff& h = reference.hausdorff;
  ReportTable bounds{
      "reference_hausdorff_mm",
      "Hausdorff distance to the reference surface " + reference.file + ", mm, guaranteed",
      {"direction", "at least", "at most", "farthest point", "closest to it"},
      {hausdorff_row("surface to reference", h.forward), hausdorff_row("reference to surface", h.backward)}};
  bounds.rows.push_back({"symmetric", format_lower_bound(h.lower()), format_upper_bound(h.upper()), "", ""});
  ReportTable sampled = sampled_table("reference_sampled_mm", "Distance to the reference surface, mm, sampled");
  sampled.rows = {sampled_row("surface to reference", reference.forward.distance, reference.forward.samples_per_mm2),
                  sampled_row("reference to surface", reference.backward.distance, reference.backward.samples_per_mm2)};
  tables.push_back(std::move(bounds));
  tables.push_back(std::move(sampled));
}

void add_tables(const VolumeComparison& volume, std::vector<ReportTable>& tables) {
  const VesselDistance& distance = volume.distance;
  const std::string to = "the round-cone volume of " + volume.file;
  ReportTable mm = sampled_table("volume_sampled_mm", "Distance to " + to + ", mm, sampled");
  mm.rows = {sampled_row("surface to volume", distance.from_mesh.mm, distance.from_mesh.samples_per_mm2),
             sampled_row("volume to surface", distance.from_volume.mm, distance.from_volume.samples_per_mm2)};
  ReportTable relative = sampled_table("volume_sampled_local_radii", "Distance to " + to + ", in local radii, sampled");
  relative.rows = {
      sampled_row("surface to volume", distance.from_mesh.relative, distance.from_mesh.samples_per_mm2),
      sampled_row("volume to surface", distance.from_volume.relative, distance.from_volume.samples_per_mm2)};
  ReportTable places{
      "volume_farthest",
      "Where the surface and the volume are farthest apart",
      {"direction", "in mm, at", "in local radii, at"},
      {{"surface to volume", format_point(distance.from_mesh.max_at), format_point(distance.from_mesh.max_relative_at)},
       {"volume to surface", format_point(distance.from_volume.max_at),
        format_point(distance.from_volume.max_relative_at)}}};
  for (ReportTable* table : {&mm, &relative, &places}) tables.push_back(std::move(*table));
}

}  // namespace

std::vector<ReportTable> to_tables(const EvaluationReport& report) {
  std::vector<ReportTable> tables = {surface_table(report), measures_table(report.measure_summaries)};
  if (report.reference) add_tables(*report.reference, tables);
  if (report.volume) add_tables(*report.volume, tables);
  if (!report.requirements.empty()) {
    ReportTable table{"requirements", "Requirements", {"requirement", "found", "met"}, {}};
    for (const CheckedRequirement& r : report.requirements) table.rows.push_back({r.text, r.found, yes_no(r.met)});
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace vmesh::tool
