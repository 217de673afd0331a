#include "vmesh/centerline/cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

namespace vmesh {
namespace {

/// A stump shorter than this share of the radius is none.
constexpr double kShortestStump = 1e-3;
/// Beyond a clip the profile widens again over this length, in radii.
constexpr double kClipSlope = 1;
/// Cosine of the turn at a node beyond which no plane is across both of its segments.
constexpr double kTurnsBack = -0.8;

void require_place(const Centerline& centerline, const SegmentPlace& place) {
  if (place.segment >= centerline.segments().size())
    throw InvalidInput("there is no segment " + std::to_string(place.segment) + "; there are " +
                       std::to_string(centerline.segments().size()) + ", numbered from 0");
  if (!(place.t >= 0 && place.t <= 1))
    throw InvalidInput("a place on a segment is from 0 to 1 along it, not at " + std::to_string(place.t));
}

SegmentPlace place_beyond(const SegmentPlace& at, Index beyond, const SegmentPlace& place) {
  // Isolated nodes are counted after all segments, of which there is one more.
  if (place.segment >= beyond) return {place.segment + 1, place.t};
  if (place.segment != at.segment) return place;
  if (place.t <= at.t) return {place.segment, place.t / at.t};
  return {beyond, (place.t - at.t) / (1 - at.t)};
}

SegmentPlace place_joined(const SegmentPlace& at, Index beyond, const SegmentPlace& place) {
  if (place.segment > beyond) return {place.segment - 1, place.t};
  if (place.segment == beyond) return {at.segment, std::min(1.0, at.t + place.t * (1 - at.t))};
  if (place.segment == at.segment) return {place.segment, place.t * at.t};
  return place;
}

Vec3 unit_between(const Centerline& centerline, Index from, Index to) {
  return (centerline.node(to).position - centerline.node(from).position).stableNormalized();
}

/// The segment ends in one new node, and a new segment begins in another or the same.
Centerline divided(const Centerline& centerline, const SegmentPlace& at, bool apart) {
  std::vector<CenterlineNode> nodes = centerline.nodes();
  std::vector<CenterlineSegment> segments = centerline.segments();
  const CenterlineNode added{centerline.point_at(at.segment, at.t), centerline.radius_at(at.segment, at.t)};
  const auto node = static_cast<Index>(nodes.size());
  nodes.push_back(added);
  if (apart) nodes.push_back(added);
  segments.push_back({static_cast<Index>(nodes.size() - 1), segments[at.segment].b});
  segments[at.segment].b = node;
  return {std::move(nodes), std::move(segments)};
}

/// Along a vessel without branches: a node, or as far as asked on a segment.
struct Walked {
  SegmentPlace at;
  std::vector<std::pair<Index, double>> passed;  ///< nodes and how far from the start they are
  Index stopped = kNone;                         ///< node at which the vessel ends or branches before that
};

Walked walk(const Centerline& centerline, SegmentPlace from, bool towards_b, double distance) {
  Walked walked;
  double gone = 0;
  for (Index s = from.segment, passed = 0;; ++passed) {
    const double length = centerline.length(s), left = (towards_b ? 1 - from.t : from.t) * length;
    if (gone + left >= distance || passed > centerline.segments().size()) {
      const double t = from.t + (towards_b ? 1 : -1) * (distance - gone) / length;
      walked.at = {s, std::clamp(t, 0.0, 1.0)};
      return walked;
    }
    gone += left;
    const Index node = towards_b ? centerline.segment(s).b : centerline.segment(s).a;
    if (centerline.degree(node) != 2) {
      walked.stopped = node;
      return walked;
    }
    walked.passed.emplace_back(node, gone);
    const auto incident = centerline.incident_segments(node);
    s = incident[0] == s ? incident[1] : incident[0];
    towards_b = centerline.segment(s).a == node;
    from = {s, towards_b ? 0.0 : 1.0};
  }
}

/// A node there, unless there is one.
void divide_at(Centerline& centerline, const SegmentPlace& place, std::vector<InsertedNode>& inserted) {
  const double near = kShortestStump * centerline.radius_at(place.segment, place.t);
  if (std::min(place.t, 1 - place.t) * centerline.length(place.segment) <= near) return;
  inserted.push_back(insert_node(centerline, place));
  centerline = inserted.back().centerline;
}

SegmentPlace after_all(SegmentPlace place, const std::vector<InsertedNode>& inserted) {
  for (const InsertedNode& node : inserted) place = node.after(place);
  return place;
}

}  // namespace

SegmentPlace InsertedNode::after(const SegmentPlace& place) const { return place_beyond(at, beyond, place); }
SegmentPlace InsertedNode::before(const SegmentPlace& place) const { return place_joined(at, beyond, place); }

SegmentPlace CenterlineCut::after(const SegmentPlace& place) const {
  return between_segments ? place : place_beyond(at, end_segment[1], place);
}
SegmentPlace CenterlineCut::before(const SegmentPlace& place) const {
  return between_segments ? place : place_joined(at, end_segment[1], place);
}

InsertedNode insert_node(const Centerline& centerline, const SegmentPlace& place) {
  require_place(centerline, place);
  const Vec3 position = centerline.point_at(place.segment, place.t);
  const auto& [a, b] = centerline.segment(place.segment);
  if (position == centerline.node(a).position || position == centerline.node(b).position)
    throw InvalidInput("segment " + std::to_string(place.segment) + " cannot be divided at " + std::to_string(place.t) +
                       ": there is a node");
  return {divided(centerline, place, false), static_cast<Index>(centerline.nodes().size()),
          static_cast<Index>(centerline.segments().size()), place};
}

CenterlineCut cut_centerline(const Centerline& centerline, const SegmentPlace& place) {
  require_place(centerline, place);
  const auto& [a, b] = centerline.segment(place.segment);
  const double length = centerline.length(place.segment), radius = centerline.radius_at(place.segment, place.t);
  if (place.t * length <= kShortestStump * radius) return cut_at_node(centerline, a);
  if ((1 - place.t) * length <= kShortestStump * radius) return cut_at_node(centerline, b);
  const auto node = static_cast<Index>(centerline.nodes().size());
  return {divided(centerline, place, true),
          place,
          false,
          {node, node + 1},
          {place.segment, static_cast<Index>(centerline.segments().size())},
          centerline.point_at(place.segment, place.t),
          unit_between(centerline, a, b),
          radius};
}

CenterlineCut cut_at_node(const Centerline& centerline, Index node) {
  const std::string name = "node " + std::to_string(node);
  if (node >= centerline.nodes().size())
    throw InvalidInput("there is no " + name + "; there are " + std::to_string(centerline.nodes().size()) +
                       ", numbered from 0");
  if (centerline.degree(node) < 2)
    throw InvalidInput("the vessel ends at " + name + " and cannot be cut there; cut it before its end");
  if (centerline.degree(node) > 2)
    throw InvalidInput("vessels branch at " + name + "; cut one of them beside it, on a segment");
  const Index first = centerline.incident_segments(node)[0], second = centerline.incident_segments(node)[1];
  const Vec3 in = unit_between(centerline, centerline.other_node(first, node), node),
             out = unit_between(centerline, node, centerline.other_node(second, node));
  if (in.dot(out) < kTurnsBack)
    throw InvalidInput("the vessel turns back at " + name + ", so that nothing is across it; cut it beside the node");
  std::vector<CenterlineNode> nodes = centerline.nodes();
  std::vector<CenterlineSegment> segments = centerline.segments();
  const auto added = static_cast<Index>(nodes.size());
  nodes.push_back(centerline.node(node));
  CenterlineSegment& other = segments[second];
  (other.a == node ? other.a : other.b) = added;
  const double t = centerline.segment(first).b == node ? 1 : 0;
  return {Centerline(std::move(nodes), std::move(segments)),
          {first, t},
          true,
          {node, added},
          {first, second},
          centerline.node(node).position,
          (in + out).normalized(),
          centerline.node(node).radius};
}

ClippedVessel clip_vessel(const Centerline& before, const SegmentPlace& place, const Clip& clip) {
  require_place(before, place);
  if (!(std::isfinite(clip.width_mm) && clip.width_mm >= 0))
    throw InvalidInput("the width of a clip must be finite and at least 0");
  if (!(clip.scale > 0 && clip.scale <= 1)) throw InvalidInput("the scale of a clip must be above 0, at most 1");
  const double radius = before.radius_at(place.segment, place.t);
  ClippedVessel clipped;
  clipped.width_mm = clip.width_mm > 0 ? clip.width_mm : radius;
  const double half = clipped.width_mm / 2, slope = kClipSlope * radius, reach = half + slope;
  Centerline centerline = before;
  for (const double distance : {half, reach}) {
    for (const bool towards_b : {false, true}) {
      const Walked walked = walk(centerline, after_all(place, clipped.inserted), towards_b, distance);
      if (walked.stopped != kNone)
        throw InvalidInput("there is no room for the clip: on either side it needs " + formatted("%.4g mm", reach) +
                           " of the vessel, which ends or branches before that, at node " +
                           std::to_string(walked.stopped) + "; move it away from there");
      divide_at(centerline, walked.at, clipped.inserted);
    }
  }
  std::map<Index, double> scale_of;
  for (const bool towards_b : {false, true}) {
    const Walked walked = walk(centerline, after_all(place, clipped.inserted), towards_b, reach);
    for (const auto& [node, distance] : walked.passed) {
      const double open = std::max(0.0, (distance - half) / slope);
      if (open < 1 - kShortestStump) scale_of.try_emplace(node, clip.scale + open * (1 - clip.scale));
    }
  }
  for (const auto& [node, scale] : scale_of) clipped.scales.push_back({node, scale});
  return clipped;
}

}  // namespace vmesh
