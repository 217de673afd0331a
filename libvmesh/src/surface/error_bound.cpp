#include "vmesh/surface/error_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

namespace vmesh {
namespace {

constexpr int kPieces = 2;    // along an edge of a face: the shell follows the normals that much closer
constexpr int kMaxDepth = 5;  // of further subdivision, into four each

using Points = std::array<Vec3, 3>;

Vec3 centroid(const Points& q) { return (q[0] + q[1] + q[2]) / 3; }

// How far the corners are from `center`, at most.
double reach(const Points& q, const Vec3& center) {
  double farthest = 0;
  for (const Vec3& p : q) farthest = std::max(farthest, (p - center).norm());
  return farthest;
}

std::array<Points, 4> quarters(const Points& q) {
  const Vec3 a = 0.5 * (q[1] + q[2]), b = 0.5 * (q[2] + q[0]), c = 0.5 * (q[0] + q[1]);
  return {Points{q[0], c, b}, Points{c, q[1], a}, Points{b, a, q[2]}, Points{a, b, c}};
}

// What is known of a cone over a triangle.
struct ConeBounds {
  double low = 0, high = 0;                // of the signed distance
  double at_center = 0;                    // the signed distance at the centroid
  double least_radius = 0, most_radius = 0;  // of the sphere that touches the boundary, over the triangle
  double turn = 0;                         // how far the gradient turns from where it points at the centroid, radians
  Vec3 gradient = Vec3::Zero();            // at the centroid
};

// The sine and cosine of a cone's half angle, as its radius per length and what goes with it.
double radius_slope(const VesselField& field, Index cone) {
  const double length = (field.axis_point(cone, 1) - field.axis_point(cone, 0)).norm();
  const double change = std::abs(field.radius_at(cone, 1) - field.radius_at(cone, 0));
  if (change >= length) return std::numeric_limits<double>::infinity();
  const double sine = change / length;
  return sine / std::sqrt(1 - sine * sine);
}

class TriangleTest {
 public:
  TriangleTest(const VesselField& field, const std::vector<Index>& cones) : field_(field), cones_(cones) {}

  bool outside(const Points& q, int depth) {
    measure(q);
    if (lower_bound() >= 0) return true;
    if (depth == 0 || value_at_center() < 0) return false;
    for (const Points& part : quarters(q)) {
      if (!outside(part, depth - 1)) return false;
    }
    return true;
  }

  bool inside(const Points& q, int depth) {
    measure(q);
    if (upper_bound() <= 0) return true;
    if (depth == 0 || value_at_center() > 0) return false;
    for (const Points& part : quarters(q)) {
      if (!inside(part, depth - 1)) return false;
    }
    return true;
  }

 private:
  void measure(const Points& q) {
    const Vec3 center = centroid(q);
    reach_ = reach(q, center);
    bounds_.clear();
    for (const Index cone : cones_) {
      const FieldSample s = field_.sample_cone(center, cone);
      ConeBounds b;
      b.at_center = s.distance;
      b.gradient = s.gradient;
      b.low = b.high = s.distance;
      for (const Vec3& p : q) {
        b.low = std::min(b.low, s.distance + s.gradient.dot(p - center));
        b.high = std::max(b.high, field_.sample_cone(p, cone).distance);
      }
      const auto [thin, wide] = std::minmax(field_.radius_at(cone, 0), field_.radius_at(cone, 1));
      const double radius = field_.radius_at(cone, s.t), change = radius_slope(field_, cone) * reach_;
      b.least_radius = std::max(thin, radius - change);
      b.most_radius = std::min(wide, radius + change);
      const double from_axis = radius + s.distance - reach_ - std::min(change, wide - thin);
      b.turn = from_axis > 0 ? std::min(std::numbers::pi, reach_ / from_axis) : std::numbers::pi;
      bounds_.push_back(b);
    }
  }

  // Width over which two cones are blended, if their gradients are `angle` apart.
  double width(double radius, double angle) const {
    return field_.blend() * radius * (1 - std::cos(std::clamp(angle, 0.0, std::numbers::pi)));
  }

  static double angle_between(const ConeBounds& a, const ConeBounds& b) {
    return 2 * std::asin(std::min(1.0, 0.5 * (a.gradient - b.gradient).norm()));
  }

  static double smooth_minimum(double low, double high, double width) {
    if (high < low) std::swap(low, high);
    if (high - low >= width) return low;
    const double h = 1 - (high - low) / width;
    return low - h * h * width / 4;
  }

  double lower_bound() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      least = std::min(least, bounds_[i].low);
      if (field_.blend() == 0) continue;
      for (std::size_t j = 0; j < i; ++j) least = std::min(least, pair_lower_bound(bounds_[i], bounds_[j]));
    }
    return least;
  }

  // The smooth minimum grows with either distance and falls with the width.
  double pair_lower_bound(const ConeBounds& a, const ConeBounds& b) const {
    const double radius = std::min(a.most_radius, b.most_radius);
    const double widest = width(radius, angle_between(a, b) + a.turn + b.turn);
    const double low = std::min(a.low, b.low);
    const double gap = std::max(0.0, std::abs(a.at_center - b.at_center) - 2 * reach_);
    if (gap >= widest) return low;
    const double h = 1 - gap / widest;
    return std::max(low - h * h * widest / 4, smooth_minimum(a.low, b.low, widest));
  }

