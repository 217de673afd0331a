#include "deform/round_cones.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vmesh {
namespace {

/// Parallel lines have no point where they are nearest; from this sine squared on, the edges are tried, too.
constexpr double kNearlyParallel = 1e-6;
/// An advance keeps at least this share of the gap, of a narrow one nearly all, and ends once nearly there.
constexpr double kKeptGap = 0.3, kKeptNarrow = 0.999, kNearlyThere = 0.1;
constexpr int kMostAdvances = 128;

/// Minimises |p + s q| - slope s for s in [0, 1]: convex.
double best_on_edge(const Vec3& p, const Vec3& q, double slope) {
  const double qq = q.squaredNorm();
  if (slope * slope >= qq) return slope > 0 ? 1 : 0;
  const double middle = -p.dot(q) / qq;
  if (slope == 0) return std::clamp(middle, 0.0, 1.0);
  const double height = (p + middle * q).norm();
  return std::clamp(middle + slope * height / std::sqrt(qq * (qq - slope * slope)), 0.0, 1.0);
}

/// The axes and how radii change along them.
struct Pair {
  Vec3 apart, u, v;  // apart + s u - t v is from the second to the first
  double radii, grows_u, grows_v;

  Pair(const ContactCone& first, const ContactCone& second)
      : apart(first.a - second.a),
        u(first.b - first.a),
        v(second.b - second.a),
        radii(first.radius_a + second.radius_a),
        grows_u(first.radius_b - first.radius_a),
        grows_v(second.radius_b - second.radius_a) {}

  ConeGap at(double s, double t) const {
    const Vec3 way = apart + s * u - t * v;
    const double length = way.norm();
    ConeGap gap{length - radii - s * grows_u - t * grows_v, s, t, Vec3::UnitX()};
    if (length > 0) gap.direction = way / length;
    return gap;
  }
};

/// How far two can go until their distance along a fixed direction is `kept`. Their gap is at least that distance,
/// which is least at two of the ends: linear in the way.
double free_along(const Vec3& direction, const ContactCone& first, const ContactCone& second,
                  const std::array<Vec3, 4>& way, double kept) {
  const std::array<double, 4> at{direction.dot(first.a) - first.radius_a, direction.dot(first.b) - first.radius_b,
                                 direction.dot(second.a) + second.radius_a, direction.dot(second.b) + second.radius_b};
  double part = 1;
  for (const std::size_t i : {0U, 1U})
    for (const std::size_t j : {2U, 3U}) {
      const double nearing = direction.dot(way[j] - way[i]);
      if (nearing > 0) part = std::min(part, (at[i] - at[j] - kept) / nearing);
    }
  return part;
}

}  // namespace

/// The distance of two points minus the radii there is convex in both parameters: the minimum lies where its
/// derivatives vanish, or on an edge of the square of parameters.
ConeGap gap_between(const ContactCone& first, const ContactCone& second) {
  const Pair pair(first, second);
  const double uu = pair.u.squaredNorm(), vv = pair.v.squaredNorm(), uv = pair.u.dot(pair.v);
  const double det = uu * vv - uv * uv;
  ConeGap best;
  bool found = false;
  if (det > 1e-12 * uu * vv) {
    const double wu = pair.apart.dot(pair.u), wv = pair.apart.dot(pair.v);
    const double s = (uv * wv - vv * wu) / det, t = (uu * wv - uv * wu) / det;
    const double ds = (vv * pair.grows_u + uv * pair.grows_v) / det, dt = (uu * pair.grows_v + uv * pair.grows_u) / det;
    const double flare = pair.grows_u * ds + pair.grows_v * dt;
    if (flare < 1) {
      const double reach = (pair.apart + s * pair.u - t * pair.v).norm() / std::sqrt(1 - flare);
      const double at_u = s + reach * ds, at_v = t + reach * dt;
      if (at_u >= 0 && at_u <= 1 && at_v >= 0 && at_v <= 1) best = pair.at(at_u, at_v), found = true;
    }
  }
  if (found && det > kNearlyParallel * uu * vv) return best;
  const auto take = [&](double s, double t) {
    const ConeGap gap = pair.at(s, t);
    if (!found || gap.gap < best.gap) best = gap, found = true;
  };
  for (const double t : {0.0, 1.0}) take(best_on_edge(pair.apart - t * pair.v, pair.u, pair.grows_u), t);
  for (const double s : {0.0, 1.0}) take(s, best_on_edge(pair.apart + s * pair.u, -pair.v, pair.grows_v));
  return best;
}

ContactCone between(const ConeMotion& m, double part) {
  return {m.from.a + part * (m.to.a - m.from.a), m.from.b + part * (m.to.b - m.from.b), m.from.radius_a,
          m.from.radius_b};
}

double free_part(const ConeMotion& first, const ConeMotion& second, double gap, const KeptGap& keeps) {
  std::array<Vec3, 4> way{first.to.a - first.from.a, first.to.b - first.from.b, second.to.a - second.from.a,
                          second.to.b - second.from.b};
  const Vec3 common = 0.25 * (way[0] + way[1] + way[2] + way[3]);
  const auto longest = [&](std::size_t i) {
    return std::sqrt(std::max((way[i] - common).squaredNorm(), (way[i + 1] - common).squaredNorm()));
  };
  const double most = longest(0) + longest(2);
  const double kept =
      gap > 2 * keeps.narrowest ? std::max(kKeptGap * std::min(gap, keeps.wide), keeps.narrowest) : kKeptNarrow * gap;
  if (most <= gap - kept) return 1;
  double part = 0;
  for (int i = 0; i < kMostAdvances; ++i) {
    const ContactCone a = between(first, part), b = between(second, part);
    const ConeGap now = gap_between(a, b);
    if (i > 0 && now.gap - kept < kNearlyThere * (gap - kept)) return part;
    part += std::max((now.gap - kept) / most, free_along(now.direction, a, b, way, kept));
    if (part >= 1) return 1;
  }
  return part;
}

}  // namespace vmesh
