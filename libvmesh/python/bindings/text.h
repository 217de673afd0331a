#pragma once

#include <string>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::python {

/// "vmesh 0.1.0, Python": what files say they were made by.
std::string generator_name();

/// "1 node", "2 nodes"; `many`: the plural where it is not with an s.
std::string counted(std::size_t count, const std::string& word, const std::string& many = {});

/// Both throw InvalidInput with what there is.
LengthUnit unit_of(const std::string& text);
Space space_of(const std::string& text);

}  // namespace vmesh::python
