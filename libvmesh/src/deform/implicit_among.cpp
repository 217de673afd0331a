// ImplicitRods: a step among instruments, other vessels, jaws and tissue.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

/// Relative rounding of the energy's sum of terms, and of positions, which stretches segments of a tree at rest.
constexpr double kRoundingOfEnergy = 1e-12, kRoundingOfPosition = 1e-15;
/// Attempts at a move.
constexpr int kMostTries = 40;
/// Solutions in an iteration with more and more pairs stopped; and those after which stops may be left out again.
constexpr int kMostStops = 5, kMostRevisions = 3;
/// Tries after which nodes move along straight lines, so that a shorter move is part of a longer one.
constexpr int kChainedTries = 4;
/// The part of its way for which everything is made to go at once, at least; it is shorter after one that was too long
/// for what is linear.
constexpr double kLeastStride = 1e-3;
/// An iteration whose move was shorter than this part of the solution has not converged, however short it was.
constexpr double kHindered = 0.1;
/// After an iteration that got less far, the next one relaxes without going on.
constexpr double kStuck = 0.1;

}  // namespace

void ImplicitRods::attach(const RodScene& scene, Surroundings& around) {
  around_ = &around;
  rounding_ = 0;
  for (Index j = 0; j < scene.size(); ++j)
    rounding_ += scene.rods[j].stretch * std::pow(kRoundingOfPosition, 2) * scene.tree.position[j].squaredNorm();
  wake_all();
}

StepReport ImplicitRods::step_among(RodScene& scene) {
  StepReport report;
  if (left_ > 0)
    for (const Index place : pulled_places_) wake_place(place);
  around_->begin(scene);
  for (const Index slot : around_->near_slots()) wake(slot);
  if (awake_count_ == 0) {
    around_->go_alone();
    return report;
  }
  if ((!scene.tree.ties.empty() || around_->couples()) && awake_count_ < slot_count_) wake_all();
  choose_visited();
  tissue_offset_ = around_work_ = 0;
  around_before_ = around_->stored();
  around_->try_part(1);
  linearise(stride_);
  begin_slots(scene);
  left_ = around_->moves() || !pulled_places_.empty() ? 1 : 0;
  bool relaxes = false, done = false;
  for (int i = 0; !done; ++i) {
    const double left = left_;
    report.movement_mm = iterate_among(scene, i == 0, relaxes ? 0 : stride_, report);
    ++report.iterations;
    relaxes = !relaxes && left_ > 0 && left_ > (1 - kStuck) * left;
    done = is_done(scene, report, left == left_ && !relaxes);
  }
  finish(scene, report);
  return report;
}

bool ImplicitRods::is_done(const RodScene& scene, const StepReport& report, bool stands) const {
  if (report.movement_mm == 0 && stands) return true;
  if (report.iterations < scene.options.iterations) return false;
  if (report.iterations >= scene.options.iterations + around_->options().iterations) return true;
  return left_ == 0 && !blocked_ && (!around_->acts() || report.movement_mm <= around_->precision());
}

/// One Gauss-Newton iteration, in which instruments and what is dragged go on if `goes` is 1, as far as there is room.
/// Returns the largest displacement.
double ImplicitRods::iterate_among(RodScene& scene, bool first, double goes, StepReport& report) {
  if (left_ == 0) goes = 0;
  double standing = 0;
  if (!first) {
    standing = sum(move_sums_.value);
    begin_sums_.value = Lanes{};
    linearise(goes);
  }
  aim_held(scene, goes);
  if (goes < 1) eliminated_ = false;
  RodMove by{pose_, pose_ == 1 ? std::size_t{2} : std::size_t{1}};
  solve_among(scene, by, goes);
  standing += sum(begin_sums_.value);
  if (first) energy_bound_ = around_->moves() ? HUGE_VAL : standing_energy(scene, standing, goes) + tissue_offset_;
  double free = look_at(scene, by, goes);
  if (free < 1) free = straighten(scene, by, free, goes);
  for (int attempt = 1; free < 1 || !is_lower(scene, by, standing, goes); ++attempt) {
    if (by.part == 0) break;
    ++report.rejections;
    shorten(by, free, attempt);
    move_part(scene, by, goes);
    free = look_at(scene, by, goes);
  }
  around_->accept();
  pose_ = by.to;
  if (goes > 0) {
    left_ = goes * by.part == 1 ? 0 : left_ * (1 - goes * by.part);
    stride_ = std::clamp(by.part < 0.5 ? 2 * goes * by.part : 4 * goes, kLeastStride, 1.0);
  }
  aim_held(scene, 1);
  blocked_ = by.part < kHindered;
  return by.part * std::sqrt(largest(move_sums_.largest));
}

