#include "surface/check/triangle_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "surface/check/tested_cone.h"

namespace vmesh {
namespace {

constexpr int kMaxDepth = 5;     // of further subdivision, into four each; safe 4 to 7
constexpr double kSlack = 1e-6;  // derived: of a triangle, far more than distances are rounded by

using Points = TrianglePoints;

std::array<Points, 4> quarters(const Points& q) {
  const Vec3 a = 0.5 * (q[1] + q[2]), b = 0.5 * (q[2] + q[0]), c = 0.5 * (q[0] + q[1]);
  return {Points{q[0], c, b}, Points{c, q[1], a}, Points{b, a, q[2]}, Points{a, b, c}};
}

// Bounds on a cone's field over a triangle.
struct ConeBounds {
  const TestedCone* cone = nullptr;
  double low = 0, high = 0;                  // of the signed distance
  double at_center = 0;                      // the signed distance at the centroid
  double least_radius = 0, most_radius = 0;  // of the sphere that touches the boundary
  double least_reach = 0, most_reach = 0;    // of the blend
  double turn = 0;                     // bound on the difference of the gradient from that at the centroid, at most 2
  double from_center = 0;              // bound on the distance from the touching sphere's centre
  Vec3 gradient = Vec3::Zero();        // at the centroid
  std::array<double, 3> tangent = {};  // the tangent of the distance at the centroid, at the corners
  std::array<RoundCone::Distance, 3> at = {};  // the corners
  // The second order, which few triangles need.
  bool has_curvature = false;
  std::array<Vec3, 3> corner_gradient = {};
  // Bounds on the first and the second derivative of the gradient along any line, and on the jump of the first where
  // the triangle may lie on two parts of the cone, its side and a cap; else 0. Infinite too near to the axis.
  double rate = 0, bend = 0, jump = 0;
};

/// The smooth minimum of two distances, blended over `width`. It grows with the distances, falls with the width and is
/// jointly concave in all three: (a + b) / 2 less width psi(|a - b| / width), the perspective of a convex psi.
struct SmoothMinimum {
  double value, by_a, by_b, by_width;  // and its derivatives

  SmoothMinimum(double a, double b, double width) {
    const double low = std::min(a, b), gap = std::abs(a - b);
    const double h = gap < width ? 1 - gap / width : 0;
    value = low - h * h * width / 4;
    (a <= b ? by_a : by_b) = 1 - h / 2;
    (a <= b ? by_b : by_a) = h / 2;
    by_width = gap < width ? (gap * gap / (width * width) - 1) / 4 : 0;
  }
};

double smooth_minimum(double a, double b, double width) { return SmoothMinimum(a, b, width).value; }

// Decides for triangles whether they are inside or outside the volume of a few cones.
class TriangleTest {
 public:
  TriangleTest(const VesselField& field, const std::vector<Index>& cones) : field_(field) {
    cones_.reserve(cones.size());
    for (const Index cone : cones) cones_.emplace_back(field.relations(), cone);
    for (const TestedCone& cone : cones_) stack_.push_back({.cone = &cone});
  }

  bool outside(const Points& q) { return is_outside(q, all(), kMaxDepth); }
  bool inside(const Points& q) { return is_inside(q, all(), kMaxDepth); }

 private:
  // The bounds for a triangle and all triangles that contain it lie on a stack, above all cones; a subtriangle
  // considers only the cones kept for the containing one.
  struct Range {
    std::size_t begin, end;
  };

  Range all() const { return {0, cones_.size()}; }

  bool is_outside(const Points& q, Range whole, int depth) {
    // Most triangles are proven to be outside without their corners.
    if (is_outside_to_first_order(begin_measuring(q, whole))) {
      stack_.resize(whole_end_);
      return true;
    }
    const Range range = finish_measuring();
    bool result = is_outside_to_second_order(range);
    if (!result && depth > 0 && is_outside_at_center(range)) {
      const auto parts = quarters(q);
      result =
          std::all_of(parts.begin(), parts.end(), [&](const Points& p) { return is_outside(p, range, depth - 1); });
    }
    stack_.resize(range.begin);
    return result;
  }

