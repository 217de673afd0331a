#pragma once

#include <array>

#include "surface/remesh/elongated_metric.h"

namespace vmesh {

/// Equiangle skewness of a triangle as if lengths along its vessel were divided by a factor: that from 1 to what its
/// corners allow in which its squared edges are shortest for its area. Never more than the plain skewness.
/// `allowed`: at the corners; where they differ, the mean direction and the largest factor count.
double least_skewness(const std::array<Vec3, 3>& corners, const std::array<Elongation, 3>& allowed);

}  // namespace vmesh
