#pragma once

#include <vector>

#include "fit/fit_mesh.h"

namespace vmesh {

/// A part of a surface that changes by itself: the vertices around a place, and all faces that they could meet. None is
/// removed from it.
struct FitPatch {
  FitMesh surface;
  std::vector<Index> vertices, faces;  ///< their numbers in the whole; newer ones come after them
  std::vector<char> frozen;            ///< of the vertices, as is_frozen() takes it

  /// Whether some corner of a face is free.
  bool moves(Index face) const;
};

/// What is within `reach` of a corner of `face`, along the edges of the packed surface, is free.
FitPatch patch_around(const FitMesh& whole, Index face, double reach);

/// Puts a changed patch in its place: new vertices and faces get the numbers after the last. Returns the numbers of all
/// faces of the patch in the whole.
std::vector<Index> put_back(FitMesh& whole, const FitPatch& patch);

}  // namespace vmesh
