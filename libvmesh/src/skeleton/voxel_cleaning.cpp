#include "voxel_cleaning.h"

#include <algorithm>
#include <bit>

namespace vmesh::skeleton {
namespace {

constexpr int kMostRounds = 2;   // for tunnels of two voxels
constexpr int kSurrounded = 19;  // of 26 neighbours
constexpr std::uint64_t kFirstColumn = 0x0101010101010101, kLastColumn = kFirstColumn << 7;
constexpr std::uint64_t kFirstRow = 0xff, kLastRow = kFirstRow << 56;

using Layers = std::array<std::uint64_t, 8>;

/// Which voxels outside the set have a way to the border of the grid. Blocks without a voxel of the set are outside as
/// a whole, and there is always one beyond every side of the grid.
class Outside {
 public:
  explicit Outside(const VoxelSet& voxels) : voxels_(voxels), reached_(voxels.blocks().size(), Layers{}) {
    for (int a = 0; a < 3; ++a) counts_[a] = static_cast<int>((voxels.grid_size()[a] + 7) / 8) + 2;
    empty_reached_.assign(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2], 0);
    enter({-1, -1, -1});
    while (!stack_.empty()) {
      const Voxel b = stack_.back();
      stack_.pop_back();
      leave(b);
    }
  }

  const Layers& reached(Index block) const { return reached_[block]; }

 private:
  static Layers all() {
    Layers layers;
    layers.fill(~std::uint64_t{0});
    return layers;
  }
  Index block_at(const Voxel& b) const { return voxels_.block_number({8 * b[0], 8 * b[1], 8 * b[2]}); }
  char& empty_reached(const Voxel& b) {
    return empty_reached_[(static_cast<std::size_t>(b[2] + 1) * counts_[1] + (b[1] + 1)) * counts_[0] + (b[0] + 1)];
  }
  bool within(const Voxel& b) const {
    for (int a = 0; a < 3; ++a)
      if (b[a] < -1 || b[a] > counts_[a] - 2) return false;
    return true;
  }

  void enter(const Voxel& b) {
    if (char& reached = empty_reached(b); !reached) {
      reached = 1;
      stack_.push_back(b);
    }
  }

  /// Adds voxels of a block to those reached, and what they reach within it.
  void enter(const Voxel& b, Index block, const Layers& from) {
    const Layers& inside = voxels_.blocks()[block].layers;
    Layers now = reached_[block];
    bool more = false;
    for (int k = 0; k < 8; ++k) {
      const std::uint64_t fresh = from[k] & ~inside[k] & ~now[k];
      more = more || fresh != 0;
      now[k] |= fresh;
    }
    if (!more) return;
    while (more) {
      more = false;
      for (int k = 0; k < 8; ++k) {
        std::uint64_t grown =
            now[k] | (now[k] & ~kLastColumn) << 1 | (now[k] & ~kFirstColumn) >> 1 | now[k] << 8 | now[k] >> 8;
        if (k > 0) grown |= now[k - 1];
        if (k < 7) grown |= now[k + 1];
        grown &= ~inside[k];
        more = more || grown != now[k];
        now[k] = grown;
      }
    }
    reached_[block] = now;
    stack_.push_back(b);
  }

  /// Goes from a block into its neighbours.
  void leave(const Voxel& b) {
    const Index block = block_at(b);
    const Layers from = block == kNone ? all() : reached_[block];
    for (int axis = 0; axis < 3; ++axis) {
      for (const int way : {-1, 1}) {
        Voxel next = b;
        next[axis] += way;
        if (!within(next)) continue;
        const Layers seed = across(from, axis, way);
        if (std::all_of(seed.begin(), seed.end(), [](std::uint64_t layer) { return layer == 0; })) continue;
        if (const Index other = block_at(next); other != kNone) {
          enter(next, other, seed);
        } else {
          enter(next);
        }
      }
    }
  }

  /// The voxels beyond a face of the block, as bits of the neighbouring block.
  static Layers across(const Layers& from, int axis, int way) {
    Layers seed{};
    if (axis == 2) {
      seed[way > 0 ? 0 : 7] = from[way > 0 ? 7 : 0];
      return seed;
    }
    for (int k = 0; k < 8; ++k) {
      if (axis == 0) seed[k] = way > 0 ? (from[k] & kLastColumn) >> 7 : (from[k] & kFirstColumn) << 7;
      if (axis == 1) seed[k] = way > 0 ? (from[k] & kLastRow) >> 56 : (from[k] & kFirstRow) << 56;
    }
    return seed;
  }

  const VoxelSet& voxels_;
  std::vector<Layers> reached_;  // of blocks with voxels of the set
  std::vector<char> empty_reached_;
  std::array<int, 3> counts_{};
  std::vector<Voxel> stack_;
};

std::size_t fill_cavities(VoxelSet& voxels) {
  const Outside outside(voxels);
  std::size_t filled = 0;
  for (Index b = 0; b < voxels.blocks().size(); ++b) {
    VoxelSet::Block& block = voxels.blocks()[b];
    for (int k = 0; k < 8; ++k) {
      const std::uint64_t enclosed = ~(outside.reached(b)[k] | block.layers[k]);
      filled += static_cast<std::size_t>(std::popcount(enclosed));
      block.layers[k] |= enclosed;
    }
  }
  return filled;
}

int neighbours_inside(const VoxelSet& voxels, const Voxel& v) {
  int count = 0;
  visit_around(v, [&](const Voxel& near) { count += voxels.contains(near); });
  return count;
}

/// Voxels outside between two inside along an axis, which pinholes are.
std::vector<Voxel> gaps_of(const VoxelSet& voxels) {
  std::vector<Voxel> gaps;
  for (const VoxelSet::Block& block : voxels.blocks()) {
    for (int k = 0; k < 8; ++k) {
      const std::uint64_t layer = block.layers[k];
      std::uint64_t between = ~layer & (layer << 1 | kFirstColumn) & (layer >> 1 | kLastColumn);
      between |= ~layer & (layer << 8 | kFirstRow) & (layer >> 8 | kLastRow);
      for (; between != 0; between &= between - 1) {
        const int place = std::countr_zero(between);
        gaps.push_back({block.corner[0] + (place & 7), block.corner[1] + (place >> 3), block.corner[2] + k});
      }
    }
  }
  return gaps;
}

std::size_t fill_pinholes(VoxelSet& voxels) {
  std::vector<Voxel> pinholes;
  for (const Voxel& v : gaps_of(voxels))
    if (neighbours_inside(voxels, v) >= kSurrounded) pinholes.push_back(v);
  for (const Voxel& v : pinholes) voxels.insert(v);
  return pinholes.size();
}

}  // namespace

FilledHoles fill_holes(VoxelSet& voxels) {
  FilledHoles filled;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t count = fill_pinholes(voxels);
    filled.pinholes += count;
    if (count == 0) break;
  }
  filled.cavities = fill_cavities(voxels);
  voxels.number_voxels();
  return filled;
}

}  // namespace vmesh::skeleton