  bool is_inside(const Points& q, Range whole, int depth) {
    for (std::size_t i = whole.begin; i < whole.end; ++i) {
      if (holds(stack_[i].cone->shape, q)) return true;
    }
    begin_measuring(q, whole);
    const Range range = finish_measuring();
    bool result = is_inside_by_bounds(range);
    if (!result && depth > 0 && is_inside_at_center(range)) {
      const auto parts = quarters(q);
      result = std::all_of(parts.begin(), parts.end(), [&](const Points& p) { return is_inside(p, range, depth - 1); });
    }
    stack_.resize(range.begin);
    return result;
  }

  // Whether the cone contains the triangle: the distance is convex, so it is largest at a corner.
  static bool holds(const RoundCone& cone, const Points& q) {
    return std::all_of(q.begin(), q.end(), [&](const Vec3& p) { return cone.distance_to(p).value <= 0; });
  }

  // Pushes bounds for those cones of `whole` that may matter on the triangle; what its corners tell is not yet known.
  Range begin_measuring(const Points& q, Range whole) {
    points_ = &q;
    center_ = triangle_center(q);
    reach_ = triangle_reach(q, center_);
    normal_ = (q[1] - q[0]).cross(q[2] - q[0]).normalized();
    whole_end_ = stack_.size();
    const double blend = field_.relations().blend();
    at_center_.clear();
    double least_at_center = std::numeric_limits<double>::infinity();
    for (std::size_t i = whole.begin; i < whole.end; ++i) {
      at_center_.push_back(stack_[i].cone->shape.distance_to(center_));
      least_at_center = std::min(least_at_center, at_center_.back().value);
    }
    for (std::size_t i = whole.begin; i < whole.end; ++i) {
      // Distances change by the way at most: most cones that are too far are so at the centroid already.
      const RoundCone& shape = stack_[i].cone->shape;
      const double excess = at_center_[i - whole.begin].value - least_at_center - 2 * reach_;
      if (excess > 2 * blend * std::max(shape.r0, shape.r1) + kSlack * reach_) continue;
      stack_.push_back(bounds_of(*stack_[i].cone, at_center_[i - whole.begin]));
    }
    return {whole_end_, stack_.size()};
  }

  // Adds what the corners tell, and leaves out the cones that do not matter.
  Range finish_measuring() {
    const Points& q = *points_;
    double least_high = std::numeric_limits<double>::infinity();
    for (std::size_t i = whole_end_; i < stack_.size(); ++i) {
      ConeBounds& b = stack_[i];
      b.high = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < 3; ++k) {
        b.at[k] = b.cone->shape.distance_to(q[k]);
        b.high = std::max(b.high, b.at[k].value);
      }
      least_high = std::min(least_high, b.high);
    }
    const double blend = field_.relations().blend();
    const auto too_far = [&](const ConeBounds& b) { return b.low > least_high + 2 * blend * b.most_radius; };
    stack_.erase(std::remove_if(stack_.begin() + static_cast<std::ptrdiff_t>(whole_end_), stack_.end(), too_far),
                 stack_.end());
    return {whole_end_, stack_.size()};
  }

  ConeBounds bounds_of(const TestedCone& cone, const RoundCone::Distance& at_center) const {
    const Points& q = *points_;
    ConeBounds b;
    b.cone = &cone;
    b.at_center = b.low = at_center.value;
    b.gradient = cone.shape.gradient(center_, at_center.t);
    for (std::size_t k = 0; k < 3; ++k) {
      b.tangent[k] = at_center.value + b.gradient.dot(q[k] - center_);
      b.low = std::min(b.low, b.tangent[k]);
    }
    b.low = std::max(b.low, distance_of_plane(cone, b.gradient));
    if (field_.relations().blend() == 0) return b;
    const double first = cone.shape.r0, last = cone.shape.r1, radius = cone.shape.radius_at(at_center.t);
    const double change = std::min(cone.slope * reach_, std::abs(last - first));
    b.least_radius = std::max(std::min(first, last), radius - change);
    b.most_radius = std::min(std::max(first, last), radius + change);
    const auto [least_share, most_share] = shares_of(cone, at_center.t);
    b.least_reach = field_.relations().blend() * b.least_radius * least_share;
    b.most_reach = field_.relations().blend() * b.most_radius * most_share;
    // The gradient turns by the distance moved divided by the distance from the touching sphere's centre.
    b.from_center = radius + at_center.value - reach_ - change;
    b.turn = b.from_center > 0.5 * reach_ ? reach_ / b.from_center : 2;
    return b;
  }

