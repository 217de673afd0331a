#pragma once

#include <array>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Equiangle skewness of every face as if lengths along the vessel were divided by a factor: that from 1 to what is
/// allowed there in which its squared edges are shortest for its area. Tells triangles that are long on purpose from
/// bad ones. `elongation`: of every vertex, see GenerateResult; vertices beyond its end have none.
std::vector<double> metric_skewness(const TriMesh& mesh, const std::vector<Vec3>& elongation);

/// The same of one triangle; `elongation`: at its corners.
double metric_skewness(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& elongation);

}  // namespace vmesh
