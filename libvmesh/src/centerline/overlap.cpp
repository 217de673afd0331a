#include <algorithm>
#include <limits>
#include <sstream>

#include "cleaning_steps.h"
#include "point_tree.h"

namespace vmesh::cleaning {
namespace {

constexpr double kLeastLength = 2;  // radii: shorter overlaps are left as they are
constexpr double kStray = 2;        // tolerances by which a polyline may deviate if it comes back
constexpr double kSearched = 2;     // polyline steps: how far ahead the foot of the next point is searched
constexpr int kMostSearchedSegments = 256;
constexpr int kMostComparedBranches = 64;  // leaving one node, at most: keeps stars linear

double nearest_parameter(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0;
}

/// Follows polylines along earlier ones as long as they stay within a share of the radius. The earlier ones form the
/// graph, which changes only where a polyline leaves it between two of its nodes.
class OverlapMerger {
 public:
  explicit OverlapMerger(Workspace& work)
      : work_(work), first_edge_(work.nodes.size(), kNone), placed_(work.nodes.size(), 0), ends_(ends_of_paths(work)) {}

  void run() {
    const auto& starts = work_.raw.path_starts;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const std::size_t end = p + 1 < starts.size() ? starts[p + 1] : work_.raw.segments.size();
      add_path(p, starts[p], end);
    }
  }

 private:
  struct IncidentEdge {
    Index segment, next;
  };
  // A point on a segment of the graph, in the direction in which the segment is followed.
  struct Foot {
    Index segment = kNone, from = kNone, to = kNone;
    double t = 0;         // 0 at `from`, 1 at `to`
    double distance = 0;  // of the polyline's point from it
  };
  // A polyline, or the rest of one, starting at the end that lies on the graph.
  struct Path {
    std::vector<Index> nodes, segments;
  };

  static std::vector<PointTree::Point> ends_of_paths(const Workspace& work) {
    std::vector<PointTree::Point> points;
    const auto add = [&](Index n) {
      points.push_back({work.nodes[n].position, work.options.overlap_tolerance * work.nodes[n].radius, n});
    };
    const auto& [starts, segments] = std::tie(work.raw.path_starts, work.raw.segments);
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const std::size_t end = p + 1 < starts.size() ? starts[p + 1] : segments.size();
      if (starts[p] == end) continue;
      add(segments[starts[p]].a);
      add(segments[end - 1].b);
    }
    return points;
  }

  Index home(Index n) { return work_.merged.find(n); }
  const Vec3& position(Index n) { return work_.nodes[home(n)].position; }
  double radius(Index n) { return work_.nodes[home(n)].radius; }

  void add_path(std::size_t number, std::size_t begin, std::size_t end) {
    Path path;
    for (std::size_t s = begin; s < end; ++s) {
      const auto& [a, b] = work_.segments[s];
      if (home(a) == home(b)) continue;  // repeats an earlier segment point by point
      if (path.nodes.empty()) path.nodes.push_back(a);
      path.nodes.push_back(b);
      path.segments.push_back(static_cast<Index>(s));
    }
    if (path.segments.empty()) return;
    if (!follow(path, number)) {
      Path reversed{{path.nodes.rbegin(), path.nodes.rend()}, {path.segments.rbegin(), path.segments.rend()}};
      follow(reversed, number);
    }
    for (const Index s : path.segments) place(s);
  }

  void place(Index s) {
    const Index a = home(work_.segments[s].a), b = home(work_.segments[s].b);
    if (a == b) return;
    for (const Index n : {a, b}) {
      edges_.push_back({s, first_edge_[n]});
      first_edge_[n] = static_cast<Index>(edges_.size() - 1);
      placed_[n] = 1;
    }
  }