  // How far the triangle's plane is from the cone on the side of the gradient: none of its points is nearer. This is
  // what tells of triangles that are long for the cone.
  double distance_of_plane(const TestedCone& cone, const Vec3& gradient) const {
    const Vec3 normal = normal_.dot(gradient) < 0 ? Vec3(-normal_) : normal_;
    const double of_first = normal.dot(center_ - cone.first);
    return std::min(of_first - cone.shape.r0, of_first - normal.dot(cone.axis) - cone.shape.r1);
  }

  // On the side of a cone, the gradient turns around the axis by the way across it over the distance from the touching
  // sphere's centre, D: its first derivative is at most 1 / D, and so it is on a cap. Of a planar turn by v_t / r, with
  // speeds v_t across and v_r along the ray, the second is the root of (2 v_r v_t)^2 + v_t^4 over r^2, at most the root
  // of 4/3; the distance from the axis r is D times the cosine of the half angle. Between side and cap, the part along
  // the axis jumps by up to 1 / D.
  void set_curvature(ConeBounds& b) const {
    if (b.has_curvature) return;
    b.has_curvature = true;
    const TestedCone& cone = *b.cone;
    for (std::size_t k = 0; k < 3; ++k) b.corner_gradient[k] = cone.shape.gradient((*points_)[k], b.at[k].t);
    b.rate = b.bend = b.jump = std::numeric_limits<double>::infinity();
    if (b.from_center <= 0.5 * reach_) return;
    const double sine = cone.is_ball() ? 0 : (cone.shape.r1 - cone.shape.r0) / cone.length;
    const double cosine = std::sqrt(1 - sine * sine);
    b.rate = 1 / b.from_center;
    b.bend = std::sqrt(4.0 / 3) / (cosine * b.from_center * b.from_center);
    b.jump = 0;
    if (cone.is_ball()) return;
    // Where the touching sphere would be on the line of the axis, and by how far it may be off on the triangle.
    const Vec3 away = center_ - cone.first;
    const double along = away.dot(cone.axis) / cone.length, across = away.cross(cone.axis).norm() / cone.length,
                 foot = along + across * sine / cosine, change = reach_ / cosine;
    const bool is_one_part =
        foot + change <= 0 || foot - change >= cone.length || (foot - change >= 0 && foot + change <= cone.length);
    b.jump = is_one_part ? 0 : b.rate;
  }

  // 1 - cos of the angle between two gradients, at the corners, and by how much linear interpolation may be wrong. With
  // a bound K on its second derivative and one J on jumps of the first, at p = sum l_k q_k it is by at most
  // sum l_k (K |q_k - p|^2 / 2 + J |q_k - p|), which is K R^2 / 2 + J R with the largest distance R of a corner from
  // the centroid. Derivatives of a gradient are across it, so that jumps count by the sine of the angle.
  struct Opening {
    std::array<double, 3> at;
    double tolerance;
  };
  Opening opening_of(ConeBounds& a, ConeBounds& b) const {
    set_curvature(a);
    set_curvature(b);
    Opening opening;
    for (std::size_t k = 0; k < 3; ++k) opening.at[k] = 1 - a.corner_gradient[k].dot(b.corner_gradient[k]);
    const double sine = std::min(1.0, (a.gradient - b.gradient).norm() + a.turn + b.turn);
    opening.tolerance =
        (a.bend + b.bend + 2 * a.rate * b.rate) * reach_ * reach_ / 2 + (a.jump + b.jump) * sine * reach_;
    return opening;
  }

  // Below: tangents of the convex distances, and a linear bound on the width. A concave function of linear ones is
  // least at a corner.
  double second_order_low(ConeBounds& a, ConeBounds& b) const {
    const Opening opening = opening_of(a, b);
    if (!std::isfinite(opening.tolerance)) return -std::numeric_limits<double>::infinity();
    const double reach = std::min(a.most_reach, b.most_reach);
    double low = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const double width = reach * std::max(0.0, opening.at[k] + opening.tolerance);
      low = std::min(low, smooth_minimum(a.tangent[k], b.tangent[k], width));
    }
    return low;
  }

