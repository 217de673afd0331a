#include "vmesh/core/execution.h"

#include <stdexcept>

namespace vmesh {

ExecutionParams& execution_params() {
  static ExecutionParams params{VMESH_INTERMEDIATE_CHECKS};
  return params;
}

void require_invariant(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error("vmesh: " + what + "; please report this with the input and the options");
}

}  // namespace vmesh
