// A tree that instruments press on, for measurements.
#pragma once

#include <vector>

#include "vmesh/deform/simulation.h"

namespace vmesh::tool {

/// Up to thirty balls of half of a segment's radius press on segments from the side, to and fro, two thirds of them at
/// a time. The widest end's node is clamped, and nothing is ever at rest.
class PressedTree {
 public:
  explicit PressedTree(const Centerline& centerline);

  StepReport step();
  int contacts() const;  ///< of the last step

 private:
  CenterlineSimulation simulation_;
  std::vector<Vec3> from_, towards_;  // by ball
  double time_ = 0;
};

}  // namespace vmesh::tool
