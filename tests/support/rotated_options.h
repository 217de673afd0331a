#pragma once

#include <cstdint>

#include "vmesh/surface/generate.h"

namespace vmesh::testing {

/// The options with the largest effect on a surface, in turn; every tenth time none.
inline GenerateOptions rotated_options(std::uint32_t seed) {
  GenerateOptions options;
  switch (seed % 10) {
    case 1:
      options.around = 3;
      break;
    case 2:
      options.around = 4;
      break;
    case 3:
      options.around = 12;
      break;
    case 4:
      options.blend = 0;
      break;
    case 5:
      options.blend = 2;
      break;
    case 6:
      options.placement = Placement::inscribed;
      break;
    case 7:
      options.open_ends.all = true;
      break;
    case 8:
      options.max_center_distance = 0.05;
      break;
    case 9:
      options.max_error.relative = 0.1;
      break;
    default:
      break;
  }
  return options;
}

}  // namespace vmesh::testing
