#pragma once

#include <functional>
#include <string_view>

#include "vmesh/core/error.h"

namespace vmesh {

/// Called now and then by long operations with the name of the stage and the fraction done, in [0, 1]. Returns false to
/// cancel; the operation then throws Cancelled and leaves nothing behind.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

/// Reports to `progress` if it is set. Throws Cancelled when it asks to stop.
inline void report_progress(const Progress& progress, std::string_view stage, double fraction) {
  if (progress && !progress(stage, fraction)) throw Cancelled();
}

}  // namespace vmesh