/// Solves and moves. What the solution lets run into each other is stopped, and it is solved again.
void ImplicitRods::solve_among(const RodScene& scene, const RodMove& by, double goes) {
  move_sums_ = {};
  if (!around_->may_touch()) return solve(scene, &by);
  for (int i = 0;; ++i) {
    solve(scene, nullptr);
    eliminated_ = all_visited_ && scene.tree.ties.empty();
    if (i == kMostStops) break;
    for (const Index batch : visited_batches_) {
      const RodBatch& b = batches_.batches[batch];
      for (std::size_t l = 0; l < kLanes; ++l)
        if (visited_[batch * kLanes + l])
          around_->trial()[b.slot[l]] =
              around_->present()[b.slot[l]] + Vec3(b.x.linear.x[l], b.x.linear.y[l], b.x.linear.z[l]);
    }
    around_->try_part(goes);
    if (!around_->stop(scene, goes, i < kMostRevisions)) break;

    if (around_->loads_changed()) take_loads();
  }
  eliminated_ = false;
  move(by);
}

/// How much of a move is free.
double ImplicitRods::look_at(const RodScene& scene, const RodMove& by, double goes) {
  read_positions(by.to, around_->trial());
  around_->try_part(goes * by.part);
  return around_->free_part(scene);
}

/// Whether there is less energy after a move than with everything standing still but what goes on.
bool ImplicitRods::is_lower(const RodScene& scene, const RodMove& by, double standing, double goes) {
  const double around = around_->energy(Surroundings::State::trial);
  const double reference = standing_energy(scene, standing, goes * by.part);
  pose_ = by.to;
  const double energy = sum(move_sums_.value) + tie_energy(scene, 0) + around;
  pose_ = by.from;
  return energy <= reference + kRoundingOfEnergy * std::abs(reference) + rounding_;
}

/// What runs into something along arcs may not along straight lines, for which stops were made. Takes what is free for
/// longer, and returns how much that is.
double ImplicitRods::straighten(const RodScene& scene, RodMove& by, double free, double goes) {
  by.chained = false;
  move_part(scene, by, goes);
  const double straight = look_at(scene, by, goes);
  if (straight >= free) return straight;
  by.chained = true;
  return free;
}

void ImplicitRods::move_part(const RodScene& scene, const RodMove& by, double goes) {
  aim_held(scene, goes * by.part);
  move(by);
  aim_held(scene, goes);
}

void ImplicitRods::shorten(RodMove& by, double free, int attempt) {
  const bool may_chain = attempt < kChainedTries;
  if (free < 1) {
    by.part *= free;
    by.chained = by.chained && may_chain;
  } else {
    if (!by.chained) by.part /= 2;
    by.chained = !by.chained && may_chain;
  }
  if (attempt >= kMostTries) by.part = 0;
}

/// The objective with everything standing still, but for `goes` of the rest of the way of instruments and of what is
/// dragged. Infinite if they would run into each other.
double ImplicitRods::standing_energy(const RodScene& scene, double standing, double goes) {
  if (goes == 0) return standing + tie_energy(scene, 0) + around_->energy(Surroundings::State::present);
  standing_ = around_->present();
  for (const Index place : pulled_places_)
    standing_[batches_.batches[place / kLanes].slot[place % kLanes]] += goes * pull(place, pose_);
  return standing + drag_energy(pose_, goes) + tie_energy(scene, goes) + around_->energy_at(standing_);
}

/// What is dragged is to go a part of the rest of its way.
void ImplicitRods::aim_held(const RodScene& scene, double part) {
  for (const Index place : pulled_places_) {
    RodBatch& b = batches_.batches[place / kLanes];
    const std::size_t i = place % kLanes;
    const Vec3 from = position(place, pose_), aim = scene.target[b.slot[i]];
    const Vec3 to = part == 1 ? aim : Vec3(from + part * (aim - from));
    b.target.x[i] = to.x(), b.target.y[i] = to.y(), b.target.z[i] = to.z();
  }
}

void ImplicitRods::read_positions(std::size_t pose, std::vector<Vec3>& into) const {
  for (const Index batch : visited_batches_) {
    const RodBatch& b = batches_.batches[batch];
    const Lanes3& p = b.pose[pose].position;
    for (std::size_t i = 0; i < kLanes; ++i)
      if (visited_[batch * kLanes + i]) into[b.slot[i]] = Vec3(p.x[i], p.y[i], p.z[i]);
  }
}

