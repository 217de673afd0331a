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
/// Every face spans a shell between two copies of it whose corners are moved along their normals, outwards and inwards,
/// by no more than the limit (normals and heights are interpolated, on edges from their ends alone: the shells of
/// neighbours meet). If the outer copy has no point inside the volume and the inner one none outside, every point of
/// the face has the boundary within the limit. If that holds for all faces of a closed surface, the shell parts the
/// volume's inside from its outside, so that every point of the boundary lies in the shell, within the limit of a face.
/// (The wall of a hollow that is wholly within the surface is not seen by this.) None of that asks for normals: any
/// directions will do in which neighbours agree. From a point of the boundary that were not in the shell, the surface
/// could be moved from one copy to the other without passing over the point; yet the outer copy, which never enters the
/// volume, winds round the inside, and the inner copy, which never leaves it, not round the outside next to it. Where
/// walls are near each other, a shell as high as the limit would reach into the next vessel; lower ones are tried
/// there.
///
/// Whether a copy is inside or outside is decided for triangles as a whole. The signed distance to a round cone is
/// convex: over a triangle it is at most its value at the worst corner, and at least that of its tangent plane
/// anywhere. Where cones are blended, bounds follow from those of their distances and of the angle between their
/// gradients, which turn by at most the way divided by the distance from the axis. What remains open is subdivided.
class ErrorProof {
 public:
  struct Corner {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< out of the surface, unit
    double limit = 0;            ///< the most that the shell may be high, mm
    Index cone = kNone;          ///< of the field, near the corner

    bool operator==(const Corner&) const = default;
  };
  using Face = std::array<Corner, 3>;
  enum class Side { inner, outer };

  /// Shares of the limit as which the shell's height on either side of a face holds for that face, the largest that
  /// was found; 0: none.
  struct Shares {
    double inner = 0, outer = 0;
  };

  /// Keeps a reference to `field`.
  explicit ErrorProof(const VesselField& field) : field_(field) {}

  /// Whether the copy of the face at these heights (mm, by corner) is proven to be on its side of the boundary.
  bool holds(const Face& face, const std::array<double, 3>& heights, Side side) const;

  Shares shares(const Face& face) const;

  /// Faces of a surface for which no shell is proven, ascending. Of two faces that need different heights at a common
  /// corner, the lower is taken. `shares`: of each face. Independent of the number of threads.
  std::vector<Index> unproven(const std::vector<Corner>& vertices, const std::vector<Triangle>& faces,
                              const std::vector<Shares>& shares) const;

  /// The same, but where no shell along the normals holds, corners leave the surface in the direction that takes them
  /// farthest from the boundary: out of a notch along its middle, where either wall's normal points into the other
  /// wall. The proof above needs no more of the directions than that neighbours agree on them.
  std::vector<Index> unproven_if_bent(const std::vector<Corner>& vertices, const std::vector<Triangle>& faces,
                                      const std::vector<Shares>& shares) const;

 private:
  const VesselField& field_;
};

/// Which shells unproven_faces() tries.
enum class Shells { along_normals, bent };

/// Faces of `mesh` for which the limit is not proven, ascending. `binding` has one entry per vertex. The local radius
/// of a relative limit is that of the vertices' binding. Independent of the number of threads.
std::vector<Index> unproven_faces(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const VesselField& field, const ErrorLimit& limit, Shells shells = Shells::bent);

}  // namespace vmesh
