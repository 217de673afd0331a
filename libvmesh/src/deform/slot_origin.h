#pragma once

#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Where the state of a slot comes from when a centerline is cut: slots of before.
struct SlotOrigin {
  Index a = 0, b = 0;  ///< of the node: between these two
  double share = 0;    ///< of b
  Index frame = 0;     ///< whose frame belongs to the same segment
};

template <class Value>
Value carried(const std::vector<Value>& before, const SlotOrigin& origin) {
  if (origin.a == origin.b) return before[origin.a];
  return (1 - origin.share) * before[origin.a] + origin.share * before[origin.b];
}

/// By slot.
template <class Value>
std::vector<Value> carried(const std::vector<Value>& before, const std::vector<SlotOrigin>& origin) {
  std::vector<Value> after;
  after.reserve(origin.size());
  for (const SlotOrigin& o : origin) after.push_back(carried(before, o));
  return after;
}

}  // namespace vmesh
