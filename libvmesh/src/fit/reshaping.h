#pragma once

#include <functional>
#include <vector>

#include "fit/fit_mesh.h"
#include "fit/guarded_step.h"

namespace vmesh {

/// Does `change` to a packed surface so that no faces cross: `change(surface, frozen)` must leave alone what is near a
/// frozen vertex (one flag each). Where faces cross afterwards, all is undone and done again without that place; in
/// the end not at all.
void change_safely(FitMesh& surface, const std::function<void(FitMesh&, const std::vector<char>&)>& change);

/// Flips edges for even valences and for better triangles. Leaves alone the edges with a frozen end.
void flip_edges(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard);

/// Flips edges where the other diagonal's middle is closer to the reference: `distance(edge's ends, middle)` tells how
/// far a point is, mm, negative when that is not known. With `harsh` also where triangles become skew and turn far, if
/// it brings much: they are to be repaired.
void flip_edges_closer(FitMesh& surface, const std::vector<char>& frozen, bool harsh,
                       const std::function<double(Index, Index, const Vec3&)>& distance);

/// For every vertex, the step in the tangent plane that is best for its triangles (a Newton step of their inverse mean
/// ratios), at most 0.3 of the shortest edge.
std::vector<Vec3> shape_steps(const FitMesh& surface, int power);

/// Moves vertices one after the other by their shape steps, as far as none of their triangles becomes worse than the
/// worst. Only vertices with a triangle of more than `above` skewness take part. Returns whether one moved.
bool relax(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard, int power, double above = 0);

}  // namespace vmesh
