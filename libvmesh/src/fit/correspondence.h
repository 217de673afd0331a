#pragma once

#include <vector>

#include "vmesh/volume/vessel_field.h"

#include "fit/fit_mesh.h"
#include "fit/fit_reference.h"

namespace vmesh::fitting {

/// A pair of corresponding points of the surface and the reference.
struct Match {
  Index face = kNone;             ///< of the surface; kNone: the point has no counterpart
  Vec3 weights = Vec3::Zero();    ///< of the face's corners at the surface's point
  Vec3 direction = Vec3::Zero();  ///< unit, from the reference's point to the surface's, or opposite
  double distance = 0;            ///< along the direction, mm
  double area = 0;                ///< mm^2 that it represents
  Index other = kNone;            ///< face of the reference
};

struct Matches {
  std::vector<Match> from_surface;    ///< `per_face` for every face, in the order of the faces
  std::vector<Match> from_reference;  ///< one for every sample
  /// Matches of points on edges and their ends, where ridges and tips are farthest from a round shape; they represent
  /// no area. Empty, or kPerEdge for each side of every face; a side shared by two faces has its matches in one of
  /// them.
  std::vector<Match> from_edges;
  int per_face = 0;
};

inline constexpr int kPerEdge = 5;

/// What of a surface is matched.
struct MatchScope {
  int division;                  ///< of the faces, for division^2 points on each
  bool edges = false;            ///< points on edges as well, ends included
  std::vector<char> faces = {};  ///< one flag each; empty: all

  bool has(Index face) const { return faces.empty() || faces[face]; }
};

/// Counterparts of points on the faces of the packed surface and of all samples of the reference: the closest point
/// that faces the same way and belongs to the same vessel, within 1.5 local radii; from counterparts that vertices
/// remember, the locally closest one if it is near.
Matches find_matches(const FitMesh& surface, const FitReference& reference, const std::vector<ReferenceSample>& samples,
                     const VesselField& field, const MatchScope& scope);

/// Notes at the vertices where their counterparts are: the next matches are sought from there.
void remember(FitMesh& surface, const Matches& matches);

/// Updates the distances, along the same directions, after vertices have moved a little from `before`.
void follow(Matches& matches, const std::vector<FitVertex>& before, const FitMesh& surface);

/// The distance below which a share of the matches' area lies, mm, the larger of both ways; 0 without matches.
double matched_distance(const Matches& matches, double share);

}  // namespace vmesh::fitting
