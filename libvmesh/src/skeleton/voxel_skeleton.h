// The graph of vessels given as voxels, internal to the module.
#pragma once

#include <span>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/skeleton/extract_centerline.h"

#include "skeleton_graph.h"
#include "vessel_paths.h"
#include "voxel_set.h"

namespace vmesh::skeleton {

/// Where voxel (0, 0, 0) lies, and the steps along the axes (columns, mm).
struct VoxelFrame {
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();

  Vec3 spacing() const { return steps.colwise().norm(); }
  Vec3 position(const Voxel& v) const { return origin + steps * Vec3(v[0], v[1], v[2]); }
};

/// A component of the voxels.
struct VoxelComponent {
  double length = 0;  ///< from its root to the farthest voxel, and a voxel more at either end, mm
  double width = 0;   ///< at its widest, from the first voxels outside, mm
  Vec3 place = Vec3::Zero();
  bool kept = true;  ///< else it is no longer than wide, or than noise
};

struct VoxelSkeleton {
  Graph graph;  ///< a node for every voxel of a path, smoothed; radii from the depth
  std::vector<VoxelComponent> components;
  std::vector<Index> node_of_end;  ///< of every known end; kNone if it has none
  std::vector<Index> component_of_voxel;
  std::vector<JoinedGap> bridges;  ///< between fragments
  std::size_t loops = 0;
  VoxelFrame frame;
};

/// See find_paths(). `voxels` are numbered and without holes. Components no longer than wide are left out, except for
/// the longest.
VoxelSkeleton skeleton_of(const VoxelSet& voxels, const VoxelFrame& frame, std::span<const KnownEnd> ends,
                          const Progress& progress);

}  // namespace vmesh::skeleton
