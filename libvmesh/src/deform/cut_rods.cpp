#include "deform/cut_rods.h"

#include <string>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

Index segment_before(Index segment, const CenterlineCut& cut) {
  return segment == cut.end_segment[1] ? cut.before({segment, 0}).segment : segment;
}

bool is_new(Index node, const RodTree& before) { return node >= before.slot_of_node.size(); }

/// The slot before of a segment after.
Index slot_before(Index segment, const RodTree& before, const CenterlineCut& cut) {
  return before.slot_of_segment[segment_before(segment, cut)];
}

/// The slot whose segment hangs from root `root` first; kNone for an isolated node.
Index first_child(const RodTree& tree, Index root) {
  return root + 1 < tree.size() && tree.parent[root + 1] == root ? root + 1 : kNone;
}

/// Whose frame and spin a slot takes.
Index frame_origin(const RodTree& before, const RodTree& after, const CenterlineCut& cut, Index j) {
  if (after.segment[j] != kNone) return slot_before(after.segment[j], before, cut);
  const Index node = after.node[j];
  if (!is_new(node, before) && before.parent[before.slot_of_node[node]] == kNone) return before.slot_of_node[node];
  return slot_before(after.segment[first_child(after, j)], before, cut);
}

/// The slot before of a node that is not new: where it closes a loop with the same segment, that one of its slots.
Index node_origin(const RodTree& before, const RodTree& after, const CenterlineCut& cut, Index j) {
  const Index node = after.node[j];
  if (j != after.slot_of_node[node]) {
    const Index own = slot_before(after.segment[j], before, cut);
    if (before.node[own] == node) return own;
  }
  return before.slot_of_node[node];
}

/// A node that is new: on the segment cut, or the same as the node cut.
void set_new_node(const RodTree& before, const CenterlineCut& cut, SlotOrigin& origin) {
  const Index slot = before.slot_of_segment[cut.at.segment];
  if (cut.between_segments) {
    origin.a = origin.b = before.slot_of_node[cut.end[0]];
    return;
  }
  origin.a = before.parent[slot];
  origin.b = slot;
  // The end that is not new of the segment's first half is its node a.
  const auto& [a, b] = cut.centerline.segment(cut.end_segment[0]);
  const bool runs_along = before.node[slot] != a;
  origin.share = runs_along ? cut.at.t : 1 - cut.at.t;
}

/// The slot before of a node at one end of a segment after.
Index end_before(const RodTree& before, const CenterlineCut& cut, Index segment, Index node) {
  if (cut.between_segments && node == cut.end[1]) node = cut.end[0];
  const Index slot = slot_before(segment, before, cut);
  return before.node[slot] == node ? slot : before.parent[slot];
}

/// Where a slot is at the ends of segments that ended in different ones before, as loops are tied elsewhere now, its
/// velocity is that of all of them together.
void merge_velocities(const RodScene& before, const CenterlineCut& cut,
                      const std::vector<SegmentProperties>& properties, RodScene& after) {
  std::vector<Vec3> momentum(after.size(), Vec3::Zero());
  std::vector<double> mass(after.size(), 0);
  std::vector<char> differs(after.size(), 0);
  for (Index j = 0; j < after.size(); ++j) {
    if (after.tree.parent[j] == kNone) continue;
    const Index segment = after.tree.segment[j];
    for (const Index slot : {j, after.tree.parent[j]}) {
      const Index node = after.tree.node[slot];
      if (is_new(node, before.tree) && !cut.between_segments) continue;
      const Vec3& velocity = before.velocity[end_before(before.tree, cut, segment, node)];
      momentum[slot] += properties[segment].mass_kg * velocity;
      mass[slot] += properties[segment].mass_kg;
      if (velocity != after.velocity[slot]) differs[slot] = 1;
    }
  }
  for (Index j = 0; j < after.size(); ++j)
    if (differs[j]) after.velocity[j] = momentum[j] / mass[j];
}

/// Springs between the same two segments.
void keep_angular_springs(const RodScene& before, const CenterlineCut& cut, RodScene& after) {
  for (Index j = 0; j < after.size(); ++j) {
    const Index parent = after.tree.parent[j];
    if (parent == kNone) continue;
    const Index old = slot_before(after.tree.segment[j], before.tree, cut), old_parent = before.tree.parent[old];
    const Index of_parent = after.tree.segment[parent];
    const bool alike = of_parent == kNone ? after.tree.node[parent] == before.tree.node[old_parent] &&
                                                before.tree.parent[old_parent] == kNone
                                          : slot_before(of_parent, before.tree, cut) == old_parent;
    if (!alike) continue;
    after.rods[j].tip_xy = before.rods[old].tip_xy;
    after.rods[j].tip_z = before.rods[old].tip_z;
  }
}

