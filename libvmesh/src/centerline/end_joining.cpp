#include <algorithm>
#include <limits>
#include <sstream>
#include <tuple>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/error.h"

#include "cleaning_steps.h"

namespace vmesh::cleaning {
namespace {

/// Joins ends of branches that are nearer to each other than a tolerance, the nearest first, also where that closes a
/// loop.
class EndJoiner {
 public:
  explicit EndJoiner(Workspace& work) : work_(work), clusters_(work.nodes.size()), connected_(work.nodes.size()) {
    const Adjacency adjacency(work.nodes.size(), work.segments);
    for (const auto& [a, b] : work.segments) connected_.join(a, b);
    for (Index n = 0; n < work.nodes.size(); ++n) {
      if (adjacency.degree(n) == 1) ends_.push_back(end_of_branch(n, adjacency));
    }
  }

  void run() {
    constexpr Index kLeafSize = 8;
    const BoxTree tree(
        static_cast<Index>(ends_.size()),
        [this](Index i) {
          const Vec3& p = work_.nodes[ends_[i].node].position;
          const double reach = reach_of(ends_[i].node);
          return BoxTree::Box{p.array() - reach, p.array() + reach};
        },
        kLeafSize);
    while (round(tree)) {
    }
  }

 private:
  struct End {
    Index node, opposite;  ///< of its branch
    double length;         ///< of its branch
  };
  struct Candidate {
    double distance;
    Index a, b;
    bool operator<(const Candidate& other) const {
      return std::tie(distance, a, b) < std::tie(other.distance, other.a, other.b);
    }
  };

  End end_of_branch(Index n, const Adjacency& adjacency) const {
    End end{n, n, 0};
    Index segment = kNone;
    do {
      const Index first = adjacency.segments[adjacency.offsets[end.opposite]];
      segment = first == segment ? adjacency.segments[adjacency.offsets[end.opposite] + 1] : first;
      const auto& [a, b] = work_.segments[segment];
      const Index next = a == end.opposite ? b : a;
      end.length += work_.distance(end.opposite, next);
      end.opposite = next;
    } while (adjacency.degree(end.opposite) == 2);
    return end;
  }

  double reach_of(Index n) const {
    const EndTolerance& tolerance = work_.raw.join_ends;
    return std::max(tolerance.mm, tolerance.radii * work_.nodes[n].radius);
  }

  /// Joins every end with the nearest of those that it is not joined with.
  bool round(const BoxTree& tree) {
    std::vector<Candidate> candidates;
    for (const End& end : ends_) {
      if (const Candidate nearest = nearest_to(end, tree); nearest.a != kNone) candidates.push_back(nearest);
    }
    std::sort(candidates.begin(), candidates.end());
    bool any = false;
    for (const Candidate& candidate : candidates) any |= join(candidate);
    return any;
  }

  Candidate nearest_to(const End& end, const BoxTree& tree) {
    constexpr std::size_t kMost = 1000;  // more would take long
    const Index n = end.node;
    Candidate best{std::numeric_limits<double>::infinity(), kNone, kNone};
    std::size_t visited = 0;
    double limit = 0;
    tree.visit(work_.nodes[n].position, limit, [&](Index i) {
      if (++visited > kMost)
        throw InvalidInput(work_.raw.name_of_node(n) + ": more than " + std::to_string(kMost) +
                           " ends of branches lie within the tolerance of it; give a smaller --tolerance");
      const Index other = ends_[i].node;
      const double distance = work_.distance(n, other);
      if (clusters_.find(other) == clusters_.find(n) || distance > std::min(reach_of(n), reach_of(other))) return;
      if (end.opposite == other && is_short(end, distance)) return;
      best = std::min(best, Candidate{distance, std::min(n, other), std::max(n, other)});
    });
    return best;
  }

  /// Whether a branch is hardly longer than its ends are apart: not a loop that is open.
  static bool is_short(const End& end, double distance) {
    constexpr double kShort = 3;
    return end.length <= kShort * distance;
  }

  bool join(const Candidate& candidate) {
    const auto [distance, a, b] = candidate;
    if (!clusters_.join(a, b)) return false;
    if (!connected_.join(a, b) && work_.raw.tree_only) return true;
    work_.segments.push_back({a, b});
    work_.raw_segment.push_back(kNone);
    std::ostringstream text;
    text << work_.raw.name_of_node(a) << ": this end of a branch lies " << distance << " mm from that in "
         << work_.raw.place_of_node(b) << "; joined, as the tolerance says";
    work_.add(CleaningAction::Kind::joined_ends, CleaningAction::Element::node, a, text.str());
    return true;
  }

  Workspace& work_;
  DisjointSets clusters_;   ///< of ends that are joined with each other
  DisjointSets connected_;  ///< by segments
  std::vector<End> ends_;
};

}  // namespace

void join_ends(Workspace& work) {
  if (work.raw.join_ends.mm > 0 || work.raw.join_ends.radii > 0) EndJoiner(work).run();
}

}  // namespace vmesh::cleaning
