// Voxels and their neighbours as a graph, internal to the module.
#pragma once

#include <span>
#include <vector>

#include "voxel_set.h"

namespace vmesh::skeleton {

/// The numbered voxels of a set, joined with their 26 neighbours and by bridges over gaps. Keeps a reference to the
/// set.
class VoxelGraph {
 public:
  /// `spacing`: of the voxels along every axis, mm.
  VoxelGraph(const VoxelSet& voxels, const Vec3& spacing);

  std::size_t size() const { return voxel_.size(); }
  const VoxelSet& set() const { return *set_; }
  const Voxel& voxel(Index n) const { return voxel_[n]; }
  const Vec3& spacing() const { return spacing_; }
  double finest() const { return spacing_.minCoeff(); }
  /// Length of the longest step to a neighbour, mm.
  float longest_step() const { return lengths_[0]; }

  struct Bridge {
    Index a, b;
    float length;  ///< mm
  };
  /// Joins voxels that are no neighbours.
  void add_bridges(std::span<const Bridge> bridges);
  const std::vector<Bridge>& bridges() const { return bridges_; }

  float distance(Index a, Index b) const;
  /// The distance less that of a number of voxels, however long these are in its direction.
  float distance_beyond(Index a, Index b, double voxels) const;

  /// Calls visit(neighbour, length in mm) for every neighbour.
  template <class Visit>
  void visit_neighbours(Index n, Visit&& visit) const {
    const Voxel& v = voxel_[n];
    const int column = v[0] & 7;
    const float* lengths = lengths_.data();
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj, lengths += 3) {
        const Voxel row = {v[0], v[1] + dj, v[2] + dk};
        if (column == 0 || column == 7) {
          for (int di = -1; di <= 1; ++di) {
            if (const Index m = set_->number({v[0] + di, row[1], row[2]}); m != kNone && m != n)
              visit(m, lengths[di + 1]);
          }
          continue;
        }
        const VoxelSet::Block* block = set_->block_of(row);
        if (block == nullptr) continue;
        const int first = (row[1] & 7) << 3 | (column - 1);
        const std::uint64_t layer = block->layers[row[2] & 7];
        const auto three = static_cast<unsigned>(layer >> first & 7);
        if (three == 0) continue;
        Index m = block->first + block->before[row[2] & 7] +
                  static_cast<Index>(std::popcount(layer & ((std::uint64_t{1} << first) - 1)));
        if (three & 1) visit(m++, lengths[0]);
        if (three & 2) {
          if (m != n) visit(m, lengths[1]);
          ++m;
        }
        if (three & 4) visit(m, lengths[2]);
      }
    }
    if (!has_bridge_.empty() && has_bridge_[n]) {
      for (const Bridge& bridge : bridges_) {
        if (bridge.a == n) visit(bridge.b, bridge.length);
        if (bridge.b == n) visit(bridge.a, bridge.length);
      }
    }
  }

 private:
  const VoxelSet* set_;
  Vec3 spacing_;
  std::vector<Voxel> voxel_;
  std::array<float, 27> lengths_{};
  std::vector<Bridge> bridges_;
  std::vector<char> has_bridge_;
};

/// Number of every voxel's component; components are numbered by their first voxel.
std::vector<Index> components_of(const VoxelGraph& graph);

/// The shortest connections between fragments, a few voxels each, and what is one voxel away from them.
std::vector<VoxelGraph::Bridge> bridges_to_fragments(const VoxelGraph& graph, const std::vector<Index>& component);

/// Lengths of the shortest paths from `source`, mm, in `length`; other components keep their values. Returns the
/// farthest voxel.
Index measure_lengths(const VoxelGraph& graph, Index source, std::vector<float>& length);

}  // namespace vmesh::skeleton
