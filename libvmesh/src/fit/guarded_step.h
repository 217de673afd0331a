#pragma once

#include <vector>

#include "fit/fit_mesh.h"

namespace vmesh::fitting {

/// Limits on what a step may do to a surface.
struct StepGuard {
  double max_skewness = 0.4;  ///< of a triangle, unless it was worse before
  double turn = 0.5;          ///< least cosine of the angle by which a triangle may turn
  double fold = -0.5;         ///< least cosine between the normals of neighbours, unless it was less before
};

/// Moves the vertices of a packed surface by `steps`, as far as the guard allows: where a triangle would become too
/// skew, turn or fold too far or cross another, the steps of its corners are halved, eventually to zero. Returns the
/// share of the steps' length that was taken. No faces cross, before or after.
double take_steps(FitMesh& surface, const std::vector<Vec3>& steps, const StepGuard& guard);

/// Equiangle skewness of a face in the metric of its corners' elongation (see metric_skewness()): with its corners
/// where they are, at others, as a face of a step, with a corner at `p`.
double skewness_of(const FitMesh& surface, Index face);
double skewness_at(const FitMesh& surface, const Triangle& face, const std::array<Vec3, 3>& corners);
double skewness_after(const FitMesh& surface, const Triangle& face, const FitMesh::Step& step);
double skewness_with(const FitMesh& surface, Index face, Index vertex, const Vec3& p);

/// Whether the cosine between two neighbours' unit normals may change from `before` to `cosine`.
inline bool may_fold(double cosine, double before, double limit) { return cosine >= std::min(limit, before - 1e-9); }

}  // namespace vmesh::fitting
