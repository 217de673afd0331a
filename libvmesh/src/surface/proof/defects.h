#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// What keeps the surface from being sound, those of most faces first within a kind. `centerline` is the one that was
/// grown; the topology expected is that of result.growth if that is known, else the centerline's. `crossings`: the
/// pairs of faces that intersect (self_intersections).
std::vector<Defect> find_defects(const Centerline& centerline, const GenerateResult& result,
                                 const std::vector<std::pair<Index, Index>>& crossings);

}  // namespace vmesh
