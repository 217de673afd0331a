#pragma once

#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "fit/correspondence.h"
#include "fit/fit_mesh.h"
#include "fit/fit_reference.h"
#include "fit/guarded_step.h"
#include "fit/least_squares.h"

namespace vmesh::fitting {

/// The target of a fit and its constraints.
struct FitSetting {
  const FitReference& reference;
  const VesselField& field;
  std::vector<Vec3> opening_normals;  ///< unit, by FitVertex::opening
  StepGuard guard;
  bool even = true;  ///< triangles are to become even
};

/// Moves the vertices by one guarded step of least squares, except for frozen ones, and renews their cones.
void step_nearer(FitMesh& surface, const Matches& matches, const FitSetting& setting,
                 const std::vector<char>& frozen = {}, const LeastSquaresWeights& weights = {});

/// Distance (mm) of a point from the reference around the vessel of `cone`, within 1.5 local radii. If `normal` is not
/// zero, only faces that look the same way count. Negative: unknown.
double distance_from_reference(const Vec3& p, Index cone, const Vec3& normal, const FitSetting& setting);

void find_cones(FitMesh& surface, const VesselField& field);

/// Removes unused numbers.
void pack(FitMesh& surface, std::vector<Opening>& openings);

/// flip_edges_closer() by the distance from the reference.
void flip_closer(FitMesh& surface, const std::vector<char>& frozen, bool harsh, const FitSetting& setting);

/// Relaxes triangles that a split, a collapse or a flip left too skew.
void repair(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard);

}  // namespace vmesh::fitting
