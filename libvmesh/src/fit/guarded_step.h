#pragma once

#include <vector>

#include "fit/fit_mesh.h"

namespace vmesh {

/// What no step may do to a surface.
struct StepGuard {
  double max_skewness = 0.4;  ///< that a triangle may come to, unless it was worse
  double turn = 0.5;          ///< cosine of the angle by which a triangle may turn, at least
  double fold = -0.5;         ///< cosine of the angle between the normals of neighbours, at least, unless it was less
};

/// Moves the vertices of a packed surface by `steps`, as far as the guard allows: where a triangle would become too
/// skew, turn or fold too far or cross another, the steps of its corners are halved, in the end to nothing. Returns
/// the share of the steps' length that was taken. The surface has no faces that cross, before and after.
double take_steps(FitMesh& surface, const std::vector<Vec3>& steps, const StepGuard& guard);

/// Equiangle skewness of a face with corner i at `p`.
double skewness_with(const FitMesh& surface, Index face, Index vertex, const Vec3& p);
double skewness_of(const FitMesh& surface, Index face);

/// Whether two unit normals of a neighbouring pair may become `cosine`, when they were `before`.
inline bool may_fold(double cosine, double before, double limit) { return cosine >= std::min(limit, before - 1e-9); }

}  // namespace vmesh
