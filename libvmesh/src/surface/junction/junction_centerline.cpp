#include "surface/junction/junction_centerline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace vmesh {
namespace {

// Nodes of a junction's centerline closer together than kShortestPiece radii are left out where that changes the vessel
// by at most kAlike radii. kShortestPiece: safe 0.21 to 0.42; kAlike: safe 0.14 to 0.28.
constexpr double kShortestPiece = 0.3, kAlike = 0.2;

// Whether the vessel at `place` differs from the one without nodes between `before` and `after`.
bool sticks_out(const BranchAxis& axis, double before, double place, double after) {
  const BranchAxis::Point a = axis.at(before), p = axis.at(place), b = axis.at(after);
  const double t = (place - before) / (after - before);
  const double aside = (p.position - (1 - t) * a.position - t * b.position).norm();
  const double thicker = p.radius - (1 - t) * a.radius - t * b.radius;
  return aside + std::abs(thicker) > kAlike * std::min(p.radius, (1 - t) * a.radius + t * b.radius);
}

class JunctionCenterlineMaker {
 public:
  JunctionCenterlineMaker(const Centerline& centerline, const std::vector<BranchAxis>& axes)
      : centerline_(centerline), axes_(axes) {}

  JunctionCenterline make(const Junction& junction) {
    for (const Index n : junction.nodes) node_of(n);
    for (Index g = 0; g < junction.bare_stretches.size(); ++g) add(junction.bare_stretches[g], g);
    return std::move(result_);
  }

 private:
  Index add_node(const Vec3& position, double radius) {
    result_.nodes.push_back({position, radius});
    return static_cast<Index>(result_.nodes.size() - 1);
  }

  Index node_of(Index n) {
    const auto [it, is_new] = nodes_.emplace(n, kNone);
    if (is_new) it->second = add_node(centerline_.node(n).position, centerline_.node(n).radius);
    return it->second;
  }

  Index end_node(const BareStretch& bare, int end) {
    const BranchAxis& axis = axes_[bare.branch];
    if (bare.docks[end].tube == kNone) return node_of(end ? axis.branch().nodes.back() : axis.branch().nodes.front());
    const auto point = axis.at(end ? bare.end : bare.begin);
    return add_node(point.position, point.radius);
  }

  // Places of the nodes within the bare stretch, ascending.
  static std::vector<double> nodes_within(const BranchAxis& axis, const BareStretch& bare) {
    std::vector<double> places;
    for (double lap = 0; lap <= (axis.periodic() ? axis.length() : 0); lap += axis.length()) {
      for (std::size_t i = 0; i < axis.branch().nodes.size(); ++i) {
        const double place = lap + axis.node_place(i);
        if (place > bare.begin && place < bare.end && (places.empty() || place > places.back()))
          places.push_back(place);
      }
    }
    return places;
  }

  // A loop that is short relative to its radius still needs nodes: a centerline has no two segments between the same
  // nodes and no segment from a node to itself.
  void keep_apart(Index first, Index last, std::vector<double>& places) {
    const std::size_t inner = places.size() - 2, needed = first == last ? 2 : 1;
    const bool is_new = joined_.insert(std::minmax(first, last)).second;
    if (inner >= needed || (inner == 0 && first != last && is_new)) return;
    const double begin = places.front(), end = places.back();
    places.clear();
    for (std::size_t i = 0; i <= needed + 1; ++i)
      places.push_back(begin + (end - begin) * static_cast<double>(i) / static_cast<double>(needed + 1));
  }

  void add(const BareStretch& bare, Index number) {
    const BranchAxis& axis = axes_[bare.branch];
    const std::vector<double> nodes = nodes_within(axis, bare);
    std::vector<double> places = {bare.begin};
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double place = nodes[i], after = i + 1 < nodes.size() ? nodes[i + 1] : bare.end;
      const double alone = std::min(place - places.back(), bare.end - place);
      if (alone > kShortestPiece * axis.at(place).radius || sticks_out(axis, places.back(), place, after))
        places.push_back(place);
    }
    places.push_back(bare.end);
    Index last = end_node(bare, 0);
    const Index end = end_node(bare, 1);
    keep_apart(last, end, places);
    for (std::size_t i = 1; i < places.size(); ++i) {
      const auto point = axis.at(places[i]);
      const Index next = i + 1 == places.size() ? end : add_node(point.position, point.radius);
      result_.segments.push_back({last, next});
      result_.origins.push_back({number, places[i - 1], places[i]});
      last = next;
    }
  }

  const Centerline& centerline_;
  const std::vector<BranchAxis>& axes_;
  JunctionCenterline result_;
  std::map<Index, Index> nodes_;
  std::set<std::pair<Index, Index>> joined_;  // by a bare stretch
};

}  // namespace

Index JunctionCenterline::end_segment(Index bare, bool at_end) const {
  Index found = kNone;
  for (Index s = 0; s < origins.size(); ++s) {
    if (origins[s].bare == bare && (at_end || found == kNone)) found = s;
  }
  return found;
}

JunctionCenterline make_junction_centerline(const Centerline& centerline, const std::vector<BranchAxis>& axes,
                                            const Junction& junction) {
  return JunctionCenterlineMaker(centerline, axes).make(junction);
}

}  // namespace vmesh
