#pragma once

#include <limits>
#include <optional>

#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/boundary_point.h"

namespace vmesh {

/// The two walls that face each other at a point: the nearest cones with gradients to either side of a direction.
struct Walls {
  double first = std::numeric_limits<double>::infinity(), second = first;  ///< signed distances
  Vec3 first_normal = Vec3::Zero(), second_normal = Vec3::Zero();
  Index first_cone = kNone, second_cone = kNone;

  Vec3 up() const { return first_normal + second_normal; }
};

/// The end of a gap, and its walls there.
struct Notch {
  BoundaryPoint end;
  Walls walls;
};

/// Gaps between walls, and the notches in which they end.
class Gaps {
 public:
  explicit Gaps(const VesselField& field) : field_(field) {}

  Walls walls_at(const Vec3& p, const Vec3& across, Index hint) const;

  /// The point reached from p down the middle of the gap, at the height `filled` above its end.
  std::optional<BoundaryPoint> end_from(Vec3 p, const Vec3& across, Index hint, double filled, double tolerance) const;

  /// The notch below p, between two points of walls that face each other; nothing if they do not.
  std::optional<Notch> notch_below(const Vec3& p, const FieldSample& a, const FieldSample& b, double tolerance) const;

 private:
  const VesselField& field_;
};

}  // namespace vmesh
