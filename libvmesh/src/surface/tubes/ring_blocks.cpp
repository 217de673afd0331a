#include "surface/tubes/ring_blocks.h"

#include <utility>

namespace vmesh {

std::span<const Ring> RingBlocks::of(Index branch) const {
  const Place& place = places_[branch];
  if (!place.block) return {};
  return std::span<const Ring>(place.block->rings).subspan(place.first, place.count);
}

void RingBlocks::add(std::span<const Index> branches, std::span<const Rings> laid) {
  std::size_t rings = 0, points = 0;
  for (const Rings& of_branch : laid) {
    rings += of_branch.rings.size();
    for (const Ring& ring : of_branch.rings) points += ring.points.size();
  }
  auto block = std::make_unique<Block>();
  block->rings.reserve(rings);
  block->points.reserve(points);
  block->held = branches.size();
  for (std::size_t i = 0; i < branches.size(); ++i) {
    places_[branches[i]] = {block.get(), block->rings.size(), laid[i].rings.size()};
    for (const Ring& ring : laid[i].rings) {
      const std::size_t first = block->points.size();
      block->points.insert(block->points.end(), ring.points.begin(), ring.points.end());
      block->rings.push_back(ring);
      block->rings.back().points = std::span<const RingPoint>(block->points).subspan(first);
    }
  }
  blocks_.push_back(std::move(block));
}

void RingBlocks::release(Index branch) {
  Block* block = std::exchange(places_[branch], {}).block;
  if (!block || --block->held > 0) return;
  std::vector<Ring>().swap(block->rings);
  std::vector<RingPoint>().swap(block->points);
}

}  // namespace vmesh
