#include <algorithm>

#include "report/evaluation_report.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kListed = 1000;  // elements of a list of places
constexpr std::size_t kBins = 20;

Json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json to_json(const Distribution& d) {
  return {{"count", d.count}, {"min", d.min}, {"p5", d.p5},   {"p25", d.p25},   {"median", d.median}, {"p75", d.p75},
          {"p95", d.p95},     {"p99", d.p99}, {"max", d.max}, {"mean", d.mean}, {"rms", d.rms}};
}

Json to_json(const Histogram& histogram) {
  return {{"low", histogram.low}, {"high", histogram.high}, {"counts", histogram.counts}};
}

Json measures_json(const FaceMeasures& measures) {
  Json json = Json::object();
  for_each_face_measure(measures, [&](const char* name, const std::vector<double>& values, double low, double high) {
    const Distribution distribution = summarize(values);
    if (low == high) low = distribution.min, high = distribution.max;
    json[name] = to_json(distribution);
    json[name]["histogram"] = to_json(make_histogram(values, low, high, kBins));
  });
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
  return std::vector<Index>(faces.begin(),
                            faces.begin() + static_cast<std::ptrdiff_t>(std::min(kListed, faces.size())));
}

Json defects_json(const DefectReport& defects) {
  Json places = Json::array();
  for (const IntersectingFaces& pair : defects.self_intersections) {
    if (places.size() == kListed) break;
    places.push_back({{"faces", {pair.first, pair.second}}, {"near", to_json(pair.position)}});
  }
  Json valence = Json::object();
  for (const auto& [edges, vertices] : defects.vertices_of_valence) valence[std::to_string(edges)] = vertices;
  return {{"degenerate_faces", defects.degenerate_faces.size()},
          {"first_degenerate_faces", first_of(defects.degenerate_faces)},
          {"duplicate_faces", defects.duplicate_faces.size()},
          {"first_duplicate_faces", first_of(defects.duplicate_faces)},
          {"self_intersections", defects.self_intersections.size()},
          {"first_self_intersections", places},
          {"vertices_of_valence", valence}};
}

}  // namespace

Json side_json(const OneSidedHausdorff& side, const SampledDistance& sampled) {
  return {{"hausdorff_mm", {{"lower", side.lower}, {"upper", side.upper}}},
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
          {"hausdorff_mm", {{"lower", reference.hausdorff.lower()}, {"upper", reference.hausdorff.upper()}}},
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
  Json json = Json::array();
  for (const CheckedRequirement& requirement : requirements) {
    json.push_back({{"requirement", requirement.text}, {"found", requirement.found}, {"met", requirement.met}});
  }
  return json;
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
          {"face_measures", measures_json(report.measures)},
          {"reference", report.reference ? to_json(*report.reference) : Json()},
          {"volume", report.volume ? to_json(*report.volume) : Json()},
          {"requirements", to_json(report.requirements)},
          {"warnings", report.warnings}};
}

}  // namespace vmesh::tool
