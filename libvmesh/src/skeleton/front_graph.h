// Loops of a set of voxels from the fronts that run through it, internal to the module.
#pragma once

#include <vector>

#include "voxel_graph.h"

namespace vmesh::skeleton {

/// Connected pieces of bands of equal path length from a root (the Reeb graph of that length): where two fronts that
/// parted meet again, there is a loop. Every loop of the voxels is one here, however thin it is, and there are no
/// others, as a simply connected set has a tree.
class FrontGraph {
 public:
  /// `length`: of the shortest path from its component's root to every voxel, mm.
  FrontGraph(const VoxelGraph& graph, const std::vector<float>& length);

  Index front_of(Index voxel) const { return front_of_voxel_[voxel]; }

  /// Path length from the root at which a front's band begins, mm.
  double level_mm(Index front) const { return width_ * level_[front]; }

  /// Fronts that part at one front and meet at another.
  struct Loop {
    Index parting, meeting;       ///< fronts
    std::vector<Index> sides[2];  ///< the fronts between them, which a path along that side may use
    double persistence = 0;       ///< length of the path between parting and meeting, mm
  };
  /// Loops that are at least as long as `least(meeting front's first voxel)` between parting and meeting (mm), those
  /// that meet nearest to the root first.
  template <class Least>
  std::vector<Loop> loops(Least&& least) const {
    std::vector<Loop> found;
    for (const auto& [front, first, second] : meetings()) {
      Loop loop = loop_at(front, first, second);
      if (loop.parting != kNone && loop.persistence >= least(first_voxel_[front])) found.push_back(std::move(loop));
    }
    return found;
  }

  /// Voxels of a front.
  std::vector<Index> voxels_of(Index front) const {
    return {voxels_.begin() + offset_[front], voxels_.begin() + offset_[front + 1]};
  }

 private:
  struct Meeting {
    Index front, first, second;
  };
  std::vector<Meeting> meetings() const;
  Loop loop_at(Index front, Index first, Index second) const;

  double width_;  // of a band, mm
  std::vector<Index> front_of_voxel_;
  std::vector<int> level_;               // band of every front
  std::vector<Index> first_voxel_;       // of every front
  std::vector<Index> offset_, voxels_;   // voxels of every front
  std::vector<Index> below_at_, below_;  // neighbours of every front in lower bands
};

}  // namespace vmesh::skeleton
