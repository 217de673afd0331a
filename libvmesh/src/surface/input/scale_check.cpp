#include "surface/input/scale_check.h"

#include <limits>
#include <sstream>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

// Ninth powers of lengths and of their inverses stay in the range of double; no higher powers are taken.
constexpr double kLongest = 1e30, kShortest = 1e-30;  // kShortest: idle 7e-31 to 1.4e-30
// Where positions are rounded to more than a thousandth of the radius, a cross-section is no longer a circle.
constexpr double kRoundingsPerRadius = 1000;

[[noreturn]] void fail(const Centerline& centerline, Index n, const std::string& what) {
  const auto& [p, radius] = centerline.node(n);
  std::ostringstream text;
  text << "node " << n << " at (" << p.transpose() << "), radius " << radius << ": " << what;
  throw InvalidInput(text.str());
}

}  // namespace

void check_scale(const Centerline& centerline) {
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    const auto& [p, radius] = centerline.node(n);
    const double farthest = p.cwiseAbs().maxCoeff();
    if (farthest > kLongest || radius > kLongest || radius < kShortest) {
      fail(centerline, n, "lengths must be between 1e-30 and 1e30 mm; check the unit");
    }
    if (radius < kRoundingsPerRadius * std::numeric_limits<double>::epsilon() * farthest) {
      fail(centerline, n,
           "so far from the origin, numbers of 16 digits cannot resolve so thin a vessel; move the centerline to the "
           "origin, or check the radius");
    }
  }
}

}  // namespace vmesh
