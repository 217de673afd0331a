#pragma once

#include <algorithm>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A stretch of a round cone's axis, with the radii at its ends.
struct AxisStretch {
  Vec3 origin, axis;
  double r0 = 0, r1 = 0;

  Vec3 point(double t) const { return origin + t * axis; }
  double radius(double t) const { return r0 + t * (r1 - r0); }
};

/// The axes and radii of a centerline's cones, which are numbered as in ConeRelations: segments, then isolated nodes.
class ConeAxes {
 public:
  /// Keeps a reference to `centerline`.
  explicit ConeAxes(const Centerline& centerline) : centerline_(&centerline) {
    for (Index n = 0; n < centerline.nodes().size(); ++n) {
      if (centerline.degree(n) == 0) isolated_.push_back(n);
    }
  }

  const Centerline& centerline() const { return *centerline_; }
  Index cone_count() const { return static_cast<Index>(centerline_->segments().size() + isolated_.size()); }
  bool is_sphere(Index cone) const { return cone >= centerline_->segments().size(); }
  /// The node of a cone that is a sphere.
  Index isolated_node(Index cone) const { return isolated_[cone - centerline_->segments().size()]; }

  Index first_node(Index cone) const { return is_sphere(cone) ? isolated_node(cone) : centerline_->segment(cone).a; }
  Index last_node(Index cone) const { return is_sphere(cone) ? isolated_node(cone) : centerline_->segment(cone).b; }

  double radius_at(Index cone, double t) const {
    const double r0 = radius_of(first_node(cone));
    return r0 + t * (radius_of(last_node(cone)) - r0);
  }
  double max_radius(Index cone) const { return std::max(radius_of(first_node(cone)), radius_of(last_node(cone))); }
  Vec3 axis_point(Index cone, double t) const {
    const Vec3& origin = centerline_->node(first_node(cone)).position;
    return origin + t * (centerline_->node(last_node(cone)).position - origin);
  }
  /// The stretch of `cone` between parameters `first` and `last`.
  AxisStretch stretch(Index cone, double first = 0, double last = 1) const {
    const Vec3 origin = axis_point(cone, first);
    return {origin, axis_point(cone, last) - origin, radius_at(cone, first), radius_at(cone, last)};
  }

 private:
  double radius_of(Index node) const { return centerline_->node(node).radius; }

  const Centerline* centerline_;
  std::vector<Index> isolated_;
};

}  // namespace vmesh