  /// Merges the beginning of `path` with the graph if it runs along it far enough.
  bool follow(const Path& path, std::size_t number) {
    const Index start = find_start(path.nodes.front());
    if (start == kNone) return false;
    const std::vector<Foot> feet = feet_along(path, start);
    double length = 0, worst = 0, worst_relative = 0;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      length += (position(path.nodes[i + 1]) - position(path.nodes[i])).norm();
      worst = std::max(worst, feet[i].distance);
      worst_relative = std::max(worst_relative, feet[i].distance / radius_at(feet[i]));
    }
    if (feet.empty() || length < kLeastLength * radius_at(feet.back())) return false;
    report(path, feet.size(), number, start, worst, worst_relative);
    absorb(path.nodes.front(), start);
    for (std::size_t i = 1; i < feet.size(); ++i)
      absorb(path.nodes[i], feet[i - 1].t < 0.5 ? feet[i - 1].from : feet[i - 1].to);
    leave(path.nodes[feet.size()], feet.back(), feet.size() + 1 == path.nodes.size());
    const Index last = path.nodes[feet.size()];
    for (std::size_t i = 0; i < feet.size(); ++i)
      work_.segments[path.segments[i]] = {last, last};  // compact() drops it
    return true;
  }

  /// The feet on the graph of the points after the first, up to the last one within the tolerance.
  std::vector<Foot> feet_along(const Path& path, Index start) {
    std::vector<Foot> feet;
    std::size_t good = 0;
    for (std::size_t i = 1; i < path.nodes.size() && !placed_[home(path.nodes[i])]; ++i) {
      const Foot at = feet.empty() ? Foot{kNone, start, start, 1, 0} : feet.back();
      feet.push_back(next_foot(at, path.nodes[i - 1], path.nodes[i]));
      if (feet.back().segment == kNone) break;
      if (fits(feet.back(), path.nodes[i], 1)) good = feet.size();
    }
    feet.resize(good);
    return feet;
  }

  /// Whether a polyline's point may be merged with its foot.
  bool fits(const Foot& foot, Index n, double tolerances) {
    const double r = radius(n), other = radius_at(foot);
    return foot.distance <= tolerances * tolerance(n, other) &&
           std::abs(r - other) <= tolerances * work_.options.overlap_tolerance * std::max(r, other);
  }

  /// The node of the graph at which a polyline from `n` can start to follow it: itself, or the end of an earlier one.
  Index find_start(Index n) {
    if (placed_[home(n)]) return home(n);
    const Index end = ends_.nearest(position(n), [&](Index other) {
      return placed_[home(other)] && (position(n) - position(other)).norm() <= tolerance(n, radius(other));
    });
    return end == kNone ? kNone : home(end);
  }

  double tolerance(Index n, double other_radius) {
    return work_.options.overlap_tolerance * std::min(radius(n), other_radius);
  }

  double radius_at(const Foot& foot) { return (1 - foot.t) * radius(foot.from) + foot.t * radius(foot.to); }
  Vec3 position_at(const Foot& foot) { return (1 - foot.t) * position(foot.from) + foot.t * position(foot.to); }

  /// Where the graph, followed onwards from `at`, is nearest to `q`, the polyline's point after `p`; without a segment
  /// if it is never near enough, or not all the way.
  Foot next_foot(const Foot& at, Index p, Index q) {
    const double reach = kSearched * (position(q) - position(p)).norm() + kStray * tolerance(q, radius(q));
    struct Ahead {
      Foot from;  // first admissible point of the segment
      double left;
    };
    std::vector<Ahead> stack;
    if (at.segment == kNone || at.t == 1) {
      push_beyond(at, reach, [&](const Foot& foot, double left) { stack.push_back({foot, left}); });
    } else {
      stack.push_back({at, reach});
    }
    Foot best;
    for (int searched = 0; !stack.empty() && searched < kMostSearchedSegments; ++searched) {
      const auto [from, left] = stack.back();
      stack.pop_back();
      const Foot foot = nearest_on(from, q);
      if (fits(foot, q, kStray) && (best.segment == kNone || foot.distance < best.distance)) best = foot;
      const double rest = left - (position(from.to) - position_at(from)).norm();
      if (rest <= 0 || !is_along(from.to, p, q)) continue;
      push_beyond(from, rest, [&](const Foot& next, double next_left) { stack.push_back({next, next_left}); });
    }
    return best;
  }

  /// The segments that continue from the end of one.
  template <class Push>
  void push_beyond(const Foot& foot, double left, const Push& push) {
    const Index n = home(foot.to);
    int compared = 0;
    for (Index e = first_edge_[n]; e != kNone && compared < kMostComparedBranches; e = edges_[e].next, ++compared) {
      const Index s = edges_[e].segment;
      if (s == foot.segment) continue;
      const Index a = home(work_.segments[s].a), b = home(work_.segments[s].b);
      push(Foot{s, n, a == n ? b : a, 0, 0}, left);
    }
  }

  Foot nearest_on(const Foot& from, Index q) {
    const Vec3& a = position(from.from);
    Foot foot = from;
    foot.t = std::max(from.t, nearest_parameter(a, position(from.to), position(q)));
    foot.distance = (position(q) - position_at(foot)).norm();
    return foot;
  }

  /// Whether a node of the graph is near enough to the polyline's segment.
  bool is_along(Index node, Index p, Index q) {
    const Vec3 &a = position(p), &b = position(q);
    const double t = nearest_parameter(a, b, position(node));
    return (position(node) - ((1 - t) * a + t * b)).norm() <=
           kStray * tolerance(node, (1 - t) * radius(p) + t * radius(q));
  }

  /// Merges `n` into a node of the graph, which keeps its position and segments whichever of the two becomes the
  /// representative.
  void absorb(Index n, Index into) {
    const Index kept = home(into);
    if (home(n) == kept) return;
    const CenterlineNode node = work_.nodes[kept];
    const Index edges = first_edge_[kept];
    work_.merge(n, kept);
    const Index both = home(kept);
    work_.nodes[both] = node;
    first_edge_[both] = edges;
    placed_[both] = 1;
  }

  /// Attaches the polyline's last point on the graph, from which its rest continues.
  void leave(Index n, const Foot& foot, bool ends_here) {
    const double length = (position(foot.to) - position(foot.from)).norm();
    const double short_of = work_.options.overlap_tolerance * radius_at(foot);
    const double nearer = std::min(foot.t, 1 - foot.t);
    if (ends_here || nearer * length <= short_of) {
      absorb(n, foot.t < 0.5 ? foot.from : foot.to);
    } else {
      divide(foot, n);
    }
  }

  /// Divides a segment of the graph at `n`.
  void divide(const Foot& foot, Index n) {
    const Index middle = home(n);
    work_.nodes[middle] = {position_at(foot), radius_at(foot)};
    const auto added = static_cast<Index>(work_.segments.size());
    const bool forward = home(work_.segments[foot.segment].a) == home(foot.from);
    const Index from = home(foot.from), to = home(foot.to);
    work_.segments.push_back(forward ? CenterlineSegment{middle, to} : CenterlineSegment{to, middle});
    work_.raw_segment.push_back(work_.raw_segment[foot.segment]);
    work_.segments[foot.segment] = forward ? CenterlineSegment{from, middle} : CenterlineSegment{middle, from};
    for (Index e = first_edge_[to]; e != kNone; e = edges_[e].next) {
      if (edges_[e].segment == foot.segment) edges_[e].segment = added;
    }
    for (const Index s : {foot.segment, added}) {
      edges_.push_back({s, first_edge_[middle]});
      first_edge_[middle] = static_cast<Index>(edges_.size() - 1);
    }
    placed_[middle] = 1;
  }

  void report(const Path& path, std::size_t count, std::size_t number, Index start, double worst, double relative) {
    const auto [first, last] = std::minmax(path.segments.front(), path.segments[count - 1]);
    std::ostringstream text;
    text << work_.raw.name_of_segment(path.segments.front()) << ": " << last - first + 1 << " segments of polyline "
         << number << " run along earlier ones from " << work_.raw.place_of_node(start) << ", at most " << worst
         << " mm beside them (" << relative << " of the radius there); merged";
    work_.add(CleaningAction::Kind::merged_overlap, CleaningAction::Element::segment, path.segments.front(),
              text.str());
  }

  Workspace& work_;
  std::vector<Index> first_edge_;  // by representative
  std::vector<IncidentEdge> edges_;
  std::vector<char> placed_;  // by representative: on the graph
  PointTree ends_;
};

}  // namespace

void merge_overlaps(Workspace& work) {
  if (work.raw.path_starts.size() > 1 && work.options.overlap_tolerance > 0) OverlapMerger(work).run();
}

}  // namespace vmesh::cleaning
