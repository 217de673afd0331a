#include "vmesh/centerline/edits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <string>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

// Steps of a profile of the radius: straight between them, it is nowhere farther off than
// share (pi / kProfileSteps)^2 / 4, which is .4 % of the radius for a share of 1.
constexpr double kProfileSteps = 24;
constexpr double kFar = std::numeric_limits<double>::infinity();

void check_change(const RadiusChange& change, const Centerline& centerline) {
  const std::string of = "the change of the radius at node " + std::to_string(change.node);
  if (change.node >= centerline.nodes().size())
    throw InvalidInput(of + ": the centerline has " + std::to_string(centerline.nodes().size()) +
                       " nodes, numbered from 0");
  if (!(change.length > 0 && std::isfinite(change.length))) throw InvalidInput(of + ": its length must be positive");
  if (!(change.share > -1 && std::isfinite(change.share)))
    throw InvalidInput(of + ": nothing would be left of the vessel; give a smaller share");
}

// Of all nodes from one, along the segments; infinite beyond `reach`.
std::vector<double> distances_from(Index node, double reach, const Centerline& centerline) {
  using Entry = std::pair<double, Index>;
  std::vector<double> distance(centerline.nodes().size(), kFar);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  distance[node] = 0;
  queue.emplace(0, node);
  while (!queue.empty()) {
    const auto [d, n] = queue.top();
    queue.pop();
    if (d > distance[n]) continue;
    for (const Index s : centerline.incident_segments(n)) {
      const Index next = centerline.other_node(s, n);
      const double there = d + centerline.length(s);
      if (there >= distance[next] || there > reach) continue;
      distance[next] = there;
      queue.emplace(there, next);
    }
  }
  return distance;
}

// Of the segments that stay; isolated nodes that were none go too.
class Removal {
 public:
  Removal(const Centerline& centerline, const std::vector<Index>& branches)
      : centerline_(centerline), removed_(centerline.segments().size(), 0) {
    if (branches.empty()) return;
    const BranchTable table(centerline);
    for (const Index branch : branches) {
      if (branch >= table.size())
        throw InvalidInput("branch " + std::to_string(branch) + " cannot be removed: the centerline has " +
                           std::to_string(table.size()) + ", numbered from 0");
      for (const Index s : table.segments(branch)) removed_[s] = 1;
    }
    remove_loose();
  }

  bool keeps_segment(Index s) const { return !removed_[s]; }
  bool keeps_node(Index n) const {
    const auto around = centerline_.incident_segments(n);
    return around.empty() || std::any_of(around.begin(), around.end(), [&](Index s) { return !removed_[s]; });
  }

 private:
  // What is no longer joined to the thickest end of its component.
  void remove_loose() {
    DisjointSets sets(static_cast<Index>(centerline_.nodes().size()));
    for (Index s = 0; s < removed_.size(); ++s) {
      if (!removed_[s]) sets.join(centerline_.segment(s).a, centerline_.segment(s).b);
    }
    const std::vector<Index> root = thickest_ends();
    for (Index s = 0; s < removed_.size(); ++s) {
      const Index a = centerline_.segment(s).a;
      if (sets.find(a) != sets.find(root[centerline_.component_of_node()[a]])) removed_[s] = 1;
    }
  }

  // Of every component; its thickest node if it has no end.
  std::vector<Index> thickest_ends() const {
    std::vector<Index> thickest(centerline_.component_count(), kNone);
    const auto is_less = [&](Index n, Index m) {
      const bool end_n = centerline_.degree(n) == 1, end_m = centerline_.degree(m) == 1;
      return end_n != end_m ? end_m : centerline_.node(n).radius < centerline_.node(m).radius;
    };
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      Index& best = thickest[centerline_.component_of_node()[n]];
      if (best == kNone || is_less(best, n)) best = n;
    }
    return thickest;
  }

  const Centerline& centerline_;
  std::vector<char> removed_;
};

EndSection scaled(EndSection section, double width, double scale) {
  for (Vec3& p : section.ring) p = scale * (section.center + width * (p - section.center));
  section.center *= scale;
  section.area *= width * width * scale * scale;
  return section;
}

}  // namespace

