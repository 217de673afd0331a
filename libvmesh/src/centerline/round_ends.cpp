#include "vmesh/centerline/round_ends.h"

#include <algorithm>

namespace vmesh {

Centerline with_round_ends(const Centerline& centerline, const std::vector<EndSection>& sections) {
  constexpr double kMost = 0.9;  // of the segment
  std::vector<CenterlineNode> nodes = centerline.nodes();
  for (const EndSection& section : sections) {
    if (section.node >= nodes.size() || centerline.degree(section.node) != 1) continue;
    const Index s = centerline.incident_segments(section.node)[0];
    const Vec3 back = nodes[centerline.other_node(s, section.node)].position - nodes[section.node].position;
    const double share = std::min(kMost, nodes[section.node].radius / back.norm());
    nodes[section.node].position += share * back;
  }
  return {std::move(nodes), centerline.segments()};
}

}  // namespace vmesh
