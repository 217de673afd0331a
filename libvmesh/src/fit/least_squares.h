#pragma once

#include <vector>

#include "fit/correspondence.h"

namespace vmesh {

/// Weights against the squared distances, in their area.
struct LeastSquaresWeights {
  double tangential = 0.16;  ///< of the pull to where triangles are well shaped
  double smooth = 0.03;      ///< of the difference of neighbours' steps along the normal
};

/// The steps of all vertices (mm) that make the squared distances of the matches least. `pull`: for every vertex the
/// tangential step that is best for its triangles. Vertices on an opening stay in its plane, whose unit normal
/// `opening_normals` has. Those that are `frozen` (one flag each, fewer than vertices: the rest are not) stay.
std::vector<Vec3> least_squares_steps(const FitMesh& surface, const Matches& matches, const std::vector<Vec3>& pull,
                                      const std::vector<Vec3>& opening_normals, const std::vector<char>& frozen,
                                      const LeastSquaresWeights& weights = {});

/// Of the matches both ways, mm; 1 where there are none.
double rms_distance(const Matches& matches);

}  // namespace vmesh
