// Vessels that are cut through.
#pragma once

#include <array>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A place along a segment, from its node a (t = 0) to its node b (1).
struct SegmentPlace {
  Index segment = kNone;
  double t = 0;
};

/// A segment divided by a node: it ends there, and another one, after all others, goes on to where it ended.
struct InsertedNode {
  Centerline centerline;
  Index node = kNone;    ///< after all others
  Index beyond = kNone;  ///< the segment from there on
  SegmentPlace at;       ///< on the centerline before

  /// The same place after, and back. Isolated nodes count as segments after all others, by rank.
  SegmentPlace after(const SegmentPlace& place) const;
  SegmentPlace before(const SegmentPlace& place) const;
};

/// Throws InvalidInput for a segment that does not exist, and a t so near to 0 or 1 (or outside) that no segment would
/// be left.
InsertedNode insert_node(const Centerline& centerline, const SegmentPlace& place);

/// A centerline cut across a vessel. Nodes and segments keep their numbers. The segment cut ends in end[0], another
/// one, after all others, begins in end[1]: both new nodes. Where a node is cut (between_segments), it becomes end[0]
/// of the segment with the lower number, and end[1] is a new node for the other one.
struct CenterlineCut {
  Centerline centerline;
  SegmentPlace at;                ///< on the centerline before; of a node, on end_segment[0]
  bool between_segments = false;  ///< at a node
  std::array<Index, 2> end{};     ///< nodes of `centerline`
  std::array<Index, 2> end_segment{};
  Vec3 position = Vec3::Zero();    ///< mm
  Vec3 direction = Vec3::UnitZ();  ///< along the vessel from end[0]'s part to end[1]'s
  double radius = 0;               ///< mm

  /// The same place after, and back; see InsertedNode. On the segment cut, up to `at` belongs to the first part.
  SegmentPlace after(const SegmentPlace& place) const;
  SegmentPlace before(const SegmentPlace& place) const;
};

/// Cuts a segment; where less than a thousandth of the radius would be left, its node. Throws InvalidInput for a
/// segment that does not exist, a t outside [0, 1], and as cut_at_node() does.
CenterlineCut cut_centerline(const Centerline& centerline, const SegmentPlace& place);

/// Throws InvalidInput for a node that does not exist, one at which a vessel ends, one at which vessels branch, and one
/// at which the vessel turns back.
CenterlineCut cut_at_node(const Centerline& centerline, Index node);

/// A clip across a vessel: within `width_mm` the profile is scaled, and it widens again over a radius on either side.
struct Clip {
  double width_mm = 0;  ///< 0: the radius
  double scale = 0.05;  ///< > 0, at most 1
};

/// What a clip needs and does: nodes where it and the slopes beside it begin and end, and the scale of the profile at
/// these and the nodes between them.
struct ClippedVessel {
  struct NodeScale {
    Index node = kNone;
    double scale = 1;
  };

  std::vector<InsertedNode> inserted;  ///< one after the other
  std::vector<NodeScale> scales;       ///< ascending in the nodes
  double width_mm = 0;
};

/// Throws InvalidInput for a place that does not exist, a width or scale out of range, and where the vessel ends or
/// branches within the clip's reach.
ClippedVessel clip_vessel(const Centerline& centerline, const SegmentPlace& place, const Clip& clip);

}  // namespace vmesh
