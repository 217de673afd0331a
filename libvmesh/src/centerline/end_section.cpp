#include "vmesh/centerline/end_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vmesh {

std::string problem_of(const EndSection& section) {
  if (!section.center.allFinite()) return "its center is not finite (NaN or infinity)";
  if (!section.normal.allFinite()) return "its normal is not finite (NaN or infinity)";
  if (!(section.normal.cwiseAbs().maxCoeff() > 0)) return "its normal is zero";
  if (!std::isfinite(section.area)) return "its area is not finite (NaN or infinity)";
  if (!(section.area > 0)) return "its area must be greater than 0";
  if (!section.ring.empty() && section.ring.size() < 3) return "its ring needs at least three points, or none";
  if (!std::all_of(section.ring.begin(), section.ring.end(), [](const Vec3& p) { return p.allFinite(); }))
    return "a point of its ring is not finite (NaN or infinity)";
  return {};
}

double radius_of(const EndSection& section) { return std::sqrt(section.area / std::numbers::pi); }

}  // namespace vmesh
