#pragma once

#include <vector>

#include "fit/correspondence.h"

namespace vmesh {

/// Weights relative to those of the squared distances.
struct LeastSquaresWeights {
  double tangential = 0.16;  ///< of the pull to where triangles are well shaped
  double smooth = 0.03;      ///< of the difference of neighbours' steps along the normal
};

/// The steps of all vertices (mm) that minimise the squared distances of the matches. `pull`: for every vertex, the
/// tangential step that is best for its triangles. Vertices on an opening stay in its plane, whose unit normal is in
/// `opening_normals`. Vertices that are `frozen` (see is_frozen()) stay.
std::vector<Vec3> least_squares_steps(const FitMesh& surface, const Matches& matches, const std::vector<Vec3>& pull,
                                      const std::vector<Vec3>& opening_normals, const std::vector<char>& frozen,
                                      const LeastSquaresWeights& weights = {});

/// RMS distance of the matches both ways, mm; 1 if there are none.
double rms_distance(const Matches& matches);

}  // namespace vmesh
