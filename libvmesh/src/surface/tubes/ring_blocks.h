#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "surface/tubes/vessel_rings.h"

namespace vmesh {

/// The rings of all branches, in blocks of many. A block is freed with the last of its branches: rings freed one by one
/// would leave thousands of holes, which the allocator then goes through at every turn (13 % of the time of a million
/// segments).
class RingBlocks {
 public:
  /// Branches that are added together: some 200 KB. Not varied.
  static constexpr std::size_t kBranches = 64;

  explicit RingBlocks(std::size_t branches) : places_(branches) {}

  /// None if they were not added, or released.
  std::span<const Ring> of(Index branch) const;
  /// `laid`: the rings of each of them.
  void add(std::span<const Index> branches, std::span<const Rings> laid);
  /// Several threads may release different branches.
  void release(Index branch);

 private:
  struct Block {
    std::vector<Ring> rings;
    std::vector<RingPoint> points;
    std::atomic<std::size_t> held;  // branches that are not released
  };
  struct Place {
    Block* block = nullptr;
    std::size_t first = 0, count = 0;
  };

  std::vector<Place> places_;  // of every branch
  std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace vmesh
