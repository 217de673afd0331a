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

/// Counterparts of division^2 points on every face of the packed surface and of all samples of the reference: the
/// closest point that faces the same way and belongs to the same vessel, within 1.5 local radii.
Matches find_matches(const FitMesh& surface, const FitReference& reference, const std::vector<ReferenceSample>& samples,
                     const VesselField& field, int division);

inline constexpr int kPerEdge = 5;

/// The matches of points on all edges, ends included: Matches::from_edges.
std::vector<Match> match_edges(const FitMesh& surface, const FitReference& reference, const VesselField& field);

/// Updates the distances, along the same directions, after vertices have moved a little from `before`.
void follow(Matches& matches, const std::vector<FitVertex>& before, const FitMesh& surface);

/// The distance below which a share of the matches' area lies, mm, the larger of both ways; 0 without matches.
double matched_distance(const Matches& matches, double share);

}  // namespace vmesh::fitting
