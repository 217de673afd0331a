#include "surface/junction/junction_centerline.h"

#include <map>

namespace vmesh {
namespace {

constexpr double kShortestPiece = 0.3;  // radii between nodes of a junction's centerline: finer ones do not matter

class JunctionCenterlineMaker {
 public:
  JunctionCenterlineMaker(const Centerline& centerline, const std::vector<BranchAxis>& axes)
      : centerline_(centerline), axes_(axes) {}

  JunctionCenterline make(const Junction& junction) {
    for (const Index n : junction.nodes) node_of(n);
    for (Index g = 0; g < junction.gaps.size(); ++g) add(junction.gaps[g], g);
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

  Index end_node(const Gap& gap, int end) {
    const BranchAxis& axis = axes_[gap.branch];
    if (gap.openings[end].tube == kNone) return node_of(end ? axis.branch().nodes.back() : axis.branch().nodes.front());
    const auto point = axis.at(end ? gap.end : gap.begin);
    return add_node(point.position, point.radius);
  }

  void add(const Gap& gap, Index number) {
    const BranchAxis& axis = axes_[gap.branch];
    std::vector<double> places = {gap.begin};
    const auto pass = [&](double place) {
      const double shortest = kShortestPiece * axis.at(place).radius;
      if (place > gap.begin + shortest && place < gap.end - shortest && place > places.back() + shortest)
        places.push_back(place);
    };
    for (double lap = 0; lap <= (axis.periodic() ? axis.length() : 0); lap += axis.length()) {
      for (std::size_t i = 0; i < axis.branch().nodes.size(); ++i) pass(lap + axis.node_place(i));
    }
    places.push_back(gap.end);
    Index last = end_node(gap, 0);
    const Index end = end_node(gap, 1);
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
};

}  // namespace

Index JunctionCenterline::end_segment(Index gap, bool at_end) const {
  Index found = kNone;
  for (Index s = 0; s < origins.size(); ++s) {
    if (origins[s].gap == gap && (at_end || found == kNone)) found = s;
  }
  return found;
}

JunctionCenterline make_junction_centerline(const Centerline& centerline, const std::vector<BranchAxis>& axes,
                                            const Junction& junction) {
  return JunctionCenterlineMaker(centerline, axes).make(junction);
}

}  // namespace vmesh
