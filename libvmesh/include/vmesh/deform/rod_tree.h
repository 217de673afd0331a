#pragma once

#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

using Mat3 = Eigen::Matrix3d;

/// A centerline as a forest of rods, at rest. One slot per node, parents before children, every subtree contiguous; a
/// segment that closes a loop ends in a slot of its own that is tied to the node's. The frame of a slot belongs to the
/// segment from its parent (C_j of the paper, section 3): orthonormal columns x, y, z, with z along the segment. A root
/// has a frame of its own.
struct RodTree {
  /// Two slots at one node.
  struct Tie {
    Index slot, node_slot;
  };

  std::vector<Index> parent;   ///< slot; kNone for a root
  std::vector<Index> segment;  ///< of the centerline, from the parent; kNone for a root
  std::vector<Index> node;     ///< of the centerline
  std::vector<double> length;  ///< of the segment, mm; 0 for a root
  std::vector<double> radius;  ///< of the node, mm
  std::vector<Vec3> position;  ///< mm
  std::vector<Mat3> frame;
  std::vector<Mat3> turn;  ///< Q_j = C_parent^T C_j (Eq. 3); identity for a root
  std::vector<Index> slot_of_node, slot_of_segment;
  std::vector<Tie> ties;

  std::size_t size() const { return parent.size(); }
};

/// Cuts `centerline` into trees, rooted at the first of `roots` in every component, or else at its lowest node. O(n),
/// deterministic.
RodTree make_rod_tree(const Centerline& centerline, std::span<const Index> roots = {});

/// The state of a rod tree: one entry per slot of a RodTree.
struct Pose {
  std::vector<Vec3> position;        ///< mm
  std::vector<Mat3> frame;           ///< orthonormal
  std::vector<double> radial_scale;  ///< of the vessel's profile; empty: 1 everywhere
};

/// The tree at rest.
Pose rest_pose(const RodTree& tree);

}  // namespace vmesh
