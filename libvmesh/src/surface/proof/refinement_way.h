#pragma once

#include <array>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// What differs between the ways in which a surface is refined. Of little consequence for most places; where walls meet
/// at small angles, one finds a way where another is stuck.
struct RefinementWay {
  bool into_gaps;                        ///< ends of gaps are looked for where no crease is known
  bool descends;                         ///< edges far above a crease are divided on the way down
  std::array<double, 2> upright_splits;  ///< least cosines between faces' normals and the gradient, tried one by one
  double upright;                        ///< the same for flips and moves
  /// Of the square root of limit times radius, which edges of even surfaces have about three times: no edge becomes
  /// shorter.
  double shortest = 0.3;
};

/// A ball in which another way is taken, because those before did not do.
struct HardPlace {
  Vec3 center = Vec3::Zero();
  double reach = 0;  ///< mm
  int way = 0;       ///< below refinement_ways()

  bool operator==(const HardPlace&) const = default;
};

int refinement_ways();
/// That of the first place that holds `p`, else the usual one.
const RefinementWay& way_around(const std::vector<HardPlace>& hard, const Vec3& p);

}  // namespace vmesh
