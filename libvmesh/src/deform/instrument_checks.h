#pragma once

#include "vmesh/deform/contact.h"

namespace vmesh {

/// Both throw InvalidInput.
void check_shape(const InstrumentShape& shape);
void check_pose(const InstrumentPose& pose);

}  // namespace vmesh
