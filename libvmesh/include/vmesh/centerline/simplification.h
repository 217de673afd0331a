#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A centerline with fewer nodes, and what of the original each of its segments stands for.
struct SimplifiedCenterline {
  /// A run of an original segment, from one of its parameters to another (down where it is passed backwards).
  struct Piece {
    Index segment = kNone;
    double begin = 0;  ///< parameter on the new segment; the piece ends where the next one begins, or at 1
    double t_first = 0, t_last = 1;
  };
  struct Place {
    Index segment = kNone;
    double t = 0;
  };

  Centerline centerline;
  std::vector<Index> node;  ///< of the original, for every node; ascending
  std::vector<Index> offsets;
  std::vector<Piece> pieces;  ///< of segment s: those from offsets[s] to before offsets[s + 1]
  /// The most that a sphere of the original moved and grew or shrank together: no point of one boundary is farther from
  /// the other. mm, and in radii there.
  double max_deviation = 0, max_deviation_relative = 0;

  bool is_simpler() const { return pieces.size() > centerline.segments().size(); }
  /// The place of the original that parameter `t` of a cone stands for: of a segment, or an isolated node.
  Place original(Index cone, double t) const;
};

/// The place of the original that parameter `t` of a segment stands for; `pieces` are the segment's. The second says
/// which of them it is on.
SimplifiedCenterline::Place place_on(std::span<const SimplifiedCenterline::Piece> pieces, double t);
std::size_t piece_at(std::span<const SimplifiedCenterline::Piece> pieces, double t);

/// Leaves out nodes with two segments. Every sphere that is left out moves and changes its radius, together, by at most
/// the tolerance of its node (mm) to become a sphere of the segment that replaces it, in their order along the vessel;
/// spheres between them then do too, and the boundaries of the two unions are within that distance of each other. Nodes
/// that branch or end stay, those with a negative tolerance too, and the graph stays the same: loops keep three nodes.
/// O(n log n) for branches of bounded curvature; deterministic.
SimplifiedCenterline simplify(const Centerline& centerline, const std::function<double(Index)>& tolerance);

}  // namespace vmesh
