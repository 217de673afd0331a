#include "deform/slot_boxes.h"

#include <algorithm>
#include <bit>

namespace vmesh {

SlotBoxes::SlotBoxes(std::size_t slots) {
  if (slots > 0) leaves_ = std::bit_ceil((slots + kLeaf - 1) / kLeaf);
  nodes_.resize(2 * leaves_);
}

void SlotBoxes::refit(std::span<const SlotBox> boxes) {
  const SlotBox nothing{Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
  for (std::size_t node = 2 * leaves_; node-- > 1;) {
    SlotBox box = nothing;
    if (node >= leaves_) {
      for_slots(node, boxes, [&](Index j) { box.include(boxes[j]); });
    } else {
      box = nodes_[2 * node];
      box.include(nodes_[2 * node + 1]);
    }
    nodes_[node] = box;
  }
}

}  // namespace vmesh
