#include "surface/proof/by_slope.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

// Vessels that part at two degrees.
constexpr double kLeastSlope = 0.02;
constexpr int kMostSteps = 20;        // of Newton's method; three usually suffice
constexpr double kLongestStep = 0.1;  // radii: slopes change much within less than that

}  // namespace

double distance_by_slope(const FieldSample& sample) {
  return sample.distance / std::clamp(sample.gradient.norm(), kLeastSlope, 1.0);
}

BoundaryPoint onto_boundary(const VesselField& field, const Vec3& p, Index hint, double tolerance, double height) {
  BoundaryPoint at{p, field.sample_fast(p, hint)};
  for (int step = 0; step < kMostSteps; ++step) {
    const double off = distance_by_slope(at.sample) - height, slope = at.sample.gradient.norm();
    const double radius = field.relations().radius_at(at.sample.cone, at.sample.t), longest = kLongestStep * radius;
    if (std::abs(off) <= tolerance * radius || slope < kLeastSlope) break;
    at.position -= std::clamp(off, -longest, longest) / slope * at.sample.gradient;
    at.sample = field.sample_fast(at.position, at.sample.cone);
  }
  return at;
}

}  // namespace vmesh
