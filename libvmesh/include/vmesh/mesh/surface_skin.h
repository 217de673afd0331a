#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Bones of a surface, for linear blend skinning: a vertex at x moves to the sum of weight * (R (x - p0) + p) over its
/// four joints, where p0 is the joint's position at rest and R and p are its rotation and position now.
struct SurfaceSkin {
  struct Joint {
    std::string name;
    Vec3 position = Vec3::Zero();  ///< at rest, mm
  };

  std::vector<Joint> joints;
  std::vector<std::array<Index, 4>> joint_of_vertex;  ///< distinct, or 0 with weight 0
  std::vector<std::array<float, 4>> weight;           ///< of these, in [0, 1]; their sum is 1
};

}  // namespace vmesh
