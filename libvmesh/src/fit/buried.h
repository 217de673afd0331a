#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fit/correspondence.h"
#include "fit/fit_steps.h"

namespace vmesh::fitting {

/// Removes walls that lie inside of the reference, as those of a crevice between two vessels that are one lumen there:
/// a region without counterparts is replaced by the smallest surface across its mouth, if that is much nearer to the
/// reference and crosses nothing. `matches`: of the packed surface. Returns how many were removed; the surface is then
/// to be packed.
std::size_t remove_buried_walls(FitMesh& surface, const Matches& matches, const FitSetting& setting);

/// Triangles of least area in all between the corners of a closed polygon (Barequet, Sharir, "Filling gaps in the
/// boundary of a polyhedron", 1995), by their numbers, oriented as it is. `may_join(i, j)`: whether two corners that
/// are not neighbours may be. Empty: there are none.
std::vector<Triangle> span_polygon(const std::vector<Vec3>& corners, const std::function<bool(Index, Index)>& may_join);

}  // namespace vmesh::fitting
