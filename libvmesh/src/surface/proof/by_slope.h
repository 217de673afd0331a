#pragma once

#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/boundary_point.h"

namespace vmesh {

/// Where blended vessels part at a small angle, the field's distance changes slowly between them: its gradient is about
/// the sine of half the angle, and the boundary is farther away than the distance tells. That divided by the gradient,
/// mm: to first order how far it is.
double distance_by_slope(const FieldSample& sample);

/// From `p` along the gradient to `height` above the boundary, mm by slope. `tolerance`: of local radii.
BoundaryPoint onto_boundary(const VesselField& field, const Vec3& p, Index hint, double tolerance, double height);

}  // namespace vmesh
