#pragma once

#include <string>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/production/notes.h"

namespace vmesh::python {

/// "vmesh 0.1.0, Python": the generator recorded in files.
std::string generator_name();

}  // namespace vmesh::python
