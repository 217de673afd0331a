#pragma once

#include <vector>

#include "fit/correspondence.h"
#include "fit/fit_mesh.h"

namespace vmesh {

/// A point of the surface and what is around it, mm.
struct Place {
  Vec3 position;
  double reach;

  bool holds(const Vec3& p) const { return (p - position).squaredNorm() < reach * reach; }
};

/// A match's end on the surface, with an edge around it.
Place place_of(const FitMesh& surface, const Match& match);

/// The match of the largest distance whose end on the surface is in none of some places; without a face when there is
/// none.
Match farthest_match(const FitMesh& surface, const Matches& matches, const std::vector<Place>& left_alone);

/// Puts a vertex at a match's end on the reference, on a side of the match's face; on a border it does nothing.
void split_at(FitMesh& surface, const Match& match, int side);

}  // namespace vmesh
