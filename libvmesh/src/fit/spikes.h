#pragma once

#include <vector>

#include "fit/fit_mesh.h"
#include "fit/fit_steps.h"

namespace vmesh::fitting {

/// Collapses pointed vertices that stand off the reference, where the triangles without them would be much nearer: in a
/// sharp crotch, flips can leave a fin whose triangles face no part of the reference, so that least squares do not move
/// them. Each is collapsed only if its surroundings can be repaired. The surface needs packing.
void collapse_spikes(FitMesh& surface, const std::vector<char>& frozen, const FitSetting& setting);

}  // namespace vmesh::fitting
