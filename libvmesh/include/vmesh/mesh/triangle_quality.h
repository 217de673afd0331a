#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Equiangle skewness of a triangle: max((a_max - 60) / 120, (60 - a_min) / 60), angles in degrees.
/// 0 equilateral, 1 degenerate (coincident corners included). Table 2 of the paper.
double equiangle_skewness(const Vec3& a, const Vec3& b, const Vec3& c);

/// Equiangle skewness of every face.
std::vector<double> equiangle_skewness(const TriMesh& mesh);

/// Mean and maximum over the faces; zeros for an empty mesh.
struct SkewnessSummary {
  double mean = 0;
  double max = 0;
};
SkewnessSummary summarize_skewness(const TriMesh& mesh);

}  // namespace vmesh
