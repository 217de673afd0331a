#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// Fills in `check` and `defects`: what keeps the surface from being sound; within a kind, defects with the most faces
/// come first. `centerline` is the one that was grown; the expected topology is that of result.growth if known, else
/// the centerline's. `crossings`: the pairs of faces that intersect (self_intersections).
void find_defects(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                  GenerateResult& result);

/// The same after faces were added to a surface, except that nodes are not tested again.
void find_defects_again(const Centerline& centerline, const std::vector<std::pair<Index, Index>>& crossings,
                        GenerateResult& result);

}  // namespace vmesh
