#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// Fills in `check` and `defects`: what keeps the surface from being sound, those of most faces first within a kind.
/// `centerline` is the one that was grown; the topology expected is that of result.growth if that is known, else the
/// centerline's. `crossings`: the pairs of faces that intersect (self_intersections).
void find_defects(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                  GenerateResult& result);

/// The same after faces were added to a surface whose nodes are known to be inside or not: all but that.
void find_defects_again(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                        GenerateResult& result);

}  // namespace vmesh