ChangedRadius::ChangedRadius(const Centerline& centerline, std::vector<RadiusChange> changes)
    : centerline_(&centerline), changes_(std::move(changes)) {
  for (const RadiusChange& change : changes_) {
    check_change(change, centerline);
    distance_.push_back(distances_from(change.node, change.length / 2, centerline));
  }
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) == 0) isolated_.push_back(n);
  }
}

double ChangedRadius::distance(std::size_t change, Index segment, double t) const {
  const auto [a, b] = centerline_->segment(segment);
  const double length = centerline_->length(segment);
  return std::min(distance_[change][a] + t * length, distance_[change][b] + (1 - t) * length);
}

double ChangedRadius::factor(Index segment, double t) const {
  const std::size_t count = centerline_->segments().size();
  if (segment >= count) return factor_at_node(isolated_.at(segment - count));
  double factor = 1;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const double d = distance(i, segment, t);
    if (d < changes_[i].length / 2)
      factor *= 1 + changes_[i].share * (1 + std::cos(2 * std::numbers::pi * d / changes_[i].length)) / 2;
  }
  return factor;
}

double ChangedRadius::factor_at_node(Index node) const {
  const auto around = centerline_->incident_segments(node);
  if (!around.empty()) return factor(around[0], centerline_->segment(around[0]).a == node ? 0 : 1);
  double factor = 1;
  for (const RadiusChange& change : changes_) {
    if (change.node == node) factor *= 1 + change.share;
  }
  return factor;
}

std::vector<double> ChangedRadius::steps(Index segment) const {
  double step = kFar;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const auto [a, b] = centerline_->segment(segment);
    if (std::min(distance_[i][a], distance_[i][b]) < kFar) step = std::min(step, changes_[i].length / kProfileSteps);
  }
  const double count = std::ceil(centerline_->length(segment) / step);  // 0 if nothing changes
  const auto changes = [&](double i) { return factor(segment, std::clamp(i / count, 0.0, 1.0)) != 1; };
  std::vector<double> steps;
  for (double i = 1; i < count; ++i) {
    if (changes(i - 1) || changes(i) || changes(i + 1)) steps.push_back(i / count);
  }
  return steps;
}

EditedCenterline edit_centerline(const Centerline& centerline, const CenterlineEdit& edit,
                                 const std::vector<EndSection>& end_sections) {
  if (!(edit.scale > 0 && std::isfinite(edit.scale))) throw InvalidInput("the scale must be a positive number");
  const ChangedRadius radius(centerline, edit.radius);
  const Removal removal(centerline, edit.removed_branches);
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Index> original, number(centerline.nodes().size(), kNone);
  const auto add = [&](const Vec3& position, double r) {
    nodes.push_back({edit.scale * position, edit.scale * r});
    return static_cast<Index>(nodes.size() - 1);
  };
  for (Index n = 0; n < number.size(); ++n) {
    if (!removal.keeps_node(n)) continue;
    number[n] = add(centerline.node(n).position, radius.factor_at_node(n) * centerline.node(n).radius);
    original.push_back(n);
  }
  if (nodes.empty()) throw InvalidInput("nothing is left of the centerline: remove fewer branches");
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    if (!removal.keeps_segment(s)) continue;
    Index last = number[centerline.segment(s).a];
    for (const double t : radius.steps(s)) {
      const Index next = add(centerline.point_at(s, t), radius.factor(s, t) * centerline.radius_at(s, t));
      segments.push_back({last, next});
      last = next;
    }
    segments.push_back({last, number[centerline.segment(s).b]});
  }
  EditedCenterline result{Centerline(std::move(nodes), std::move(segments)), {}, std::move(original)};
  for (const EndSection& section : end_sections) {
    if (number[section.node] == kNone || result.centerline.degree(number[section.node]) != 1) continue;
    result.end_sections.push_back(scaled(section, radius.factor_at_node(section.node), edit.scale));
    result.end_sections.back().node = number[section.node];
  }
  return result;
}

}  // namespace vmesh
