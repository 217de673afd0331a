#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// What is wrong with one element of a graph that is to become a Centerline.
struct CenterlineProblem {
  enum class Kind {
    no_nodes,
    non_finite_position,
    non_finite_radius,
    non_positive_radius,
    unknown_node,
    self_loop,
    zero_length_segment,
    duplicate_segment,
  };
  enum class Element { graph, node, segment };

  Kind kind;
  Element element;
  Index index;          ///< of the node or segment; kNone for the graph
  std::string message;  ///< names the element, what is wrong, and what to do
};

/// Lists every problem, nodes first, then segments, each by index. Empty: the graph is a valid Centerline.
std::vector<CenterlineProblem> validate(const std::vector<CenterlineNode>& nodes,
                                        const std::vector<CenterlineSegment>& segments);

}  // namespace vmesh
