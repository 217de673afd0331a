#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"

#include "volume/local_pairs.h"

namespace vmesh {

/// Which segments are local to each other, and how much of the blend is left to them, so that the boundary has no step
/// where locality ends.
struct SegmentLocality {
  Fans fans;      ///< whose segments are local to each other
  PairSet local;  ///< other pairs that count as one volume
  /// Pairs that are no longer one volume, but whose blend still spans the space between their walls.
  PairSet parting;
  /// Pairs that have parted and come near again, or are near without touching along the graph. They must not be joined,
  /// or the volume would have a tunnel that the graph lacks: they are not local to each other, and are not blended in
  /// queries of cones to which both are local.
  PairSet apart;
  /// The share of the blend left to every node; empty if it is 1 for all. At the border between parting and apart it is
  /// so small that the blend does not reach across the gap; from there it grows along the graph.
  std::vector<double> rounding;

  bool are_one_volume(Index i, Index j) const { return fans.are_in_one(i, j) || local.contains(i, j); }
};

SegmentLocality segment_locality(const Centerline& centerline, double blend);

/// The same with the shares right at gaps only, before they grow back along the graph.
SegmentLocality segment_locality_at_gaps(const Centerline& centerline, double blend);
/// Shares of nodes, grown along the graph from where they are less than 1; empty if they are 1 everywhere.
std::vector<double> grow_shares(const Centerline& centerline, std::vector<double> share);

}  // namespace vmesh
