#include "surface/proof/gap.h"

#include <cmath>

namespace vmesh {
namespace {

constexpr int kSteps = 12;  // of Newton's method; three or four usually suffice; idle 8 to 17
// Length of the sum of two walls' normals below which they are parallel; idle 0.014 to 0.028.
constexpr double kSharp = 0.02;
constexpr double kFacingWalls = 0.5;  // cosine between walls below which they face each other

}  // namespace

Walls Gaps::walls_at(const Vec3& p, const Vec3& across, Index hint) const {
  Walls walls;
  for (const Index cone : field_.relations().local_cones(field_.sample(p, hint).cone)) {
    const FieldSample s = field_.sample_cone(p, cone);
    const bool first = s.gradient.dot(across) > 0;
    double& least = first ? walls.first : walls.second;
    if (s.distance >= least) continue;
    least = s.distance;
    (first ? walls.first_normal : walls.second_normal) = s.gradient;
    (first ? walls.first_cone : walls.second_cone) = cone;
  }
  return walls;
}

std::optional<BoundaryPoint> Gaps::end_from(Vec3 p, const Vec3& across, Index hint, double filled,
                                            double tolerance) const {
  FieldSample s = field_.sample(p, hint);
  for (int step = 0; step < kSteps; ++step) {
    const Walls walls = walls_at(p, across, s.cone);
    if (std::isinf(walls.first) || std::isinf(walls.second) || walls.up().norm() < kSharp) return std::nullopt;
    const Vec3 apart = walls.first_normal - walls.second_normal;
    p -= (walls.first - walls.second) / apart.squaredNorm() * apart;
    s = field_.sample(p, s.cone);
    const double off = s.distance / (0.5 * walls.up().norm()) - filled;
    if (std::abs(off) < tolerance) return BoundaryPoint{p, s};
    p -= off * walls.up().normalized();
    s = field_.sample(p, s.cone);
  }
  return std::nullopt;
}

std::optional<Notch> Gaps::notch_below(const Vec3& p, const FieldSample& a, const FieldSample& b,
                                       double tolerance) const {
  if (a.gradient.dot(b.gradient) > kFacingWalls) return std::nullopt;
  const Vec3 across = a.gradient - b.gradient;
  const auto end = end_from(p, across, a.cone, 0, tolerance);
  if (!end) return std::nullopt;
  const Walls walls = walls_at(end->position, across, end->sample.cone);
  if (walls.first_cone == kNone || walls.second_cone == kNone) return std::nullopt;
  return Notch{*end, walls};
}

}  // namespace vmesh
