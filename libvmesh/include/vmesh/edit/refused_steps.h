#pragma once

#include "vmesh/core/types.h"

namespace vmesh {

/// How many steps were not taken, by the first reason found.
struct RefusedSteps {
  Index degenerate = 0;  ///< a face would have lost its area
  Index axis = 0;        ///< a face would have crossed the axis of a vessel
  Index crossing = 0;    ///< faces would have crossed each other

  RefusedSteps& operator+=(const RefusedSteps& other) {
    degenerate += other.degenerate;
    axis += other.axis;
    crossing += other.crossing;
    return *this;
  }
};

}  // namespace vmesh
