#pragma once

#include <vector>

#include "fit/correspondence.h"
#include "fit/fit_mesh.h"
#include "fit/rounds.h"

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

/// Where the packed surface is farthest from the reference, at ridges that a triangle or an edge lies across, one
/// vertex after the other is added and its surroundings are fitted again, as long as that brings them nearer.
void put_vertices_where_farthest(FitMesh& surface, const std::vector<ReferenceSample>& samples,
                                 const FitSetting& setting, std::size_t most_vertices);

}  // namespace vmesh
