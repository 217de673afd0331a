#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// A flat end of a reference to which an opening of a surface was moved.
struct ReferenceCap {
  std::size_t opening = 0;     ///< in GenerateResult::openings
  Vec3 center = Vec3::Zero();  ///< centroid of its area, mm
  Vec3 normal = Vec3::Zero();  ///< out of the vessel
  double area = 0;             ///< mm^2
};

struct FlatReference {
  TriMesh mesh;  ///< the reference without its caps
  std::vector<ReferenceCap>
      caps;  ///< caps to which openings were moved: all that were found, or none if faces would cross
};

/// To be called before fitting a surface with openings: where the reference ends flat near an opening, within 2.5 radii
/// along the vessel, moves the opening into the plane of the cap, by an extension or by shifting its ring. Returns the
/// reference without these caps, which would draw the rings of the openings together. Openings without a cap nearby
/// stay where they are.
FlatReference end_at_caps(GenerateResult& result, const TriMesh& reference);

/// To be called after the fit: scales the ring of every opening that was moved to a cap, in its plane, to the area of
/// the cap, as vertices on the wall are placed so that the volume is kept. Check and defects become those of the
/// changed surface.
void match_cap_areas(GenerateResult& result, const Centerline& centerline, const std::vector<ReferenceCap>& caps);

}  // namespace vmesh
