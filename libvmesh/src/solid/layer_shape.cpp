#include "solid/layer_shape.h"

#include <algorithm>

#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

// What is left, in a wedge, of the determinant that it would have if it did not narrow.
constexpr double kLeastDeterminant = 0.2;
// The last layer's triangles, on which tetrahedra stand, have at most this skewness, or this more than the wall's.
constexpr double kMostSkewness = 0.7, kMostAdded = 0.1;

Vec3 area_vector(const WallFrame& frame, Index f) {
  const auto& [a, b, c] = frame.faces[f];
  return (frame.position[b] - frame.position[a]).cross(frame.position[c] - frame.position[a]);
}

// At corners at which the layers end there is nothing to keep.
bool keeps_its_determinant(const WedgeCorners& corners, const Vec3& wall) {
  const auto coefficients = jacobian_coefficients(corners);
  for (std::size_t i = 0; i < 3; ++i) {
    if (corners[i + 3] == corners[i]) continue;
    const double straight = wall.dot(corners[i + 3] - corners[i]);
    if (!(straight > 0)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(coefficients[3 * k + i] >= kLeastDeterminant * straight)) return false;
    }
  }
  return true;
}

double skewness(const WallFrame& frame, const LayerStack& stack, Index f, double share) {
  const auto& [a, b, c] = frame.faces[f];
  return equiangle_skewness(stack.at(frame, a, share), stack.at(frame, b, share), stack.at(frame, c, share));
}

}  // namespace

bool is_well_shaped(const WallFrame& frame, const LayerStack& stack, Index f) {
  const Vec3 wall = area_vector(frame, f);
  for (std::size_t layer = 0; layer < stack.count(); ++layer) {
    if (!keeps_its_determinant(wedge_corners(frame, stack, f, layer), wall)) return false;
  }
  const double last = skewness(frame, stack, f, 1);
  return last <= kMostSkewness || last <= skewness(frame, stack, f, 0) + kMostAdded;
}

}  // namespace vmesh