/// Roots of before, then the new ends.
std::vector<Index> roots_of(const RodTree& before, const CenterlineCut& cut) {
  std::vector<Index> roots;
  for (Index j = 0; j < before.size(); ++j)
    if (before.parent[j] == kNone) roots.push_back(before.node[j]);
  roots.insert(roots.end(), cut.end.begin(), cut.end.end());
  return roots;
}

void carry_state(const RodScene& before, const CenterlineCut& cut, const std::vector<SegmentProperties>& properties,
                 RodScene& after) {
  const std::vector<SlotOrigin> origin = slot_origins(before.tree, after.tree, cut);
  after.pose.position = carried(before.pose.position, origin);
  after.velocity = carried(before.velocity, origin);
  after.target = after.pose.position;
  if (!before.pose.radial_scale.empty()) after.pose.radial_scale = carried(before.pose.radial_scale, origin);
  for (Index j = 0; j < after.size(); ++j) {
    const Index from = origin[j].frame;
    // The same rotation from rest, to the bit where the frame at rest is the same.
    after.pose.frame[j] =
        after.tree.frame[j] == before.tree.frame[from]
            ? before.pose.frame[from]
            : Mat3(before.pose.frame[from] * before.tree.frame[from].transpose() * after.tree.frame[j]);
    after.spin[j] = before.spin[from];
    const Index node = after.tree.node[j];
    if (is_new(node, before.tree) || j != after.tree.slot_of_node[node]) continue;
    after.hold[j] = before.hold[origin[j].a];
    after.force[j] = before.force[origin[j].a];
    after.torque[j] = before.torque[origin[j].a];
    after.target[j] = before.target[origin[j].a];
  }
  merge_velocities(before, cut, properties, after);
}

}  // namespace

CenterlineCut uncut(const InsertedNode& node) {
  return {node.centerline, node.at, false, {node.node, node.node}, {node.at.segment, node.beyond}};
}

void require_cut(const RodScene& scene, const CenterlineCut& cut) {
  const std::size_t nodes = scene.tree.slot_of_node.size(), segments = scene.tree.slot_of_segment.size();
  const bool parts = cut.end[0] != cut.end[1];
  const std::size_t added = cut.between_segments || !parts ? 1 : 2, divided = cut.between_segments ? 0 : 1;
  if (cut.centerline.nodes().size() != nodes + added || cut.centerline.segments().size() != segments + divided)
    throw InvalidInput("simulation: the cut is of another centerline than the one that moves, which has " +
                       std::to_string(nodes) + " nodes and " + std::to_string(segments) + " segments");
  if (!cut.between_segments) return;
  const Index slot = scene.tree.slot_of_node[cut.end[0]];
  if (scene.hold[slot] != Hold::free || !scene.force[slot].isZero(0) || !scene.torque[slot].isZero(0))
    throw InvalidInput("simulation: node " + std::to_string(cut.end[0]) +
                       " is held or has a force; cut the vessel beside it, on a segment");
}

std::vector<SegmentProperties> cut_properties(std::vector<SegmentProperties> properties, const CenterlineCut& cut) {
  if (cut.between_segments) return properties;
  SegmentProperties& first = properties[cut.at.segment];
  SegmentProperties second = first;
  for (double SegmentProperties::*share : {&SegmentProperties::mass_kg, &SegmentProperties::inertia_kg_mm2}) {
    second.*share = (1 - cut.at.t) * first.*share;
    first.*share *= cut.at.t;
  }
  properties.push_back(second);
  return properties;
}

std::vector<SlotOrigin> slot_origins(const RodTree& before, const RodTree& after, const CenterlineCut& cut) {
  std::vector<SlotOrigin> origins(after.size());
  for (Index j = 0; j < after.size(); ++j) {
    SlotOrigin& origin = origins[j];
    if (is_new(after.node[j], before))
      set_new_node(before, cut, origin);
    else
      origin.a = origin.b = node_origin(before, after, cut, j);
    origin.frame = frame_origin(before, after, cut, j);
  }
  return origins;
}

RodScene cut_scene(const RodScene& before, const CenterlineCut& cut, const std::vector<SegmentProperties>& properties) {
  RodScene after = make_rod_scene(cut.centerline, properties, before.options, roots_of(before.tree, cut));
  keep_angular_springs(before, cut, after);
  if (!after.tree.ties.empty()) after.tie_stretch = before.tie_stretch;
  carry_state(before, cut, properties, after);
  return after;
}

}  // namespace vmesh
