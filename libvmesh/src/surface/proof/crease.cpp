#include "surface/proof/crease.h"

#include <algorithm>
#include <cmath>

#include "surface/proof/by_slope.h"

namespace vmesh {
namespace {

// Largest cosine between the gradients of two cones that meet in a crease.
constexpr double kCrease = 0.9;
constexpr int kNewtonSteps = 6;
constexpr double kNearer = 0.3;  // samples on both sides of a kink are taken at this share of the last distance from it

// The plane that a sample tells of.
struct WallPlane {
  double distance;  // of p
  Vec3 normal;
};
WallPlane plane_of(const BoundaryPoint& at, const Vec3& p) {
  const double slope = at.sample.gradient.norm();
  if (!(slope > 0)) return {0, Vec3::Zero()};
  const Vec3 normal = at.sample.gradient / slope;
  return {at.sample.distance / slope + normal.dot(p - at.position), normal};
}

// Whether these are of two walls.
bool are_two(const WallPlane& a, const WallPlane& b) { return a.normal.dot(b.normal) < kCrease; }

// The shortest way to both planes; nothing if they are nearly parallel.
std::optional<Vec3> way_to_both(const WallPlane& a, const WallPlane& b) {
  const double cosine = a.normal.dot(b.normal), divisor = 1 - cosine * cosine;
  if (divisor < 1e-3) return std::nullopt;
  return Vec3(-((a.distance - cosine * b.distance) / divisor * a.normal +
                (b.distance - cosine * a.distance) / divisor * b.normal));
}

}  // namespace

std::vector<Crease> creases_between(const VesselField& field, const CreaseEnd& a, const CreaseEnd& b) {
  const auto are_along = [&](Index c, Index d) {
    return c == d || field.sample_cone(a.position, c).gradient.dot(field.sample_cone(b.position, d).gradient) > kCrease;
  };
  std::vector<Crease> pairs;
  const auto add = [&](Index c, Index d) {
    const Crease pair = std::minmax(c, d);
    if (!are_along(c, d) && std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
  };
  const bool along = a.cones.size() == 2 && b.cones.size() == 2;
  if (along) {
    add(a.cones[0], a.cones[1]);
    add(b.cones[0], b.cones[1]);
  }
  // From a crease to a wall beside it.
  const bool beside = !along && std::any_of(a.cones.begin(), a.cones.end(), [&](Index c) {
    return std::any_of(b.cones.begin(), b.cones.end(), [&](Index d) { return are_along(c, d); });
  });
  if (beside) return {};
  for (const Index c : a.cones) {
    for (const Index d : b.cones) add(c, d);
  }
  return pairs;
}

std::optional<BoundaryPoint> onto_crease(const VesselField& field, const Crease& crease, Vec3 p, double limit) {
  const double tolerance = 0.01 * limit;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const FieldSample a = field.sample_cone(p, crease.first), b = field.sample_cone(p, crease.second);
    if (std::max(std::abs(a.distance), std::abs(b.distance)) < tolerance) {
      const FieldSample s = field.sample(p, crease.first);
      return std::abs(s.distance) < 0.1 * limit ? std::optional(BoundaryPoint{p, s}) : std::nullopt;
    }
    const auto way = way_to_both({a.distance, a.gradient}, {b.distance, b.gradient});
    if (!way) return std::nullopt;
    p += *way;
  }
  return std::nullopt;
}

std::optional<BoundaryPoint> onto_kink(const VesselField& field, const BoundaryPoint& a, const BoundaryPoint& b,
                                       double limit) {
  const Vec3 middle = 0.5 * (a.position + b.position);
  const double reach = (a.position - b.position).norm();
  const auto beside = [&](const Vec3& p, const BoundaryPoint& end, double share) {
    const Vec3 q = p + share * (end.position - p);
    return plane_of({q, field.sample(q, end.sample.cone)}, p);
  };
  Vec3 p = middle;
  double share = 1;
  for (int step = 0; step < kNewtonSteps; ++step, share *= kNearer) {
    const WallPlane first = beside(p, a, share), second = beside(p, b, share);
    if (!are_two(first, second)) return std::nullopt;
    if (step > 0 && std::max(std::abs(first.distance), std::abs(second.distance)) < 0.1 * limit) {
      const FieldSample s = field.sample(p, a.sample.cone);
      if (std::abs(distance_by_slope(s)) < 0.1 * limit) return BoundaryPoint{p, s};
    }
    const auto way = way_to_both(first, second);
    if (!way || (p + *way - middle).norm() > reach) return std::nullopt;
    p += *way;
  }
  return std::nullopt;
}

}  // namespace vmesh
