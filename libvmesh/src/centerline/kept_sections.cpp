#include <algorithm>
#include <cmath>

#include "cleaning_steps.h"

namespace vmesh::cleaning {
namespace {

/// Why the section cannot stay at node `n` of the cleaned centerline; empty if it can.
std::string reason_to_drop(const EndSection& section, Index n, const Centerline& centerline) {
  if (n == kNone || centerline.degree(n) != 1) return "no vessel ends there";
  const double distance = (centerline.node(n).position - section.center).norm();
  return distance <= radius_of(section) ? "" : "its centre is farther from the node than its radius";
}

/// Unchanged to the last bit if it has length 1, but for rounding.
Vec3 unit(const Vec3& v) { return std::abs(v.squaredNorm() - 1) < 1e-14 ? v : v.stableNormalized(); }

}  // namespace

void keep_end_sections(Workspace& work, CleanedCenterline& cleaned) {
  if (work.raw.end_sections.empty()) return;
  std::vector<Index> number(work.nodes.size(), kNone);  // of representatives
  for (Index n = 0; n < cleaned.raw_node.size(); ++n) number[cleaned.raw_node[n]] = n;
  std::vector<char> taken(cleaned.raw_node.size(), 0);
  std::vector<EndSection>& kept = cleaned.end_sections;
  for (const EndSection& section : work.raw.end_sections) {
    const Index n = number[work.merged.find(section.node)];
    std::string reason = reason_to_drop(section, n, cleaned.centerline);
    if (reason.empty() && taken[n]) reason = "the vessel has another one there";
    if (reason.empty()) {
      taken[n] = 1;
      kept.push_back(section);
      kept.back().node = n;
      kept.back().normal = unit(section.normal);
    } else {
      cleaned.report.actions.push_back({CleaningAction::Kind::dropped_end_section, CleaningAction::Element::node,
                                        section.node,
                                        work.raw.name_of_node(section.node) + ": its flat end was dropped: " + reason});
    }
  }
  std::sort(kept.begin(), kept.end(), [](const EndSection& a, const EndSection& b) { return a.node < b.node; });
}

}  // namespace vmesh::cleaning
