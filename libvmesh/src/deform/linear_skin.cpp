#include "vmesh/deform/linear_skin.h"

#include <string>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// The numbers of a slot's joints.
struct SlotJoints {
  Index own = kNone, start = kNone, parent = kNone;
};

std::vector<SlotJoints> joints_of_slots(const RodTree& tree) {
  std::vector<SlotJoints> joints(tree.size());
  Index next = 0;
  for (Index j = 0; j < tree.size(); ++j) {
    joints[j].own = next++;
    if (tree.parent[j] == kNone) continue;
    joints[j].start = next++;
    joints[j].parent = next++;
  }
  return joints;
}

std::vector<Index> isolated_slots(const Centerline& centerline, const RodTree& tree) {
  std::vector<Index> slots;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) == 0) slots.push_back(tree.slot_of_node[n]);
  }
  return slots;
}

}  // namespace

SurfaceSkin make_linear_skin(const Centerline& centerline, const RodTree& tree, std::span<const SurfacePlace> places) {
  SurfaceSkin skin;
  for (Index j = 0; j < tree.size(); ++j) {
    skin.joints.push_back({"node " + std::to_string(tree.node[j]), tree.position[j]});
    if (tree.parent[j] == kNone) continue;
    const std::string segment = "segment " + std::to_string(tree.segment[j]);
    skin.joints.push_back({segment + " start", tree.position[tree.parent[j]]});
    skin.joints.push_back({segment + " parent", tree.position[j]});
  }
  const std::vector<SlotJoints> joints = joints_of_slots(tree);
  const std::vector<Index> isolated = isolated_slots(centerline, tree);
  const std::size_t segments = centerline.segments().size();
  for (std::size_t v = 0; v < places.size(); ++v) {
    const auto [segment, t] = places[v];
    if (segment >= segments + isolated.size() || !(t >= 0 && t <= 1))
      throw InvalidInput("vertex " + std::to_string(v) + ": its place on the centerline, segment " +
                         std::to_string(segment) + " at " + std::to_string(t) + ", does not exist");
    if (segment >= segments) {
      skin.joint_of_vertex.push_back({joints[isolated[segment - segments]].own, 0, 0, 0});
      skin.weight.push_back({1, 0, 0, 0});
      continue;
    }
    const Index slot = tree.slot_of_segment[segment], parent = tree.parent[slot];
    const bool turned = tree.node[slot] == centerline.segment(segment).a;
    const auto at_end = static_cast<float>((turned ? 1 - t : t) / 2);
    const float at_start = 0.5f - at_end;
    std::array<Index, 4> of_vertex = {joints[parent].own, joints[slot].start, joints[slot].own, joints[slot].parent};
    const std::array<float, 4> weight = {at_start, at_start, at_end, at_end};
    for (std::size_t i = 0; i < 4; ++i) {
      if (weight[i] == 0) of_vertex[i] = 0;
    }
    skin.joint_of_vertex.push_back(of_vertex);
    skin.weight.push_back(weight);
  }
  return skin;
}

std::vector<JointPose> joint_poses(const RodTree& tree, const Pose& pose) {
  std::vector<JointPose> poses;
  const auto rotation = [&](Index slot) -> Mat3 { return pose.frame[slot] * tree.frame[slot].transpose(); };
  for (Index j = 0; j < tree.size(); ++j) {
    poses.push_back({rotation(j), pose.position[j]});
    const Index parent = tree.parent[j];
    if (parent == kNone) continue;
    poses.push_back({rotation(j), pose.position[parent]});
    poses.push_back({rotation(parent), pose.position[j]});
  }
  return poses;
}

}  // namespace vmesh
