#pragma once

#include <cmath>

namespace vmesh {

/// The energy of a gap below `reach`: -stiffness (gap - reach)^2 ln(gap / reach) (Li et al. 2020), its slope (negative)
/// and its curvature (positive). Infinite where there is no gap.
struct Barrier {
  double stiffness, reach;

  double energy(double gap) const {
    if (gap >= reach) return 0;
    if (!(gap > 0)) return HUGE_VAL;
    const double d = gap - reach;
    return -stiffness * d * d * std::log(gap / reach);
  }
  double slope(double gap) const {
    if (gap >= reach) return 0;
    const double d = gap - reach;
    return -stiffness * d * (2 * std::log(gap / reach) + d / gap);
  }
  double curvature(double gap) const {
    if (gap >= reach) return 0;
    const double ratio = (gap - reach) / gap;
    return -stiffness * (2 * std::log(gap / reach) + ratio * (4 - ratio));
  }
};

/// Friction as the slope of an energy of the way slipped since the start of a step, for a load of 1: rises from 0 to 1
/// within `yield`.
struct Slipping {
  double yield;

  double energy(double way) const {
    if (way >= yield) return way - yield / 3;
    return way * way / yield * (1 - way / (3 * yield));
  }
  double slope_over_way(double way) const { return way >= yield ? 1 / way : (2 - way / yield) / yield; }
  double curvature(double way) const { return way >= yield ? 0 : 2 * (1 - way / yield) / yield; }
};

}  // namespace vmesh
