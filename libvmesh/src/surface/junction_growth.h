#pragma once

#include "surface/growth_skeleton.h"

namespace vmesh {

/// A vertex with the cone it is bound to, the hint of its next query.
struct SurfacePoint {
  Vec3 position;
  Index cone;
};

/// A piece of surface.
struct SurfacePatch {
  std::vector<SurfacePoint> vertices;
  std::vector<Triangle> faces;
};

/// A junction's surface with a hole for every opening of its gaps, in their order.
struct JunctionSurface {
  SurfacePatch patch;
  std::vector<Opening> openings;
  std::vector<std::vector<Index>> rims;  ///< counter-clockwise about the direction away from the junction
};

/// Grows the surface of a junction: a geodesic sphere at its widest place, a volume that extends along all its gaps
/// step by step, vertices that follow the boundary by Eq. 11, faces crossed by a vessel's tip refined until the surface
/// enters it. The surface is always one around the volume reached so far, so nothing can be covered twice; it ends when
/// the openings are reached.
JunctionSurface grow_junction(const VesselField& field, const std::vector<BranchAxis>& axes,
                              const GrowthSkeleton& skeleton, const Junction& junction, const GenerateOptions& options);

}  // namespace vmesh
