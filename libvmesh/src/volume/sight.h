#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"

#include "volume/local_pairs.h"

namespace vmesh {

/// Which segments take part in each other's local queries, and how much of the blend is left to them, so that the
/// boundary has no step where sight ends.
struct Sight {
  PairSet local;  ///< count as one volume
  /// One volume no longer, but the blend still reaches over what is between their walls.
  PairSet parting;
  /// Have parted and come near again, or are near though they never touched along the graph. They must not be joined,
  /// or the volume would have a tunnel that the graph lacks: they do not see each other, and are not blended where
  /// others see both.
  PairSet apart;
  /// Of every node, the share of the blend that is left to it; empty where it is 1 for all. It is less where vessels
  /// that part turn into vessels apart: so little that the blend does not reach over the gap. From there it grows along
  /// the graph.
  std::vector<double> rounding;
};

Sight sight_between_segments(const Centerline& centerline, double blend);

/// The same, with the shares of nodes right at gaps alone: from there they have not grown yet.
Sight sight_before_return(const Centerline& centerline, double blend);
/// Shares of nodes, growing along the graph from where they are less than 1; empty where they are 1 everywhere.
std::vector<double> returning(const Centerline& centerline, std::vector<double> share);

}  // namespace vmesh
