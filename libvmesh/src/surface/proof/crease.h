#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/boundary_point.h"

namespace vmesh {

/// Two cones that are not blended where their boundaries meet.
using Crease = std::pair<Index, Index>;

/// An end of an edge: the cone that it belongs to, or the two whose crease it is on.
struct CreaseEnd {
  Vec3 position = Vec3::Zero();
  std::vector<Index> cones;
};

/// Creases that an edge may cross or run along: pairs of cones of which one belongs to either end, with walls that look
/// elsewhere.
std::vector<Crease> creases_between(const VesselField& field, const CreaseEnd& a, const CreaseEnd& b);

/// The point of a crease near `p`, within a hundredth of `limit` (mm) of both cones; nothing if there is none that is
/// on the boundary.
std::optional<BoundaryPoint> onto_crease(const VesselField& field, const Crease& crease, Vec3 p, double limit);

/// A point between two of the boundary where it bends sharply although its cones are blended: where one pair of them
/// takes over from another. Within a tenth of `limit` (mm) of it; nothing if there is none.
std::optional<BoundaryPoint> onto_kink(const VesselField& field, const BoundaryPoint& a, const BoundaryPoint& b,
                                       double limit);

}  // namespace vmesh
