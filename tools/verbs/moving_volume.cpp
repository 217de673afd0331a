#include "verbs/moving_volume.h"

#include <algorithm>
#include <numeric>

#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"

namespace vmesh::tool {
namespace {

constexpr const char* kDisplacement = "displacement";
constexpr const char* kRelativeJacobian = "relative_jacobian";

Vec3 centre_of_cell(const VolumeMesh& mesh, Index number) {
  Vec3 centre = Vec3::Zero();
  Index c = 0;
  for_each_cell(mesh, [&](const auto& cell) {
    if (c++ != number) return;
    for (const Index v : cell) centre += mesh.points[v];
    centre /= static_cast<double>(cell.size());
  });
  return centre;
}

/// Throws InvalidInput for a mesh that is defective before it moves.
LoadedVolume checked(LoadedVolume volume) {
  for (const VolumeDefect& defect : find_volume_defects(volume.mesh))
    throw InvalidInput("the mesh is not sound as it is: " + defect.message +
                       "; make it anew with vmesh volume, or mend it");
  return volume;
}

/// Directions that the binding wants and positions do not depend on.
std::vector<Vec3> any_normals(std::size_t count) { return std::vector<Vec3>(count, Vec3::UnitZ()); }

/// Replaces the attribute of that name, or adds it at the end.
std::vector<double>& values_of(std::vector<MeshAttribute>& attributes, const char* name) {
  const auto found =
      std::find_if(attributes.begin(), attributes.end(), [&](const MeshAttribute& a) { return a.name == name; });
  if (found != attributes.end()) return found->values;
  attributes.push_back({name, {}});
  return attributes.back().values;
}

}  // namespace

LoadedVolume load_volume(const std::filesystem::path& path, Console& console) {
  LoadedVolume volume = read_volume(path);
  console.warn(volume.warnings);
  if (volume.unit != LengthUnit::mm || volume.space != Space::lps)
    throw InvalidInput(path.string() +
                       ": volumes are followed in millimetres and LPS, as vmesh volume writes them by default");
  return volume;
}

MovingVolume::MovingVolume(LoadedVolume rest, const Centerline& centerline, const RodTree& tree,
                           const VolumePlaces& places, VolumeMetadata metadata)
    : volume_(checked(std::move(rest))),
      rest_points_(volume_.mesh.points),
      rest_jacobian_mm3_(least_jacobians_mm3(volume_.mesh)),
      shared_points_(places.shared),
      binding_(centerline, tree, rest_points_, any_normals(rest_points_.size()), places.places),
      lanes_(binding_.make_surface()),
      metadata_(std::move(metadata)) {}

VolumeFrame MovingVolume::measure(double time_s, std::vector<double>& relative_jacobian) const {
  const VolumeMesh& mesh = volume_.mesh;
  VolumeFrame frame;
  frame.time_s = time_s;
  relative_jacobian = least_jacobians_mm3(mesh);
  for (std::size_t c = 0; c < relative_jacobian.size(); ++c) relative_jacobian[c] /= rest_jacobian_mm3_[c];
  const auto least = std::min_element(relative_jacobian.begin(), relative_jacobian.end());
  if (least != relative_jacobian.end()) {
    frame.least_jacobian = *least;
    frame.least_cell = static_cast<Index>(least - relative_jacobian.begin());
    frame.least_at = centre_of_cell(mesh, frame.least_cell);
  }
  const VolumeDefect inverted = find_inverted_cells(mesh);
  frame.inverted_cells = inverted.count;
  frame.first_inverted = inverted.position;
  const VolumeMeasures measures = measure_volume(mesh);
  frame.least_scaled_jacobian = measures.least_scaled_jacobian;
  frame.volume_mm3 = std::accumulate(measures.region_volume_mm3.begin(), measures.region_volume_mm3.end(), 0.0);
  return frame;
}

void MovingVolume::write(const std::filesystem::path& path, double time_s) {
  VolumeMesh& mesh = volume_.mesh;
  std::vector<double> displacement;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    mesh.points[v] = lanes_.position(binding_.lane_of_vertex()[v]);
    displacement.push_back((mesh.points[v] - rest_points_[v]).norm());
  }
  values_of(volume_.attributes.point, kDisplacement) = std::move(displacement);
  frames_.push_back(measure(time_s, values_of(volume_.attributes.cell, kRelativeJacobian)));
  write_volume(path, mesh, metadata_, volume_.attributes);
}

Json MovingVolume::to_json() const {
  const bool has_wedges = !volume_.mesh.wedges.empty();
  const auto frame_json = [&](const VolumeFrame& frame) {
    Json json = {{"time_s", frame.time_s},
                 {"volume_mm3", frame.volume_mm3},
                 {"least_relative_jacobian", frame.least_jacobian},
                 {"least_at", tool::to_json(frame.least_at)},
                 {"least_cell", index_json(frame.least_cell)},
                 {"least_scaled_jacobian", has_wedges ? Json(frame.least_scaled_jacobian) : Json()},
                 {"inverted_cells", frame.inverted_cells}};
    if (frame.inverted_cells > 0) json["first_inverted_at"] = tool::to_json(frame.first_inverted);
    return json;
  };
  return {{"file", metadata_.input_name},
          {"points", volume_.mesh.points.size()},
          {"cells", volume_.mesh.cell_count()},
          {"points_of_surface", shared_points_},
          {"frames", list_json(frames_, frame_json)}};
}

}  // namespace vmesh::tool
