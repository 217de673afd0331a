#pragma once

#include <string>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/production/notes.h"

namespace vmesh::python {

/// "vmesh 0.1.0, Python": the generator recorded in files.
std::string generator_name();

/// Both throw InvalidInput listing the known values.
LengthUnit unit_of(const std::string& text);
Space space_of(const std::string& text);

}  // namespace vmesh::python