  // Above: distances at the corners, linear between them, and a linear bound on the width. A concave function is below
  // its tangent, here at the means.
  double second_order_high(ConeBounds& a, ConeBounds& b) const {
    const Opening opening = opening_of(a, b);
    if (!std::isfinite(opening.tolerance)) return std::numeric_limits<double>::infinity();
    const double reach = std::min(a.least_reach, b.least_reach);
    std::array<double, 3> width;
    for (std::size_t k = 0; k < 3; ++k) {
      width[k] = reach * (opening.at[k] - opening.tolerance);
      if (width[k] < 0) return std::numeric_limits<double>::infinity();
    }
    const auto mean = [](double x, double y, double z) { return (x + y + z) / 3; };
    const double of_a = mean(a.at[0].value, a.at[1].value, a.at[2].value),
                 of_b = mean(b.at[0].value, b.at[1].value, b.at[2].value),
                 of_width = mean(width[0], width[1], width[2]);
    const SmoothMinimum middle(of_a, of_b, of_width);
    double high = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k)
      high = std::max(high, middle.value + middle.by_a * (a.at[k].value - of_a) + middle.by_b * (b.at[k].value - of_b) +
                                middle.by_width * (width[k] - of_width));
    return high;
  }

  // Least and greatest share of the blend left to a cone on the triangle. The touching sphere moves along the axis by
  // the distance moved divided by the cosine of the cone's half angle.
  std::pair<double, double> shares_of(const TestedCone& cone, double t) const {
    const auto [least, most] = std::minmax({cone.first_share, cone.last_share});
    const double share = cone.share_at(t);
    if (least == most || cone.is_ball()) return {share, share};
    const double change = std::min(std::sqrt(1 + cone.slope * cone.slope) * reach_ / cone.length, 1.0) * (most - least);
    return {std::max(least, share - change), std::min(most, share + change)};
  }

  // Width over which two cones are blended when their gradients differ by `difference`: 1 - cos = difference^2 / 2.
  static double width(double reach, double difference) {
    const double d = std::clamp(difference, 0.0, 2.0);
    return reach * d * d / 2;
  }

  // Whether holds(bounds) for every cone and holds(bounds, bounds) for every pair that may be blended. The dent of a
  // blend is at most a quarter of its width: what is farther outside by `value` than that needs no closer look.
  template <class Value, class Widest, class Holds>
  bool all_outside(Range range, const Value& value, const Widest& widest, const Holds& holds) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (value(stack_[i]) < 0) return false;
    }
    if (field_.relations().blend() == 0) return true;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (std::size_t j = range.begin; j < i; ++j) {
        ConeBounds &a = stack_[i], &b = stack_[j];
        const double width = widest(a, b);
        if (std::min(value(a), value(b)) - width / 4 >= 0) continue;
        if (field_.are_blended(a.cone->number, b.cone->number) && !holds(a, b, width)) return false;
      }
    }
    return true;
  }

  // Over which two cones are blended at most on the triangle.
  static double widest_blend(const ConeBounds& a, const ConeBounds& b) {
    return width(std::min(a.most_reach, b.most_reach), (a.gradient - b.gradient).norm() + a.turn + b.turn);
  }

  // The smooth minimum grows with either distance and falls with the width.
  double first_order_low(const ConeBounds& a, const ConeBounds& b, double widest) {
    const double gap = std::max(0.0, std::abs(a.at_center - b.at_center) - 2 * reach_);
    const double low = std::min(a.low, b.low);
    if (gap >= widest) return low;
    const double h = 1 - gap / widest;
    double bound = std::max(low - h * h * widest / 4, smooth_minimum(a.low, b.low, widest));
    if (bound < 0) bound = std::max(bound, low - dent_at_node(a, b, low));
    if (bound < 0) bound = std::max(bound, low_by_tangents(a, b, widest));
    return bound;
  }

  // By how much two cones with a common node are blended at most. At a point that is d from the node's ball and L from
  // its centre, each is no farther than d - L e, where e is 1 - cos of its gradient's turn against the direction from
  // the node: the gap is L (e - e'), and the width at most reach (sqrt e + sqrt e')^2, for the turns add up at most.
  // With the lesser e', the width less the gap is at most 4 reach e' whatever e is, or L e' / (1 - reach / L) where L
  // is less than twice the reach. A blend takes away a quarter of that at most, and nothing where the node's ball is
  // what is nearest of one of them. L is at least the radius of the ball and how far outside the point is.
  static double dent_at_node(const ConeBounds& a, const ConeBounds& b, double low) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    if (low < 0) return kAny;
    const std::optional<Fold> fold = fold_between(*a.cone, *b.cone);
    if (!fold) return kAny;
    const double reach = std::min(a.most_reach, b.most_reach), share = reach / (low + fold->radius);
    if (share >= 1) return kAny;
    return reach * fold->height * (share <= 0.5 ? 1 : 1 / (4 * share * (1 - share)));
  }

  // Distances are above their tangents, and a concave function of linear ones is least at a corner.
  static double low_by_tangents(const ConeBounds& a, const ConeBounds& b, double widest) {
    double low = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) low = std::min(low, smooth_minimum(a.tangent[k], b.tangent[k], widest));
    return low;
  }

  static double low_of(const ConeBounds& b) { return b.low; }

  bool is_outside_to_first_order(Range range) {
    return all_outside(range, low_of, widest_blend, [this](const ConeBounds& a, const ConeBounds& b, double widest) {
      return first_order_low(a, b, widest) >= 0;
    });
  }

  bool is_outside_to_second_order(Range range) {
    return all_outside(range, low_of, widest_blend, [this](ConeBounds& a, ConeBounds& b, double widest) {
      return first_order_low(a, b, widest) >= 0 || second_order_low(a, b) >= 0;
    });
  }

  bool is_inside_by_bounds(Range range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (stack_[i].high <= 0) return true;
    }
    return any_pair(range, [this](ConeBounds& a, ConeBounds& b) {
      const double difference = (a.gradient - b.gradient).norm() - a.turn - b.turn;
      const double widest = width(std::min(a.least_reach, b.least_reach), difference);
      return smooth_minimum(a.high, b.high, widest) <= 0 || second_order_high(a, b) <= 0;
    });
  }

  // Whether a pair that may be blended is such.
  template <class Test>
  bool any_pair(Range range, const Test& test) {
    if (field_.relations().blend() == 0) return false;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (std::size_t j = range.begin; j < i; ++j) {
        if (field_.are_blended(stack_[i].cone->number, stack_[j].cone->number) && test(stack_[i], stack_[j]))
          return true;
      }
    }
    return false;
  }

  // By the approximate field at the centroid: if its sign is wrong already, subtriangles need not be considered.
  bool is_outside_at_center(Range range) {
    return all_outside(range, at_center_of, blend_at_center,
                       [](const ConeBounds& a, const ConeBounds& b, double blend) {
                         return smooth_minimum(a.at_center, b.at_center, blend) >= 0;
                       });
  }
  bool is_inside_at_center(Range range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (stack_[i].at_center <= 0) return true;
    }
    return any_pair(range, [](const ConeBounds& a, const ConeBounds& b) {
      return smooth_minimum(a.at_center, b.at_center, blend_at_center(a, b)) <= 0;
    });
  }

  static double at_center_of(const ConeBounds& b) { return b.at_center; }

  static double blend_at_center(const ConeBounds& a, const ConeBounds& b) {
    const double reach = 0.5 * std::min(a.least_reach + a.most_reach, b.least_reach + b.most_reach);
    return width(reach, (a.gradient - b.gradient).norm());
  }

  const VesselField& field_;
  std::vector<TestedCone> cones_;
  std::vector<ConeBounds> stack_;
  // Of the triangle that was measured last.
  const Points* points_ = nullptr;
  Vec3 center_ = Vec3::Zero(), normal_ = Vec3::Zero();
  double reach_ = 0;
  std::vector<RoundCone::Distance> at_center_;
  std::size_t whole_end_ = 0;  // where its bounds begin on the stack
};

}  // namespace

Vec3 triangle_center(const TrianglePoints& q) { return (q[0] + q[1] + q[2]) / 3; }

double triangle_reach(const TrianglePoints& q, const Vec3& center) {
  double farthest = 0;
  for (const Vec3& p : q) farthest = std::max(farthest, (p - center).norm());
  return farthest;
}

bool are_outside(const VesselField& field, const std::vector<TrianglePoints>& triangles,
                 const std::vector<Index>& cones) {
  TriangleTest test(field, cones);
  return std::all_of(triangles.begin(), triangles.end(), [&](const TrianglePoints& q) { return test.outside(q); });
}

bool are_inside(const VesselField& field, const std::vector<TrianglePoints>& triangles,
                const std::vector<Index>& cones) {
  TriangleTest test(field, cones);
  return std::all_of(triangles.begin(), triangles.end(), [&](const TrianglePoints& q) { return test.inside(q); });
}

}  // namespace vmesh
