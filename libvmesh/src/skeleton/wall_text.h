// Numbers in notes for users, internal to the module.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "vmesh/core/types.h"

namespace vmesh::skeleton {

inline std::string text(double number) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", number);
  return buffer;
}

/// "(1.2, 3, 4.5) mm".
inline std::string text(const Vec3& place) {
  std::string all = "(";
  for (int axis = 0; axis < 3; ++axis) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, "%s%.6g", axis > 0 ? ", " : "", place[axis]);
    all += buffer;
  }
  all += ") mm";
  return all;
}

/// "1 face is left out", "2 faces are left out".
inline std::string counted(std::size_t count, const char* one, const char* many) {
  std::string all = std::to_string(count);
  all += ' ';
  all += count == 1 ? one : many;
  return all;
}

}  // namespace vmesh::skeleton
