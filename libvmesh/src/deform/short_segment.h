#pragma once

#include <algorithm>

namespace vmesh {

/// The length that a segment's stiffness and mass are computed with: a segment much shorter than it is thick would be
/// all but rigid and weigh nothing. A thousandth of the radius is far below what shows.
inline double regular_length(double length, double radius) { return std::max(length, 1e-3 * radius); }

}  // namespace vmesh
