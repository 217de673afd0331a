#pragma once

#include <vector>

#include "surface/proof/finished_surface.h"

namespace vmesh {

/// An excerpt of a finished surface, which is changed by itself.
struct SurfaceExcerpt {
  FinishedSurface surface;    ///< what is not to change is held
  std::vector<Index> vertex;  ///< of every vertex: its number in the whole
  std::vector<Index> face;    ///< likewise; ascending
};

/// The faces of a surface whose boxes are within `reach` (mm) of a point, so that no other is there, however long.
/// Vertices farther than `changed` (mm) are held, as are those at its border and at openings.
SurfaceExcerpt cut_out(const FinishedSurface& whole, const Vec3& center, double changed, double reach);

/// Replaces an excerpt of a surface by what has become of it, in which held vertices are the same, in the same order.
void put_in(FinishedSurface& whole, const SurfaceExcerpt& excerpt, const FinishedSurface& changed);

}  // namespace vmesh
