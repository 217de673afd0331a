#pragma once

#include <algorithm>
#include <string_view>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Null if there is none of that name.
inline const MeshAttribute* find_attribute(const std::vector<MeshAttribute>& attributes, std::string_view name) {
  const auto found = std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.name == name; });
  return found == attributes.end() ? nullptr : &*found;
}

}  // namespace vmesh
