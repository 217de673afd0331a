// A volume mesh that follows a moving centerline as the surface around it does.
#pragma once

#include <filesystem>
#include <vector>

#include "vmesh/deform/volume_places.h"
#include "vmesh/io/volume_io.h"

#include "command_line/console.h"
#include "report/json.h"

namespace vmesh::tool {

/// How the cells of a frame are.
struct VolumeFrame {
  double time_s = 0;
  double volume_mm3 = 0;
  /// The least determinant of a cell's map (least_jacobians_mm3()) by that of the cell at rest: 1 at rest, 0 flat,
  /// negative turned over; where, in the frame, mm; and the number of the cell.
  double least_jacobian = 1;
  Vec3 least_at = Vec3::Zero();
  Index least_cell = kNone;
  double least_scaled_jacobian = 1;  ///< VolumeMeasures::least_scaled_jacobian, of wedges
  std::size_t inverted_cells = 0;    ///< as find_volume_defects() finds them
  Vec3 first_inverted = Vec3::Zero();
};

/// Millimetres and LPS are taken alone. Warnings go to the console. Throws InvalidInput for others, ReadError.
LoadedVolume load_volume(const std::filesystem::path& path, Console& console);

/// The mesh, bound to the centerline, and its frames.
class MovingVolume {
 public:
  /// Throws InvalidInput, which does not name the file, for a mesh with defects (find_volume_defects()).
  MovingVolume(LoadedVolume rest, const Centerline& centerline, const RodTree& tree, const VolumePlaces& places,
               VolumeMetadata metadata);

  /// Moves the points to where `pose` puts them, those that moved.
  void follow(const Pose& pose, const std::vector<char>& moved) { binding_.apply(pose, moved, lanes_); }
  /// Writes the mesh with the attribute displacement of points and relative_jacobian of cells, and adds to frames().
  void write(const std::filesystem::path& path, double time_s);
  const std::vector<VolumeFrame>& frames() const { return frames_; }
  Json to_json() const;

 private:
  VolumeFrame measure(double time_s, std::vector<double>& relative_jacobian) const;

  LoadedVolume volume_;  ///< as it was written last
  std::vector<Vec3> rest_points_;
  std::vector<double> rest_jacobian_mm3_;
  std::size_t shared_points_;
  SurfaceBinding binding_;
  DeformedSurface lanes_;
  VolumeMetadata metadata_;
  std::vector<VolumeFrame> frames_;
};

}  // namespace vmesh::tool
