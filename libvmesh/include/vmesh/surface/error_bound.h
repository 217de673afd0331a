#pragma once

#include <array>
#include <limits>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// Proves that a surface is close to the boundary of the vessel volume, and the boundary to the surface.
///
/// Every face spans a shell between its two copies that are moved by the limit along its corners' normals, outwards
/// and inwards (normals and limits are interpolated, on edges from their ends alone: the shells of neighbours meet).
/// If the outer copy has no point inside the volume and the inner one none outside, every point of the face has the
/// boundary within the limit. If that holds for all faces of a closed surface, the shell parts the volume's inside from
/// its outside, so that every point of the boundary lies in the shell, within the limit of a face. (The wall of a
/// hollow that is wholly within the surface is not seen by this.)
///
/// Whether a copy is inside or outside is decided for triangles as a whole. The signed distance to a round cone is
/// convex: over a triangle it is at most its value at the worst corner, and at least that of its tangent plane
/// anywhere. Where cones are blended, bounds follow from those of their distances and of the angle between their
/// gradients, which turn by at most the way divided by the distance from the axis. What remains open is subdivided.
class ErrorProof {
 public:
  struct Corner {
    Vec3 position;
    Vec3 normal;   ///< out of the surface, unit
    double limit;  ///< mm
    Index cone;    ///< of the field, near the corner
  };

  /// Keeps a reference to `field`.
  explicit ErrorProof(const VesselField& field) : field_(field) {}

  /// Whether the face is proven to be within its limit. false: it is not, or not by enough to tell.
  bool holds(const std::array<Corner, 3>& face) const;

 private:
  const VesselField& field_;
};

/// Faces of `mesh` for which the limit is not proven, ascending. `binding` has one entry per vertex. The local radius of
/// a relative limit is that of the vertices' binding. Independent of the number of threads.
std::vector<Index> unproven_faces(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const VesselField& field, const ErrorLimit& limit);

}  // namespace vmesh
