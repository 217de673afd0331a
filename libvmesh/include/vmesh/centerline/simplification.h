#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A centerline with fewer nodes, and the parts of the original that each of its segments replaces.
struct SimplifiedCenterline {
  /// An interval of an original segment, from one of its parameters to another (descending where it runs backwards).
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
  /// The largest sum of displacement and change in radius of any sphere of the original: no point of either boundary is
  /// farther from the other. In mm, and in local radii.
  double max_deviation = 0, max_deviation_relative = 0;

  bool is_simpler() const { return pieces.size() > centerline.segments().size(); }
  /// The place on the original that parameter `t` of a cone (a segment or an isolated node) corresponds to.
  Place original(Index cone, double t) const;
};

/// The place on the original that parameter `t` of a segment corresponds to; `pieces` are the segment's. piece_at()
/// tells which of them it is on.
SimplifiedCenterline::Place place_on(std::span<const SimplifiedCenterline::Piece> pieces, double t);
std::size_t piece_at(std::span<const SimplifiedCenterline::Piece> pieces, double t);

/// Leaves out nodes with two segments. Every sphere left out is mapped, in order along the vessel, to a sphere of the
/// segment that replaces it; displacement plus change in radius is at most the tolerance of its node (mm). The same
/// then holds for the spheres in between, so the boundaries of the two unions are within that distance of each other.
/// Nodes that branch or end and those with a negative tolerance stay; the graph stays the same, loops keep three nodes.
/// O(n log n) for branches of bounded curvature; deterministic.
SimplifiedCenterline simplify(const Centerline& centerline, const std::function<double(Index)>& tolerance);

}  // namespace vmesh
