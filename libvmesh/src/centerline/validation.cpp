#include "vmesh/centerline/validation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace vmesh {
namespace {

using Kind = CenterlineProblem::Kind;
using Element = CenterlineProblem::Element;

class Validator {
 public:
  Validator(const std::vector<CenterlineNode>& nodes, const std::vector<CenterlineSegment>& segments)
      : nodes_(nodes), segments_(segments) {}

  std::vector<CenterlineProblem> run() {
    if (nodes_.empty()) {
      add(Kind::no_nodes, Element::graph, kNone, "the centerline has no nodes; give at least one point with a radius");
    }
    for (Index n = 0; n < nodes_.size(); ++n) check_node(n);
    find_duplicates();
    for (Index s = 0; s < segments_.size(); ++s) check_segment(s);
    return std::move(problems_);
  }

 private:
  void add(Kind kind, Element element, Index index, std::string message) {
    problems_.push_back({kind, element, index, std::move(message)});
  }

  void check_node(Index n) {
    const auto& [position, radius] = nodes_[n];
    if (position.allFinite() && std::isfinite(radius) && radius > 0) return;
    const std::string name = "node " + std::to_string(n) + ": ";
    if (!position.allFinite()) {
      add(Kind::non_finite_position, Element::node, n,
          name + "its position is not finite (NaN or infinity); correct or remove the point");
    }
    if (!std::isfinite(radius)) {
      add(Kind::non_finite_radius, Element::node, n,
          name + "its radius is not finite (NaN or infinity); correct it or set it to 0 and clean the centerline");
    } else if (radius <= 0) {
      std::ostringstream text;
      text << name << "its radius is " << radius << ", it must be greater than 0; clean the centerline to take it from "
           << "the neighbours";
      add(Kind::non_positive_radius, Element::node, n, text.str());
    }
  }

  bool is_plain(Index s) const {
    const auto& [a, b] = segments_[s];
    return a < nodes_.size() && b < nodes_.size() && a != b;
  }

  std::pair<Index, Index> ordered(Index s) const { return std::minmax(segments_[s].a, segments_[s].b); }

  /// first_[s] becomes the lowest segment that joins the same two nodes as s.
  void find_duplicates() {
    first_.resize(segments_.size());
    std::vector<Index> order;
    for (Index s = 0; s < segments_.size(); ++s) {
      first_[s] = s;
      if (is_plain(s)) order.push_back(s);
    }
    std::sort(order.begin(), order.end(),
              [&](Index s, Index t) { return std::pair(ordered(s), s) < std::pair(ordered(t), t); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (ordered(order[i]) == ordered(order[i - 1])) first_[order[i]] = first_[order[i - 1]];
    }
  }

  void check_segment(Index s) {
    const auto& [a, b] = segments_[s];
    if (is_plain(s) && nodes_[a].position != nodes_[b].position && first_[s] == s) return;
    const std::string name =
        "segment " + std::to_string(s) + " (nodes " + std::to_string(a) + ", " + std::to_string(b) + "): ";
    if (a >= nodes_.size() || b >= nodes_.size()) {
      add(Kind::unknown_node, Element::segment, s,
          name + "there is no node " + std::to_string(a >= nodes_.size() ? a : b) + ", the nodes are 0 to " +
              std::to_string(static_cast<std::ptrdiff_t>(nodes_.size()) - 1));
    } else if (a == b) {
      add(Kind::self_loop, Element::segment, s, name + "it joins a node to itself; remove it");
    } else {
      if (nodes_[a].position == nodes_[b].position) {
        add(Kind::zero_length_segment, Element::segment, s,
            name + "its nodes lie at the same position; merge them by cleaning the centerline");
      }
      if (first_[s] != s) {
        add(Kind::duplicate_segment, Element::segment, s,
            name + "it joins the same nodes as segment " + std::to_string(first_[s]) + "; remove one of them");
      }
    }
  }

  const std::vector<CenterlineNode>& nodes_;
  const std::vector<CenterlineSegment>& segments_;
  std::vector<Index> first_;
  std::vector<CenterlineProblem> problems_;
};

}  // namespace

std::vector<CenterlineProblem> validate(const std::vector<CenterlineNode>& nodes,
                                        const std::vector<CenterlineSegment>& segments) {
  return Validator(nodes, segments).run();
}

}  // namespace vmesh
