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
/// Every face spans a shell between two copies of itself whose corners are moved outwards and inwards along their
/// normals by no more than the limit (normals and heights are interpolated, at bent corners their product, on edges
/// from their ends alone, so the shells of neighbours meet). If no point of the outer copy is inside the volume and
/// none of the inner copy outside, every point of the face is within the limit of the boundary. If that holds for all
/// faces of a closed surface, the shell separates the volume's inside from its outside, so every point of the boundary
/// lies in the shell, within the limit of a face. (The wall of a cavity wholly within the surface is not covered.)
/// Normals are not essential: any directions will do on which neighbours agree. If a point of the boundary were not in
/// the shell, the surface could be moved from one copy to the other without passing over it; yet the outer copy, which
/// never enters the volume, winds around the inside next to the point, and the inner copy, which never leaves the
/// volume, does not wind around the outside next to it. Where walls are near each other, a shell as high as the limit
/// would reach into the next vessel; lower ones are tried there.
///
/// Whether a copy is inside or outside is decided for whole triangles. The signed distance to a round cone is convex:
/// over a triangle it is at most its largest value at a corner, and at least that of any of its tangent planes. Where
/// cones are blended, bounds follow from those of their distances and of the angle between their gradients, which turn
/// by at most the distance moved divided by the distance from the axis; two cones with a common node, no more than they
/// bend there. Undecided triangles are subdivided.
class ErrorProof {
 public:
  struct Corner {
    Vec3 position = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  ///< out of the surface, unit
    double limit = 0;            ///< greatest height of the shell, mm
    Index cone = kNone;          ///< a cone of the field near the corner
    bool is_bent = false;        ///< `normal` is another way out

    bool operator==(const Corner&) const = default;
  };
  using Face = std::array<Corner, 3>;
  /// The corners of a face of a surface.
  static Face face_of(const std::vector<Corner>& vertices, const Triangle& face) {
    return {vertices[face[0]], vertices[face[1]], vertices[face[2]]};
  }
  enum class Side { inner, outer };

  /// For either side of a face, the largest share of the limit found for which a shell of that height is proven; 0:
  /// none.
  struct Shares {
    double inner = 0, outer = 0;
  };

  /// Keeps a reference to `field`.
  explicit ErrorProof(const VesselField& field) : field_(field) {}

  /// Whether the copy of the face at these heights (mm, by corner) is proven to be on its side of the boundary.
  bool holds(const Face& face, const std::array<double, 3>& heights, Side side) const;

  /// The shares of a face; lower ones than `least` are not tried.
  Shares shares(const Face& face, const Shares& least = {0, 0}) const;

  /// Faces of a surface for which no shell is proven, ascending. Where faces need different heights at a common corner,
  /// the lower one is taken. `shares`: one entry per face. Independent of the number of threads.
  std::vector<Index> unproven(const std::vector<Corner>& vertices, const std::vector<Triangle>& faces,
                              const std::vector<Shares>& shares) const;

  /// The same, but where no shell along the normals is proven, corners move in the direction that takes them farthest
  /// from the boundary: out of a notch along its middle, where each wall's normal points into the other wall. The proof
  /// above only needs directions on which neighbours agree.
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