/// The spring to the tissue is quadratic in the position like inertia: both together are one such term.
void ImplicitRods::bind_to_tissue(Index batch, const char* active) {
  const std::vector<TissueSpring>& springs = around_->tissue.springs;
  if (springs.empty()) return;
  RodBatch& b = batches_.batches[batch];
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (!active[i] || !springs[b.slot[i]].exists()) continue;
    const TissueSpring& spring = springs[b.slot[i]];
    const Lanes3 &at = b.pose[0].position, &p = b.predicted_position;
    const Vec3 from{at.x[i], at.y[i], at.z[i]}, predicted{p.x[i], p.y[i], p.z[i]};
    const double both = b.step_mass[i], inertia = both - spring.stiffness;
    const Vec3 middle = predicted + spring.stiffness / both * (spring.rest - predicted);
    around_before_ += spring.energy(from);
    if (b.hold[i] == Hold::free) {
      begin_sums_.value[i] += 0.5 * both * ((from - middle).squaredNorm() - (from - predicted).squaredNorm());
      tissue_offset_ += 0.5 * inertia * (spring.stiffness / both) * (predicted - spring.rest).squaredNorm();
    }
    const Vec3 gradient = both * (from - middle);
    b.predicted_position.x[i] = middle.x(), b.predicted_position.y[i] = middle.y(),
    b.predicted_position.z[i] = middle.z();
    b.gradient.linear.x[i] = gradient.x(), b.gradient.linear.y[i] = gradient.y(), b.gradient.linear.z[i] = gradient.z();
  }
}

void ImplicitRods::set_tissue(const RodScene& scene, Index slot, const TissueSpring& spring) {
  around_->tissue.springs.resize(scene.size());
  around_->tissue.springs[slot] = spring;
  const Index place = batches_.place_of_slot[slot];
  const double step = scene.options.step_s;
  batches_.batches[place / kLanes].step_mass[place % kLanes] =
      (1 + scene.options.drag_per_s * step) * scene.rods[slot].mass / (step * step) + spring.stiffness;
  wake_place(place);
}

/// Energies and work of the surroundings, from the positions at the end of a step.
void ImplicitRods::end_among(RodScene& scene) {
  around_after_ = around_->stored();
  const std::vector<TissueSpring>& springs = around_->tissue.springs;
  const std::vector<Vec3>&from = around_->started(), &to = around_->present();
  for (const Index place : pulled_places_) {
    const Index slot = batches_.batches[place / kLanes].slot[place % kLanes];
    Vec3 slope = around_->slope_at(slot);
    if (!springs.empty()) slope += springs[slot].stiffness * (to[slot] - springs[slot].rest);
    around_work_ += slope.dot(to[slot] - from[slot]);
  }
  around_work_ += around_->end(scene);
  if (!springs.empty()) tear(scene);
}

void ImplicitRods::tear(const RodScene& scene) {
  for (const Index batch : visited_batches_)
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (!visited_[batch * kLanes + i]) continue;
      const Index slot = batches_.batches[batch].slot[i];
      const TissueSpring& spring = around_->tissue.springs[slot];
      if (!spring.exists()) continue;
      const Vec3& at = around_->present()[slot];
      around_after_ += spring.energy(at);
      if (!spring.tears(at)) continue;
      ++around_->tissue.torn;
      set_tissue(scene, slot, {});
    }
}

/// What is left of the slopes of everything else where a slot is held.
Vec3 ImplicitRods::holding_force(const RodScene& scene, Index slot) const {
  const Index place = batches_.place_of_slot[slot];
  const auto lane = [](const Lanes3& v, std::size_t i) { return Vec3(v.x[i], v.y[i], v.z[i]); };
  const RodBatch& b = batches_.batches[place / kLanes];
  const std::size_t i = place % kLanes;
  if (scene.hold[slot] == Hold::free || b.hold[i] == Hold::free) return Vec3::Zero();
  Vec3 force = lane(b.gradient.linear, i);
  if (b.is_root[i] == 0) force += lane(b.spring_gradient.linear, i);
  for_children(place, [&](Index child) {
    force -= lane(batches_.batches[child / kLanes].spring_gradient.linear, child % kLanes);
  });
  for (const auto& [end, node_slot] : scene.tree.ties) {
    const Vec3 pull = scene.tie_stretch * (scene.pose.position[end] - scene.pose.position[node_slot]);
    if (end == slot) force += pull;
    if (node_slot == slot) force -= pull;
  }
  return around_ ? Vec3(force + around_->slope_at(slot)) : force;
}

}  // namespace vmesh
