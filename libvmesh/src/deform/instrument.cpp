#include <cmath>
#include <string>

#include "vmesh/core/error.h"

#include "deform/instrument_checks.h"

namespace vmesh {

void check_shape(const InstrumentShape& shape) {
  const auto fail = [](const std::string& what) { throw InvalidInput("instrument: " + what); };
  if (shape.points_mm.empty()) fail("it needs at least one point");
  if (shape.points_mm.size() != shape.radii_mm.size())
    fail("it has " + std::to_string(shape.points_mm.size()) + " points and " + std::to_string(shape.radii_mm.size()) +
         " radii; give one each");
  for (const Vec3& p : shape.points_mm)
    if (!p.allFinite()) fail("its points must be finite");
  for (const double r : shape.radii_mm)
    if (!(std::isfinite(r) && r > 0)) fail("its radii must be finite and above 0");
  if (!(shape.friction >= 0 && shape.friction <= 10)) fail("its friction must be in [0, 10]");
}

void check_pose(const InstrumentPose& pose) {
  if (!pose.position_mm.allFinite() || !pose.rotation.coeffs().allFinite() ||
      !(std::abs(pose.rotation.norm() - 1) < 1e-6))
    throw InvalidInput("instrument: its position must be finite and its rotation a unit quaternion");
}

InstrumentPose between(const InstrumentPose& a, const InstrumentPose& b, double part) {
  if (part <= 0) return a;
  if (part >= 1) return b;
  return {a.position_mm + part * (b.position_mm - a.position_mm), a.rotation.slerp(part, b.rotation).normalized()};
}

InstrumentPose InstrumentPath::at(double time) const {
  std::size_t next = 0;
  while (next < time_s.size() && time_s[next] <= time) ++next;
  if (next == 0) return pose.front();
  if (next == time_s.size()) return pose.back();
  return between(pose[next - 1], pose[next], (time - time_s[next - 1]) / (time_s[next] - time_s[next - 1]));
}

}  // namespace vmesh
