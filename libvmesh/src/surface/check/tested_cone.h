#pragma once

#include <optional>

#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A cone and what all bounds on its field need.
struct TestedCone {
  TestedCone(const ConeRelations& relations, Index cone);

  /// One end contains the other: its sphere touches everywhere.
  bool is_ball() const { return shape.t_low == shape.t_high; }
  double share_at(double t) const { return first_share + t * (last_share - first_share); }

  Index number, first_node, last_node;
  RoundCone shape;
  Vec3 first, axis;
  double length;                   ///< of the axis
  double slope;                    ///< of the radius of the touching sphere, per distance moved
  double first_share, last_share;  ///< of the blend
};

/// Where two cones have a node in common: at every point, the gradient of one of them at least is turned by no more
/// than some angle against the direction from there, half of the bend, to which cones that widen away from the node
/// add.
struct Fold {
  double height;  ///< 1 - cos of that angle
  double radius;  ///< of the node, mm
};
/// Nothing without a common node.
std::optional<Fold> fold_between(const TestedCone& a, const TestedCone& b);

}  // namespace vmesh
