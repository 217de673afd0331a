#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

struct SlotBox {
  Vec3 low, high;

  bool overlaps(const SlotBox& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  void include(const SlotBox& other) { low = low.cwiseMin(other.low), high = high.cwiseMax(other.high); }
};

/// A binary tree of boxes over slots in their order, in which subtrees of the vessel tree are contiguous: what was near
/// at rest stays in one box, so that the tree never changes, only its boxes.
class SlotBoxes {
 public:
  explicit SlotBoxes(std::size_t slots);

  /// Makes every box fit again. `boxes`: one per slot.
  void refit(std::span<const SlotBox> boxes);

  template <class Visit>
  void visit_overlapping(std::span<const SlotBox> boxes, const SlotBox& box, Visit&& visit) const {
    if (leaves_ > 0) visit_node(1, boxes, box, visit);
  }
  /// Once for every two slots whose boxes overlap.
  template <class Visit>
  void visit_pairs(std::span<const SlotBox> boxes, Visit&& visit) const {
    if (leaves_ > 0) visit_pairs(1, 1, boxes, visit);
  }

 private:
  static constexpr std::size_t kLeaf = 8;

  template <class Visit>
  void for_slots(std::size_t node, std::span<const SlotBox> boxes, Visit&& visit) const {
    const std::size_t first = (node - leaves_) * kLeaf;
    for (std::size_t j = first; j < std::min(first + kLeaf, boxes.size()); ++j) visit(static_cast<Index>(j));
  }

  template <class Visit>
  void visit_node(std::size_t node, std::span<const SlotBox> boxes, const SlotBox& box, Visit& visit) const {
    if (!nodes_[node].overlaps(box)) return;
    if (node < leaves_) {
      visit_node(2 * node, boxes, box, visit);
      visit_node(2 * node + 1, boxes, box, visit);
    } else {
      for_slots(node, boxes, [&](Index j) {
        if (boxes[j].overlaps(box)) visit(j);
      });
    }
  }

  template <class Visit>
  void visit_pairs(std::size_t a, std::size_t b, std::span<const SlotBox> boxes, Visit& visit) const {
    if (a != b && !nodes_[a].overlaps(nodes_[b])) return;
    if (a < leaves_) {
      visit_pairs(2 * a, 2 * b, boxes, visit);
      visit_pairs(2 * a, 2 * b + 1, boxes, visit);
      if (a != b) visit_pairs(2 * a + 1, 2 * b, boxes, visit);
      visit_pairs(2 * a + 1, 2 * b + 1, boxes, visit);
    } else {
      for_slots(a, boxes, [&](Index i) {
        for_slots(b, boxes, [&](Index j) {
          if ((a != b || i < j) && boxes[i].overlaps(boxes[j])) visit(i, j);
        });
      });
    }
  }

  std::size_t leaves_ = 0;      // a power of two; leaf i is node leaves_ + i
  std::vector<SlotBox> nodes_;  // the root is node 1
};

}  // namespace vmesh
