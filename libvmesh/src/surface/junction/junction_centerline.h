#pragma once

#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// The part of a centerline that belongs to a junction, cut at its docks. `origins` says where each segment comes from.
struct JunctionCenterline {
  struct Origin {
    Index bare;
    double begin, end;  // places
  };

  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Origin> origins;  // of the segments

  /// The segment at one end of a bare stretch.
  Index end_segment(Index bare, bool at_end) const;
};

JunctionCenterline make_junction_centerline(const Centerline& centerline, const std::vector<BranchAxis>& axes,
                                            const Junction& junction);

}  // namespace vmesh
