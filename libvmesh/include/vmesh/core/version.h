#pragma once

#include <string_view>

namespace vmesh {

/// The library's version, "major.minor.patch".
std::string_view version();

}  // namespace vmesh
