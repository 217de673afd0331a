#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// How far a surface lies from the boundary of the vessel volume: |signed distance| at sample points spread over its
/// faces. Samples are a lower bound of the true maximum.
struct Deviation {
  double mean_mm = 0;  ///< area-weighted
  double rms_mm = 0;   ///< area-weighted
  double max_mm = 0;
  double mean_relative = 0;  ///< the same in units of the local vessel radius
  double rms_relative = 0;
  double max_relative = 0;
  Vec3 max_at = Vec3::Zero();  ///< where max_relative was found
};

/// Measures `mesh` against `field`, locally: each face is compared with the vessels its `binding` (one per vertex) says
/// it belongs to. There are four sample points per face: its centre and one towards each corner. `threads`: 0 for as
/// many as the machine has; the result does not depend on it.
Deviation measure_deviation(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                            const VesselField& field, int threads = 0);

/// How far the rounding at branches moves the boundary: |signed distance| to the plain union of the same cones at
/// points of the boundary of `rounded` near the same sample points of `mesh`.
Deviation measure_rounding(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                           const VesselField& rounded, int threads = 0);

}  // namespace vmesh
