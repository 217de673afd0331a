#pragma once

#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A point and what the field says about it.
struct BoundaryPoint {
  Vec3 position;
  FieldSample sample = {};
};

}  // namespace vmesh
