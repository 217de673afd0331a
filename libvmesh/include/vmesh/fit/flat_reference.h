#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// A flat end of a reference that an opening of a surface was moved to.
struct ReferenceCap {
  std::size_t opening = 0;     ///< in GenerateResult::openings
  Vec3 center = Vec3::Zero();  ///< centroid of its area, mm
  Vec3 normal = Vec3::Zero();  ///< out of the vessel
  double area = 0;             ///< mm^2
};

struct FlatReference {
  TriMesh mesh;  ///< the reference without its caps
  std::vector<ReferenceCap> caps;  ///< that openings were moved to: all found, or none if faces would cross
};

/// Before a surface with openings is fitted: where the reference ends flat near an opening, within 2.5 radii along the
/// vessel, the opening goes there, into the plane of the cap, by a tube or by shifting its ring. The caps are left out
/// of what is returned, as they would draw the rims of the openings together. Openings without a cap near them stay
/// where they are.
FlatReference end_at_caps(GenerateResult& result, const TriMesh& reference);

/// After the fit: scales the ring of every opening that was moved to a cap in its plane to the area of the cap, as the
/// placement of the vertices on the wall keeps the volume. Check and defects become those of the changed surface.
void match_cap_areas(GenerateResult& result, const Centerline& centerline, const std::vector<ReferenceCap>& caps);

}  // namespace vmesh
