#include "voxel_set.h"

namespace vmesh::skeleton {

VoxelSet::VoxelSet(const std::array<std::size_t, 3>& size) : size_(size) {
  for (int a = 0; a < 3; ++a) counts_[a] = (size[a] + kSide - 1) / kSide + 2;
  table_.assign(counts_[0] * counts_[1] * counts_[2], kNone);
}

VoxelSet::Block& VoxelSet::block_for(const Voxel& v) {
  Index& place = table_[table_index(v)];
  if (place == kNone) {
    place = static_cast<Index>(blocks_.size());
    blocks_.emplace_back().corner = {v[0] & ~7, v[1] & ~7, v[2] & ~7};
  }
  return blocks_[place];
}

void VoxelSet::insert_row(int i0, int i1, int j, int k) {
  while (i0 < i1) {
    const int end = std::min(i1, (i0 & ~7) + kSide);
    const std::uint64_t run = ((std::uint64_t{1} << (end - i0)) - 1) << (i0 & 7);
    block_for({i0, j, k}).layers[k & 7] |= run << ((j & 7) << 3);
    i0 = end;
  }
}

void VoxelSet::number_voxels() {
  voxels_ = 0;
  for (Block& block : blocks_) {
    block.first = static_cast<Index>(voxels_);
    std::size_t count = 0;
    for (int k = 0; k < kSide; ++k) {
      block.before[k] = static_cast<std::uint16_t>(count);
      count += static_cast<std::size_t>(std::popcount(block.layers[k]));
    }
    voxels_ += count;
  }
}

std::vector<Voxel> VoxelSet::voxels() const {
  std::vector<Voxel> all;
  all.reserve(voxels_);
  for (const Block& block : blocks_) {
    for (int k = 0; k < kSide; ++k) {
      for (std::uint64_t rest = block.layers[k]; rest != 0; rest &= rest - 1) {
        const int place = std::countr_zero(rest);
        all.push_back({block.corner[0] + (place & 7), block.corner[1] + (place >> 3), block.corner[2] + k});
      }
    }
  }
  return all;
}

}  // namespace vmesh::skeleton
