#pragma once

#include <functional>
#include <vector>

#include "fit/fit_mesh.h"
#include "fit/guarded_step.h"

namespace vmesh::fitting {

/// Applies `change` to a packed surface so that no faces cross: `change(surface, frozen)` must not touch the
/// surroundings of a frozen vertex (one flag each). Where faces cross afterwards, everything is undone and repeated
/// with that place frozen; eventually not at all.
void change_safely(FitMesh& surface, const std::function<void(FitMesh&, const std::vector<char>&)>& change);

/// `frozen` and all other vertices but the corners of some faces, removed ones among them.
std::vector<char> frozen_beside(const std::vector<Index>& faces, const FitMesh& surface,
                                const std::vector<char>& frozen);

/// Flips edges for even valences and better triangles, except edges with a frozen end.
void flip_edges(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard);

/// Flips edges where the other diagonal's midpoint is closer to the reference: `distance(edge's ends, midpoint)`, mm,
/// negative if unknown. With `harsh`, also where triangles become skew and turn far, if the gain is large; such
/// triangles need repair.
void flip_edges_closer(FitMesh& surface, const std::vector<char>& frozen, bool harsh,
                       const std::function<double(Index, Index, const Vec3&)>& distance);

/// For every vertex, the step in the tangent plane that is best for its triangles (a Newton step of their inverse mean
/// ratios), at most 0.3 of the shortest edge.
std::vector<Vec3> shape_steps(const FitMesh& surface, int power);

/// Moves vertices one at a time by their shape steps, as long as none of their triangles becomes worse than the present
/// worst. Only vertices with a triangle of skewness above `above` take part. Returns whether any moved.
bool relax(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard, int power, double above = 0);

}  // namespace vmesh::fitting
