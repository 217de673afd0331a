#pragma once

#include <vector>

#include "fit/fit_mesh.h"

namespace vmesh::fitting {

/// A patch of a surface that is changed on its own: the vertices around a place, and all faces that they could meet.
/// Nothing is removed from it.
struct FitPatch {
  FitMesh surface;
  std::vector<Index> vertices, faces;  ///< numbers in the whole; new ones come after them
  std::vector<char> frozen;            ///< of the vertices, for is_frozen()

  /// Whether any corner of a face is free.
  bool moves(Index face) const;
};

/// The patch in which everything within `reach` of a corner of `face`, along the edges of the packed surface, is free.
FitPatch patch_around(const FitMesh& whole, Index face, double reach);

/// Puts a changed patch back: new vertices and faces are appended. Returns the numbers of all faces of the patch in the
/// whole.
std::vector<Index> put_back(FitMesh& whole, const FitPatch& patch);

}  // namespace vmesh::fitting
