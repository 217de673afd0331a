#pragma once

#include <string>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::python {

/// "vmesh 0.1.0, Python": the generator recorded in files.
std::string generator_name();

/// "1 node", "2 nodes"; `many`: an irregular plural.
std::string counted(std::size_t count, const std::string& word, const std::string& many = {});

/// Both throw InvalidInput listing the known values.
LengthUnit unit_of(const std::string& text);
Space space_of(const std::string& text);

}  // namespace vmesh::python
