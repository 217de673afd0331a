#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>

#include "cleaning_steps.h"
#include "point_tree.h"

namespace vmesh::cleaning {
namespace {

using Kind = CleaningAction::Kind;
using Element = CleaningAction::Element;

/// Branches leaving one node with which a repeated trunk is compared, at most; keeps stars linear.
constexpr int kMaxComparedSiblings = 64;

/// Follows every polyline along earlier ones as long as their points coincide.
class TrunkMerger {
 public:
  explicit TrunkMerger(Workspace& work)
      : work_(work),
        home_(work.nodes.size(), kNone),
        first_child_(work.nodes.size(), kNone),
        tree_(all_path_nodes(work)) {}

  void run() {
    const auto& starts = work_.raw.path_starts;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const std::size_t end = p + 1 < starts.size() ? starts[p + 1] : work_.raw.segments.size();
      if (starts[p] < end) follow(p, starts[p], end);
    }
  }

 private:
  struct Child {
    Index node;
    Index next;
  };

  static std::vector<PointTree::Point> all_path_nodes(const Workspace& work) {
    std::vector<PointTree::Point> points;
    for (Index n = 0; n < work.nodes.size(); ++n) {
      points.push_back({work.nodes[n].position, work.options.tolerance * work.nodes[n].radius, n});
    }
    return points;
  }

  bool coincide(Index a, Index b) { return work_.distance(a, b) <= work_.tolerance(a, b); }

  /// The known node from which a polyline that begins at `n` can be followed; kNone if there is none.
  Index find_start(Index n) {
    if (home_[n] != kNone) return home_[n];
    const Index found = tree_.nearest(work_.nodes[n].position,
                                      [&](Index other) { return home_[other] != kNone && coincide(n, other); });
    return found == kNone ? kNone : home_[found];
  }

  Index find_child(Index node, Index n) {
    int compared = 0;
    for (Index c = first_child_[node]; c != kNone && compared < kMaxComparedSiblings;
         c = children_[c].next, ++compared) {
      const Index child = children_[c].node;
      if (home_[n] == kNone ? coincide(child, n) : home_[n] == child) return child;
    }
    return kNone;
  }

  void add_child(Index node, Index n) {
    children_.push_back({n, first_child_[node]});
    first_child_[node] = static_cast<Index>(children_.size() - 1);
  }

  void follow(std::size_t path, std::size_t begin, std::size_t end) {
    const auto& segments = work_.raw.segments;
    const Index start = segments[begin].a;
    std::size_t s = begin;
    Index at = find_start(start);
    if (at == kNone) {
      at = home_[start] = start;
    } else {
      const Index first = at;
      const bool is_new = take(start, at);
      for (; s < end; ++s) {
        const Index child = find_child(at, segments[s].b);
        if (child == kNone) break;
        take(segments[s].b, child);
        work_.segments[s] = {child, child};  // compact() drops it
        at = child;
      }
      report(path, begin, s - begin, first, is_new);
    }
    for (; s < end; ++s) {
      Index& home = home_[segments[s].b];
      if (home == kNone) home = segments[s].b;
      add_child(at, home);
      at = home;
    }
  }

  /// Merges node `n` with `earlier`, unless it already belongs to an earlier polyline.
  bool take(Index n, Index earlier) {
    if (home_[n] != kNone) return false;
    home_[n] = earlier;
    work_.merge(n, earlier);
    return true;
  }

  void report(std::size_t path, std::size_t begin, std::size_t repeated, Index first, bool start_is_new) {
    const auto segment = static_cast<Index>(begin);
    const Index start = work_.raw.segments[begin].a;
    if (repeated > 0) {
      work_.add(Kind::merged_trunk, Element::segment, segment,
                work_.raw.name_of_segment(segment) + ": the first " + std::to_string(repeated) +
                    " segments of polyline " + std::to_string(path) + " repeat an earlier one from " +
                    work_.raw.place_of_node(first) + "; merged");
    } else if (start_is_new) {
      work_.add(Kind::merged_node, Element::node, start,
                work_.raw.name_of_node(start) + ": it lies at the place of " + work_.raw.place_of_node(first) +
                    "; merged into it");
    }
  }

  Workspace& work_;
  std::vector<Index> home_;  // for nodes of polylines followed so far: the representative, usually itself
  std::vector<Index> first_child_;
  std::vector<Child> children_;
  PointTree tree_;
};

struct PositionHash {
  std::size_t operator()(const std::array<double, 3>& p) const {
    std::uint64_t h = 0;
    for (const double x : p) {
      h ^= std::bit_cast<std::uint64_t>(x) + 0x9e3779b97f4a7c15ULL + (h << 6) + (h >> 2);
      h *= 0xff51afd7ed558ccdULL;
      h ^= h >> 32;
    }
    return h;
  }
};

class NodeMerger {
 public:
  explicit NodeMerger(Workspace& work) : work_(work), degree_(work.nodes.size(), 0), joined_(work.nodes.size()) {
    for (const auto& [a, b] : work.segments) {
      ++degree_[a];
      ++degree_[b];
      joined_.join(a, b);
    }
  }

  void run() {
    merge_at_equal_positions();
    merge_ends_within_tolerance();
  }

 private:
  bool is_end(Index n) const { return degree_[n] <= 1; }

  bool may_merge(Index n, Index m) {
    if (joined_.find(n) != joined_.find(m)) return true;
    return !work_.raw.tree_only && (is_end(n) || is_end(m));
  }

  void merge(Index n, Index into) {
    work_.add(
        Kind::merged_node, Element::node, n,
        work_.raw.name_of_node(n) + ": it lies at the place of " + work_.raw.place_of_node(into) + "; merged into it");
    const Index degree = degree_[n] + degree_[into];
    work_.merge(n, into);
    degree_[work_.merged.find(n)] = degree;
    joined_.join(n, into);
  }

  void merge_at_equal_positions() {
    std::unordered_map<std::array<double, 3>, Index, PositionHash> first;
    first.reserve(work_.nodes.size());
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) != n) continue;
      const Vec3& p = work_.nodes[n].position;
      const auto [place, is_new] = first.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, n);
      if (is_new) continue;
      const Index other = place->second;
      if (may_merge(n, other)) {
        merge(n, other);
      } else {
        work_.add(Kind::kept_crossing, Element::node, n,
                  work_.raw.name_of_node(n) + ": it lies at the place of " + work_.raw.place_of_node(other) +
                      ", but joining the two would close a loop; left apart");
      }
    }
  }

  void merge_ends_within_tolerance() {
    std::vector<PointTree::Point> points;
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) != n) continue;
      points.push_back({work_.nodes[n].position, work_.options.tolerance * work_.nodes[n].radius, n});
    }
    const PointTree tree(std::move(points));
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) != n || !is_end(n)) continue;
      const Index other = tree.nearest(work_.nodes[n].position, [&](Index m) {
        const Index into = work_.merged.find(m);
        return into != n && work_.distance(n, m) <= work_.tolerance(n, m) && may_merge(n, into);
      });
      if (other != kNone) merge(std::max(n, work_.merged.find(other)), std::min(n, work_.merged.find(other)));
    }
  }

  Workspace& work_;
  std::vector<Index> degree_;
  DisjointSets joined_;
};

}  // namespace

void merge_trunks(Workspace& work) {
  if (work.raw.path_starts.size() > 1) TrunkMerger(work).run();
}

void merge_coincident_nodes(Workspace& work) { NodeMerger(work).run(); }

}  // namespace vmesh::cleaning
