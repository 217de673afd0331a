#pragma once

#include <vector>

#include "fit/correspondence.h"
#include "fit/fit_mesh.h"
#include "fit/fit_steps.h"

namespace vmesh::fitting {

/// A point of the surface and the radius of its surroundings, mm.
struct Place {
  Vec3 position;
  double reach;

  bool holds(const Vec3& p) const { return (p - position).squaredNorm() < reach * reach; }
};

/// A match's end on the surface, with surroundings of one edge length.
Place place_of(const FitMesh& surface, const Match& match);

/// The match of the largest distance whose end on the surface is outside some places; without a face if there is none.
Match farthest_match(const FitMesh& surface, const Matches& matches, const std::vector<Place>& left_alone);

/// Adds a vertex at a match's end on the reference by splitting a side of the match's face; does nothing on a border.
void split_at(FitMesh& surface, const Match& match, int side);

/// Where the packed surface is farthest from the reference, at ridges crossed by a triangle or an edge, moves a vertex,
/// adds one (as long as there are fewer than `most_vertices`) or refits the surroundings, if that brings them nearer.
void bring_farthest_nearer(FitMesh& surface, const std::vector<ReferenceSample>& samples, const FitSetting& setting,
                           std::size_t most_vertices);

/// The same wherever it is farther than a limit, mm.
void bring_below(FitMesh& surface, const std::vector<ReferenceSample>& samples, const FitSetting& setting,
                 std::size_t most_vertices, double limit);

}  // namespace vmesh::fitting
