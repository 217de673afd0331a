#include "volume/relation_excerpt.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>

#include "vmesh/core/ascending.h"

namespace vmesh {
BoxTree::Box grown_box(const ConeAxes& cones, Index cone, const ContactQuestion& question) {
  const CenterlineNode& from = cones.centerline().node(cones.first_node(cone));
  const CenterlineNode& to = cones.centerline().node(cones.last_node(cone));
  const double around = (1 + question.reach()) * std::max(from.radius, to.radius);
  return {from.position.cwiseMin(to.position).array() - around, from.position.cwiseMax(to.position).array() + around};
}

RelationExcerpts::RelationExcerpts(const ConeAxes& cones, const ContactQuestion& question,
                                   const std::vector<char>& less_rounded)
    : cones_(cones), question_(question), less_rounded_(less_rounded), widest_(question.widest_relation()) {
  tree_ = BoxTree(cones.cone_count(), [this](Index c) { return grown_box(cones_, c, question_); });
}

void RelationExcerpts::add_near(const BoxTree::Box& box, std::vector<Index>& near) const {
  tree_.visit_overlapping(box.low, box.high, [&](Index c) {
    if (grown_box(cones_, c, question_).overlaps(box.low, box.high)) near.push_back(c);
  });
}

// Whether a sphere of the cone may face the node's in the widest sense.
bool RelationExcerpts::may_face(Index node, Index cone) const {
  const Centerline& centerline = cones_.centerline();
  const CenterlineNode &from = centerline.node(cones_.first_node(cone)), &to = centerline.node(cones_.last_node(cone));
  const auto& [p, radius] = centerline.node(node);
  const Vec3 axis = to.position - from.position;
  const double length2 = axis.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - from.position).dot(axis) / length2, 0.0, 1.0) : 0;
  const double widest = std::max(from.radius, to.radius);
  return (p - from.position - t * axis).norm() <= radius + widest + widest_.gap(radius, widest);
}

bool RelationExcerpts::faces_node(Index node, Index other) const {
  const CenterlineNode &a = cones_.centerline().node(node), &b = cones_.centerline().node(other);
  return (a.position - b.position).norm() <= a.radius + b.radius + widest_.gap(a.radius, b.radius);
}

// The cones that the node may face if they form one stretch of vessel around it; else none.
std::vector<Index> RelationExcerpts::faced_at(Index node) const {
  const Centerline& centerline = cones_.centerline();
  std::vector<Index> faced;
  const auto& [p, radius] = centerline.node(node);
  const double around = (1 + widest_.smaller) * radius;
  tree_.visit_overlapping(p.array() - around, p.array() + around, [&](Index c) {
    if (may_face(node, c)) faced.push_back(c);
  });
  std::sort(faced.begin(), faced.end());
  std::vector<Index> reached, open = {node}, seen = {node};
  while (!open.empty()) {
    const Index n = open.back();
    open.pop_back();
    for (const Index s : centerline.incident_segments(n)) {
      if (!std::binary_search(faced.begin(), faced.end(), s)) continue;
      reached.push_back(s);
      const Index next = centerline.other_node(s, n);
      if (std::find(seen.begin(), seen.end(), next) != seen.end() || !faces_node(node, next)) continue;
      seen.push_back(next);
      open.push_back(next);
    }
  }
  sort_unique(reached);
  if (reached != faced) faced.clear();
  return faced;
}

// Whether the part may end at a node. Adds what it faces to `all`.
bool RelationExcerpts::ends_at(Index node, std::vector<Index>& all) const {
  const auto incident = cones_.centerline().incident_segments(node);
  if (std::ranges::any_of(incident, [this](Index s) { return less_rounded_[s] != 0; })) return false;
  const std::vector<Index> faced = faced_at(node);
  all.insert(all.end(), faced.begin(), faced.end());
  return !faced.empty();
}

// The cones, those along the graph up to where parts may end, and those faced there.
std::vector<Index> RelationExcerpts::influenced_by(const std::vector<Index>& cones, double beyond) const {
  const Centerline& centerline = cones_.centerline();
  std::unordered_map<Index, double> away;  // of nodes, mean radii
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](Index node, double distance) {
    const auto [known, is_new] = away.try_emplace(node, distance);
    if (!is_new && known->second <= distance) return;
    known->second = distance;
    open.emplace(distance, node);
  };
  std::vector<Index> all = cones;
  std::vector<char> inner(cones_.cone_count(), 0);
  for (const Index c : cones) {
    inner[c] = 1;
    if (cones_.is_sphere(c)) continue;
    for (const Index n : {cones_.first_node(c), cones_.last_node(c)}) reach(n, 0);
  }
  while (!open.empty()) {
    const auto [distance, node] = open.top();
    open.pop();
    if (distance > away.at(node)) continue;
    const auto incident = centerline.incident_segments(node);
    if (std::ranges::all_of(incident, [&](Index s) { return inner[s] != 0; })) continue;
    if (distance >= beyond && ends_at(node, all)) continue;
    for (const Index s : incident) {
      if (inner[s]) continue;
      inner[s] = 1;
      all.push_back(s);
      reach(centerline.other_node(s, node), distance + centerline.length(s) / centerline.radius_at(s, 0.5));
    }
  }
  sort_unique(all);
  return all;
}

RelationExcerpt RelationExcerpts::take(const std::vector<Index>& cones) const {
  std::vector<Index> around = cones;
  for (const Index c : cones) add_near(grown_box(cones_, c, question_), around);
  sort_unique(around);
  return part(influenced_by(around), cones);
}

RelationExcerpt RelationExcerpts::take_alone(const std::vector<Index>& cones) const {
  return part(influenced_by(cones), cones);
}

RelationExcerpt RelationExcerpts::part(const std::vector<Index>& cones, const std::vector<Index>& near) const {
  const Centerline& centerline = cones_.centerline();
  std::vector<Index> node;
  for (const Index c : cones) node.insert(node.end(), {cones_.first_node(c), cones_.last_node(c)});
  sort_unique(node);
  std::vector<CenterlineNode> nodes;
  for (const Index n : node) nodes.push_back(centerline.node(n));
  std::vector<CenterlineSegment> segments;
  std::vector<char> is_near;
  for (const Index c : cones) {
    is_near.push_back(std::binary_search(near.begin(), near.end(), c));
    if (!cones_.is_sphere(c))
      segments.push_back({place_in(node, cones_.first_node(c)), place_in(node, cones_.last_node(c))});
  }
  return {Centerline(std::move(nodes), std::move(segments)), cones, std::move(is_near)};
}

}  // namespace vmesh
