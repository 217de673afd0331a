#pragma once

#include <algorithm>

namespace vmesh {

/// The length from which a segment's stiffness and mass are computed: a segment much shorter than it is thick would be
/// almost rigid and massless. A thousandth of the radius is far below what is visible.
inline double regular_length(double length, double radius) { return std::max(length, 1e-3 * radius); }

}  // namespace vmesh
