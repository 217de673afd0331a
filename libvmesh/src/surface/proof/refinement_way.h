#pragma once

#include <array>

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
  bool at_kinks = false;  ///< edges are divided where the boundary bends sharply
};

/// The first is the usual one.
const RefinementWay& refinement_way(int number);
int refinement_ways();
/// Those that divide edges where the boundary bends sharply.
inline constexpr int kWaysAtKinks[] = {8, 9};

}  // namespace vmesh
