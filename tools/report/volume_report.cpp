#include "report/volume_report.h"

#include <numeric>

#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"

#include "report/summary.h"

namespace vmesh::tool {
namespace {

Json to_json(const ThinPlace& place) {
  return {{"position", tool::to_json(place.position)},
          {"asked_mm", place.asked_mm},
          {"reached_mm", place.reached_mm},
          {"vertices", place.vertices},
          {"limit", to_string(place.limit)}};
}

Json to_json(const MergedPlace& place) {
  return {
      {"position", tool::to_json(place.position)}, {"volume_mm3", place.volume_mm3}, {"tetrahedra", place.tetrahedra}};
}

Json layers_json(const LayerOptions& options, const LayerSummary& summary) {
  if (options.count == 0) return {{"count", 0}};
  Json json = {{"count", options.count}};
  if (options.first_mm > 0) {
    json["first_mm"] = options.first_mm;
  } else {
    json[options.in_mm ? "thickness_mm" : "thickness_radii"] = options.thickness;
  }
  json["growth"] = options.growth;
  json["full_share_of_wall"] = summary.full_share;
  json["least_share"] = summary.least_share;
  json["thin_places"] = list_json(summary.thin, [](const ThinPlace& place) { return to_json(place); });
  return json;
}

Json patches_json(const VolumeReport& report) {
  const VolumeMesh& mesh = report.result->mesh;
  std::vector<std::size_t> faces(mesh.patch_names.size(), 0);
  for (const BoundaryFace& face : mesh.boundary) ++faces[face.patch];
  Json json = Json::array();
  for (std::size_t p = 0; p < faces.size(); ++p)
    json.push_back(
        {{"name", mesh.patch_names[p]}, {"faces", faces[p]}, {"area_mm2", report.measures.patch_area_mm2[p]}});
  return json;
}

Json regions_json(const VolumeReport& report) {
  const VolumeMesh& mesh = report.result->mesh;
  std::vector<std::size_t> cells(mesh.region_names.size(), 0);
  for (const Index region : mesh.cell_region) ++cells[region];
  Json json = Json::array();
  for (std::size_t r = 0; r < cells.size(); ++r)
    json.push_back(
        {{"name", mesh.region_names[r]}, {"cells", cells[r]}, {"volume_mm3", report.measures.region_volume_mm3[r]}});
  return json;
}

Json quality_json(const VolumeReport& report) {
  const VolumeMeasures& measures = report.measures;
  Json json = Json::object();
  if (!report.result->mesh.tetrahedra.empty()) {
    json["tetrahedra"] = {
        {"dihedral_deg", {{"min", measures.min_dihedral_deg}, {"max", measures.max_dihedral_deg}}},
        {"radius_ratio", {{"min", measures.least_radius_ratio}, {"mean", measures.mean_radius_ratio}}},
        {"worst", tool::to_json(measures.worst_tetrahedron)}};
  }
  if (!report.result->mesh.wedges.empty())
    json["wedges"] = {{"scaled_jacobian", {{"min", measures.least_scaled_jacobian}}}};
  return json;
}

void log_layers(const LayerOptions& options, const LayerSummary& summary, const char* what, Console& console) {
  if (options.count == 0) return;
  for (const std::string& sentence : sentences_of(summary, what)) console.log(sentence);
}

}  // namespace

Json to_json(const VolumeReport& report) {
  const VolumeMesh& mesh = report.result->mesh;
  Json json = {{"schema", "vmesh.volume/1"},
               {"generator", generator_json()},
               {"input", {{"file", report.input.string()}, {"sha256", report.input_sha256}}},
               {"options", report.options},
               {"surface",
                {{"vertices", report.wall->mesh.vertices.size()},
                 {"faces", report.wall->mesh.faces.size()},
                 {"volume_mm3", enclosed_volume(report.wall->mesh)}}},
               {"points", mesh.points.size()},
               {"tetrahedra", mesh.tetrahedra.size()},
               {"wedges", mesh.wedges.size()},
               {"pyramids", mesh.pyramids.size()}};
  json["regions"] = regions_json(report);
  json["patches"] = patches_json(report);
  json["layers"] = layers_json(report.volume_options->layers, report.result->layers);
  json["wall_layers"] = layers_json(report.volume_options->shell, report.result->shell);
  if (report.volume_options->shell.merged)
    json["merged_walls"] = list_json(report.result->merged, [](const MergedPlace& place) { return to_json(place); });
  json["quality"] = quality_json(report);
  json["stages"] = stages_json(report.stages);
  return json;
}

void log_volume(const VolumeReport& report, Console& console) {
  const VolumeMesh& mesh = report.result->mesh;
  const VolumeMeasures& measures = report.measures;
  std::string cells = counted(mesh.points.size(), "point", "points");
  if (!mesh.tetrahedra.empty()) cells += ", " + counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra");
  if (!mesh.wedges.empty()) cells += ", " + counted(mesh.wedges.size(), "wedge", "wedges");
  if (!mesh.pyramids.empty()) cells += ", " + counted(mesh.pyramids.size(), "pyramid", "pyramids");
  console.log(cells);
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r)
    console.log(mesh.region_names[r] + formatted(": %.6g mm^3", measures.region_volume_mm3[r]));
  if (!mesh.tetrahedra.empty())
    console.log(formatted("angles between faces of tetrahedra %.1f to %.1f degrees; radius ratio %.2f mean, %.2f min",
                          measures.min_dihedral_deg, measures.max_dihedral_deg, measures.mean_radius_ratio,
                          measures.least_radius_ratio));
  log_layers(report.volume_options->layers, report.result->layers, "layers", console);
  log_layers(report.volume_options->shell, report.result->shell, "layers of the vessel's wall", console);
  const std::vector<MergedPlace>& merged = report.result->merged;
  if (!merged.empty())
    console.log("walls are one at " + counted(merged.size(), "place", "places") +
                formatted(", the largest of %.3g mm^3 at ", merged[0].volume_mm3) + point_text(merged[0].position));
}

}  // namespace vmesh::tool
