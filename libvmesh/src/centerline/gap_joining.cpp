#include <algorithm>
#include <sstream>
#include <tuple>

#include "cleaning_steps.h"
#include "point_tree.h"

namespace vmesh::cleaning {
namespace {

/// Joins components at the ends of branches by added segments, like Kruskal's algorithm: never closes a loop.
class GapJoiner {
 public:
  explicit GapJoiner(Workspace& work)
      : work_(work), degree_(work.nodes.size(), 0), joined_(work.nodes.size()), tree_(points(work)) {
    for (const auto& [a, b] : work.segments) {
      ++degree_[a];
      ++degree_[b];
      joined_.join(a, b);
    }
    has_join_.assign(work.nodes.size(), 0);
    starts_component_.resize(work.nodes.size());
    for (Index n = 0; n < work.nodes.size(); ++n) starts_component_[n] = joined_.find(n);
    is_start_.assign(work.nodes.size(), 0);
    for (Index n = 0; n < work.nodes.size(); ++n) {
      const Index representative = work.merged.find(n);
      if (work.is_path_start[n] && degree_[representative] == 1) is_start_[representative] = 1;
    }
  }

  void run() {
    // A sibling's start, one step short of the same parent, is a worse target than the parent itself.
    while (round(true, [&](Index p) { return !is_start_[p]; })) {
    }
    while (round(true, [](Index) { return true; })) {
    }
    // A branch that is still loose may have been stored from its far end.
    while (round(false, [](Index) { return true; })) {
    }
  }

 private:
  struct Candidate {
    double relative_distance;
    Index from, to;
    bool operator<(const Candidate& other) const {
      return std::tie(relative_distance, from, to) < std::tie(other.relative_distance, other.from, other.to);
    }
  };

  static std::vector<PointTree::Point> points(Workspace& work) {
    std::vector<PointTree::Point> result;
    for (Index n = 0; n < work.nodes.size(); ++n) {
      if (work.merged.find(n) == n) result.push_back({work.nodes[n].position, work.nodes[n].radius, n});
    }
    return result;
  }

  bool may_join(Index n, bool at_start) const {
    if (degree_[n] != 1) return false;
    return at_start ? is_start_[n] != 0 : is_start_[n] == 0 && !has_join_[starts_component_[n]];
  }

  template <class Accept>
  bool round(bool at_start, const Accept& accept) {
    std::vector<Index> component(work_.nodes.size());
    for (Index n = 0; n < component.size(); ++n) component[n] = joined_.find(n);
    std::vector<Candidate> candidates;
    for (Index n = 0; n < component.size(); ++n) {
      if (work_.merged.find(n) != n || !may_join(n, at_start)) continue;
      const Index to =
          tree_.nearest(work_.nodes[n].position, [&](Index p) { return component[p] != component[n] && accept(p); });
      if (to != kNone) candidates.push_back({work_.distance(n, to) / work_.nodes[to].radius, n, to});
    }
    std::sort(candidates.begin(), candidates.end());
    bool any = false;
    for (const auto& candidate : candidates) {
      if (joined_.join(candidate.from, candidate.to)) {
        join(candidate);
        any = true;
      }
    }
    return any;
  }

  void join(const Candidate& candidate) {
    const auto [relative_distance, from, to] = candidate;
    work_.segments.push_back({to, from});
    work_.raw_segment.push_back(kNone);
    ++degree_[from];
    ++degree_[to];
    has_join_[starts_component_[from]] = has_join_[starts_component_[to]] = 1;
    std::ostringstream text;
    text << work_.raw.name_of_node(from) << ": this loose end of a branch lies " << work_.distance(from, to)
         << " mm from " << work_.raw.place_of_node(to) << " (" << relative_distance << " of the radius there); joined";
    work_.add(CleaningAction::Kind::joined_gap, CleaningAction::Element::node, from, text.str());
  }

  Workspace& work_;
  std::vector<Index> degree_;
  DisjointSets joined_;
  std::vector<Index> starts_component_;  // components before anything was joined
  std::vector<char> has_join_;           // by that component
  std::vector<char> is_start_;
  PointTree tree_;
};

}  // namespace

void join_gaps(Workspace& work) { GapJoiner(work).run(); }

}  // namespace vmesh::cleaning
