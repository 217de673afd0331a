#include "deform/profile.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr double kTau = 6.283185307179586;
/// A squeeze neither closes a vessel nor widens it beyond this.
constexpr double kNarrowest = 0.05, kWidest = 4;
/// Scales closer than this to their goals count as equal.
constexpr double kArrived = 1e-9;

}  // namespace

Profile::Profile(const Centerline& centerline, const std::vector<SegmentProperties>& properties,
                 const SimulationOptions& options)
    : follow_(options.step_s / (options.step_s + options.squeeze_response_s)) {
  set_area_and_stiffness(centerline, properties);
}

void Profile::carry_on(const Profile& before, const std::vector<SlotOrigin>& origin) {
  settled_ = before.settled_;
  if (before.scale_.empty()) return;
  scale_ = carried(before.scale_, origin);
  squeezed_ = carried(before.squeezed_, origin);
  goal_ = carried(before.goal_, origin);
}

void Profile::set_area_and_stiffness(const Centerline& centerline, const std::vector<SegmentProperties>& properties) {
  area_mm2_.assign(centerline.nodes().size(), 0);
  stiffness_N_mm2_ = area_mm2_;
  for (Index s = 0; s < properties.size(); ++s)
    for (const Index n : {centerline.segment(s).a, centerline.segment(s).b}) {
      const double area = 0.5 * kTau * centerline.node(n).radius * centerline.length(s);
      area_mm2_[n] += area;
      stiffness_N_mm2_[n] += area * properties[s].squeeze_N_mm2;
    }
  for (std::size_t n = 0; n < area_mm2_.size(); ++n)
    if (area_mm2_[n] > 0) stiffness_N_mm2_[n] /= area_mm2_[n];
}

void Profile::enable(RodScene& scene) {
  if (!scene.pose.radial_scale.empty()) return;
  scale_.assign(scene.size(), 1);
  squeezed_ = goal_ = scene.pose.radial_scale = scale_;
}

void Profile::set_scale(Index slot, double scale, RodScene& scene) {
  enable(scene);
  set(scale_, slot, scale, scene.tree);
}

/// Sets the value at all slots of the node.
void Profile::set(std::vector<double>& values, Index slot, double value, const RodTree& tree) {
  if (values[slot] == value) return;
  values[slot] = value;
  for (const auto& tie : tree.ties)
    if (tie.node_slot == slot) values[tie.slot] = value;
  settled_ = false;
}

void Profile::set_squeeze(Index slot, double force_N, RodScene& scene) {
  enable(scene);
  const Index node = scene.tree.node[slot];
  const double per_pressure = area_mm2_[node] * stiffness_N_mm2_[node];
  const double strain = per_pressure > 0 ? force_N / per_pressure : 0;
  const double goal = strain <= 1 / kWidest - 1 ? kWidest : std::clamp(1 / (1 + strain), kNarrowest, kWidest);
  set(goal_, slot, goal, scene.tree);
}

void Profile::step(RodScene& scene) noexcept {
  if (settled_) return;
  settled_ = true;
  for (Index j = 0; j < scene.size(); ++j) {
    squeezed_[j] += follow_ * (goal_[j] - squeezed_[j]);
    if (std::abs(goal_[j] - squeezed_[j]) <= kArrived) squeezed_[j] = goal_[j];
    settled_ = settled_ && squeezed_[j] == goal_[j];
    const double scale = scale_[j] * squeezed_[j];
    if (scale == scene.pose.radial_scale[j]) continue;
    scene.pose.radial_scale[j] = scale;
    scene.moved[j] = 1;
  }
}

}  // namespace vmesh
