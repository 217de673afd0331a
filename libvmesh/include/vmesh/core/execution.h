#pragma once

#include <string>

namespace vmesh {

/// How the library works, beside what it computes. Not to be changed while it works.
struct ExecutionParams {
  /// Checks between steps what must hold there (libvmesh/README.md, "Invariants of a piece"). Takes several times as
  /// long; on by default in builds with sanitizers. A violation is an error of vmesh: std::logic_error tells what and
  /// where.
  bool intermediate_checks;
};

/// Those in force.
ExecutionParams& execution_params();

/// Throws std::logic_error unless `holds`.
void require_invariant(bool holds, const std::string& what);

}  // namespace vmesh
