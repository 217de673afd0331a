// Numbers in notes for users, internal to the module.
#pragma once

#include "vmesh/core/text.h"
#include "vmesh/core/types.h"

namespace vmesh::skeleton {

inline std::string text(double number) { return formatted("%.4g", number); }

/// "(1.2, 3, 4.5) mm".
inline std::string text(const Vec3& place) {
  return formatted("(%.6g, %.6g, %.6g) mm", place.x(), place.y(), place.z());
}

}  // namespace vmesh::skeleton
