// A set of voxels and numbers for them, internal to the module.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::skeleton {

using Voxel = std::array<int, 3>;

/// Voxels of a grid as bits in blocks of 8 x 8 x 8, and consecutive numbers for them: memory by the voxels in the set,
/// not by the grid. Questions may be asked up to eight voxels beyond the grid.
class VoxelSet {
 public:
  static constexpr int kSide = 8;  ///< of a block, voxels

  VoxelSet() = default;
  explicit VoxelSet(const std::array<std::size_t, 3>& size);

  const std::array<std::size_t, 3>& grid_size() const { return size_; }

  /// Precondition: within the grid. Numbers are valid again after the next number_voxels().
  void insert(const Voxel& v) { block_for(v).layers[v[2] & 7] |= bit(v); }
  /// The same for voxels i0 to i1 - 1 of a row.
  void insert_row(int i0, int i1, int j, int k);

  bool contains(const Voxel& v) const {
    const Block* block = block_of(v);
    return block != nullptr && (block->layers[v[2] & 7] & bit(v)) != 0;
  }

  /// Numbers the voxels block by block.
  void number_voxels();
  std::size_t size() const { return voxels_; }

  /// The number of a voxel; kNone if it is not in the set.
  Index number(const Voxel& v) const {
    const Block* block = block_of(v);
    if (block == nullptr) return kNone;
    const std::uint64_t layer = block->layers[v[2] & 7], mask = bit(v);
    if ((layer & mask) == 0) return kNone;
    return block->first + block->before[v[2] & 7] + static_cast<Index>(std::popcount(layer & (mask - 1)));
  }

  /// All voxels in the order of their numbers.
  std::vector<Voxel> voxels() const;

  struct Block {
    std::array<std::uint64_t, 8> layers{};  ///< bit 8 * (j & 7) + (i & 7) of layer k & 7
    std::array<std::uint16_t, 8> before{};  ///< voxels in the layers before
    Index first = 0;                        ///< number of its first voxel
    Voxel corner{};                         ///< its first voxel, in or out of the set
  };
  const std::vector<Block>& blocks() const { return blocks_; }
  std::vector<Block>& blocks() { return blocks_; }
  /// The block that contains voxel `v`, or nullptr if no voxel of it was ever inserted.
  const Block* block_of(const Voxel& v) const {
    const Index place = table_[table_index(v)];
    return place == kNone ? nullptr : &blocks_[place];
  }
  Index block_number(const Voxel& v) const { return table_[table_index(v)]; }

 private:
  static std::uint64_t bit(const Voxel& v) { return std::uint64_t{1} << ((v[1] & 7) << 3 | (v[0] & 7)); }
  std::size_t table_index(const Voxel& v) const {
    return (static_cast<std::size_t>((v[2] >> 3) + 1) * counts_[1] + static_cast<std::size_t>((v[1] >> 3) + 1)) *
               counts_[0] +
           static_cast<std::size_t>((v[0] >> 3) + 1);
  }
  Block& block_for(const Voxel& v);

  std::array<std::size_t, 3> size_ = {0, 0, 0};
  std::array<std::size_t, 3> counts_ = {0, 0, 0};  // of blocks, with one more on every side
  std::vector<Index> table_;                       // of block numbers
  std::vector<Block> blocks_;
  std::size_t voxels_ = 0;
};

/// Calls visit(neighbour) for a voxel and the 26 around it.
template <class Visit>
void visit_around(const Voxel& v, Visit&& visit) {
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) visit(Voxel{v[0] + i, v[1] + j, v[2] + k});
}

}  // namespace vmesh::skeleton
