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
  std::size_t handles = 0;               ///< loops of the centerline that the junction closes itself
};

/// Grows the surface of a junction from its widest place, in a lattice as fine as its thinnest vessel
/// (grow_in_lattice), brings it onto the boundary and to the size field, and cuts its openings.
JunctionSurface grow_junction(const VesselField& field, const std::vector<BranchAxis>& axes,
                              const GrowthSkeleton& skeleton, const Junction& junction, const GenerateOptions& options);

}  // namespace vmesh
