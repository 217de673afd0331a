#include "surface/check/tested_cone.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

// Bound on how much the radius of the touching sphere changes per distance moved: the tangent of the cone's half angle.
double radius_slope(double first, double last, double length) {
  const double sine = std::abs(last - first) / length;
  return sine / std::sqrt(1 - sine * sine);
}

}  // namespace

TestedCone::TestedCone(const ConeRelations& relations, Index cone)
    : number(cone),
      first_node(relations.first_node(cone)),
      last_node(relations.last_node(cone)),
      shape(relations.centerline().node(first_node), relations.centerline().node(last_node)),
      first(relations.axis_point(cone, 0)),
      axis(relations.axis_point(cone, 1) - first),
      length(axis.norm()),
      slope(is_ball() ? 0 : radius_slope(shape.r0, shape.r1, length)),
      first_share(relations.rounding_of(first_node)),
      last_share(relations.rounding_of(last_node)) {}

std::optional<Fold> fold_between(const TestedCone& a, const TestedCone& b) {
  for (const bool at_first_of_a : {true, false}) {
    for (const bool at_first_of_b : {true, false}) {
      if ((at_first_of_a ? a.first_node : a.last_node) != (at_first_of_b ? b.first_node : b.last_node)) continue;
      const double way_a = at_first_of_a ? 1 : -1, way_b = at_first_of_b ? 1 : -1;  // away from the node
      const double widening_a = way_a * (a.shape.r1 - a.shape.r0), widening_b = way_b * (b.shape.r1 - b.shape.r0);
      if (a.is_ball() || b.is_ball()) continue;
      const double cosine = -(way_a * a.axis).dot(way_b * b.axis) / (a.length * b.length);
      const double bend = std::acos(std::clamp(cosine, -1.0, 1.0)) + std::asin(widening_a / a.length) +
                          std::asin(widening_b / b.length);
      return Fold{bend > 0 ? 1 - std::cos(bend / 2) : 0, at_first_of_a ? a.shape.r0 : a.shape.r1};
    }
  }
  return std::nullopt;
}

}  // namespace vmesh
