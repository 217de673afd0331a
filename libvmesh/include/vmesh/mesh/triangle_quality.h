#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Measures of one triangle. The ratios are 1 for an equilateral triangle and 0 for a degenerate one.
struct TriangleMeasures {
  double area_mm2 = 0;
  double min_angle_deg = 0;  ///< 0 where corners coincide
  double max_angle_deg = 0;  ///< 180 where corners coincide
  double equiangle_skewness = 0;
  double shortest_to_longest_edge = 0;         ///< inverse of Verdict's edge ratio
  double double_inradius_to_circumradius = 0;  ///< 2 r / R; inverse of Verdict's radius ratio R / (2 r)
  double scaled_inradius_to_longest_edge = 0;  ///< 2 sqrt(3) r / longest edge; inverse of Verdict's aspect ratio
};
TriangleMeasures measure_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

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
/// The same of skewness that is known.
SkewnessSummary summarize_skewness(const std::vector<double>& skewness);

}  // namespace vmesh