  double upper_bound() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      least = std::min(least, bounds_[i].high);
      if (field_.blend() == 0) continue;
      for (std::size_t j = 0; j < i; ++j) {
        const ConeBounds &a = bounds_[i], &b = bounds_[j];
        const double narrowest =
            width(std::min(a.least_radius, b.least_radius), angle_between(a, b) - a.turn - b.turn);
        if (narrowest > 0) least = std::min(least, smooth_minimum(a.high, b.high, narrowest));
      }
    }
    return least;
  }

  // Neither bound can be on the other side of this.
  double value_at_center() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      least = std::min(least, bounds_[i].at_center);
      if (field_.blend() == 0) continue;
      for (std::size_t j = 0; j < i; ++j) {
        const ConeBounds &a = bounds_[i], &b = bounds_[j];
        const double w = width(std::min(middle_radius(a), middle_radius(b)), angle_between(a, b));
        if (w > 0) least = std::min(least, smooth_minimum(a.at_center, b.at_center, w));
      }
    }
    return least;
  }

  static double middle_radius(const ConeBounds& b) { return 0.5 * (b.least_radius + b.most_radius); }

  const VesselField& field_;
  const std::vector<Index>& cones_;
  std::vector<ConeBounds> bounds_;
  double reach_ = 0;
};

// The cones that can be nearest, or be blended with the nearest, within `radius` of `center`.
void find_cones(const VesselField& field, const Vec3& center, double radius, Index hint, std::vector<Index>& cones) {
  const Index nearest = field.sample(center, hint).cone;
  struct Near {
    Index cone;
    double distance, radius;
  };
  thread_local std::vector<Near> all;
  all.clear();
  double least = std::numeric_limits<double>::infinity();
  for (const Index cone : field.local_cones(nearest)) {
    const double widest = std::max(field.radius_at(cone, 0), field.radius_at(cone, 1));
    all.push_back({cone, field.sample_cone(center, cone).distance, widest});
    least = std::min(least, all.back().distance);
  }
  cones.clear();
  for (const Near& near : all) {
    if (near.distance - least < 2 * radius + 2 * field.blend() * near.radius) cones.push_back(near.cone);
  }
}

// A face's shell, on a grid of kPieces along each edge. What lies on an edge follows from its ends alone.
struct Shell {
  struct Point {
    Vec3 position, offset;
  };
  std::vector<std::array<Point, 3>> parts;

  explicit Shell(const std::array<ErrorProof::Corner, 3>& face) {
    const auto point = [&](int i, int j) {
      const double w[3] = {1 - double(i + j) / kPieces, double(i) / kPieces, double(j) / kPieces};
      Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
      double limit = 0;
      for (int k = 0; k < 3; ++k) {
        position += w[k] * face[k].position;
        normal += w[k] * face[k].normal;
        limit += w[k] * face[k].limit;
      }
      return Point{position, limit * normal.normalized()};
    };
    for (int i = 0; i < kPieces; ++i) {
      for (int j = 0; i + j < kPieces; ++j) {
        parts.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
        if (i + j + 2 <= kPieces) parts.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
      }
    }
  }
};

}  // namespace

bool ErrorProof::holds(const std::array<Corner, 3>& face) const {
  const Points corners = {face[0].position, face[1].position, face[2].position};
  const Vec3 center = centroid(corners);
  double limit = 0;
  for (const Corner& c : face) limit = std::max(limit, c.limit);
  thread_local std::vector<Index> cones;
  find_cones(field_, center, reach(corners, center) + limit, face[0].cone, cones);
  TriangleTest test(field_, cones);
  for (const auto& part : Shell(face).parts) {
    Points inner, outer;
    for (int k = 0; k < 3; ++k) {
      inner[k] = part[k].position - part[k].offset;
      outer[k] = part[k].position + part[k].offset;
    }
    if (!test.inside(inner, kMaxDepth) || !test.outside(outer, kMaxDepth)) return false;
  }
  return true;
}

std::vector<Index> unproven_faces(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const VesselField& field, const ErrorLimit& limit) {
  std::vector<Vec3> normal(mesh.vertices.size(), Vec3::Zero());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) normal[v] += area_normal(mesh, f);
  }
  std::vector<char> proven(mesh.faces.size(), 0);
  const ErrorProof proof(field);
  tbb::parallel_for(std::size_t{0}, mesh.faces.size(), [&](std::size_t f) {
    std::array<ErrorProof::Corner, 3> face;
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      const auto& [cone, t] = binding[v];
      face[k] = {mesh.vertices[v], normal[v].normalized(), limit.at(field.radius_at(cone, t)), cone};
    }
    proven[f] = proof.holds(face);
  });
  std::vector<Index> unproven;
  for (Index f = 0; f < proven.size(); ++f) {
    if (!proven[f]) unproven.push_back(f);
  }
  return unproven;
}

}  // namespace vmesh
