#pragma once

#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// Radii: single precision, accurate to a few 1e-5, is enough for tolerances from here on.
inline constexpr double kRoughTolerance = 5e-5;

/// A point and what the field says about it.
struct BoundaryPoint {
  Vec3 position;
  FieldSample sample = {};
};

}  // namespace vmesh
