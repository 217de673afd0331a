#pragma once

#include <vector>

#include "fit/correspondence.h"

namespace vmesh::fitting {

/// The tangential step of a vertex that is best for its triangles, and the weight of the pull towards it (at most 1).
struct ShapePull {
  Vec3 step = Vec3::Zero();
  double weight = 1;
};

/// Weights relative to those of the squared distances.
struct LeastSquaresWeights {
  double tangential = 0.22;  ///< of the pull to where triangles are well shaped
  double smooth = 0.03;      ///< of the difference of neighbours' steps along the normal
  double emphasis = 0.8;     ///< of distances, by the RMS distance: large ones count more
};

/// The steps of all vertices (mm) that minimise the squared distances of the matches. `pulls`: for every vertex.
/// Vertices on an opening stay in its plane, whose unit normal is in `opening_normals`. Vertices that are `frozen` (see
/// is_frozen()) stay.
std::vector<Vec3> least_squares_steps(const FitMesh& surface, const Matches& matches,
                                      const std::vector<ShapePull>& pulls, const std::vector<Vec3>& opening_normals,
                                      const std::vector<char>& frozen, const LeastSquaresWeights& weights = {});

/// Makes the step of a vertex on an opening one in its plane.
void keep_in_opening(const FitMesh& surface, Index v, const std::vector<Vec3>& opening_normals, Vec3& step);

/// RMS distance of the matches both ways, mm; 1 if there are none.
double rms_distance(const Matches& matches);

}  // namespace vmesh::fitting
