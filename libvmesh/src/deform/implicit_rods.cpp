#include "deform/implicit_rods.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

/// Relative rounding of the energy's sum of terms.
constexpr double kEnergyTolerance = 1e-12;
constexpr int kMostAttempts = 40;
/// With more than one slot in this number awake, visiting all of them is faster than sorting.
constexpr std::size_t kMuchAwake = 8;

}  // namespace

ImplicitRods::ImplicitRods(const RodScene& scene, InstructionSet set)
    : kernels_(&VMESH_VARIANT(set, kRodKernels)), batches_(make_rod_batches(scene)), slot_count_(scene.size()) {
  visited_.assign(batches_.size() * kLanes, 0);
  fresh_ = awake_ = quiet_steps_ = visited_;
  listed_.assign(batches_.size(), 0);
  visited_batches_.reserve(batches_.size());
  grown_batches_.reserve(batches_.size());
  awake_places_.reserve(slot_count_);
  pulled_places_.reserve(slot_count_);
  tie_load_.resize(scene.tree.ties.size());
  tie_residual_ = tie_direction_ = tie_image_ = tie_opening_ = tie_load_;
  wake_all();
}

void ImplicitRods::wake(Index slot) { wake_place(batches_.place_of_slot[slot]); }

void ImplicitRods::wake_place(Index place) {
  if (!awake_[place]) awake_places_.push_back(place);
  awake_count_ += !awake_[place];
  awake_[place] = 1;
  quiet_steps_[place] = 0;
}

void ImplicitRods::wake_all() {
  for (const Index place : batches_.place_of_slot) wake_place(place);
}

StepReport ImplicitRods::step(RodScene& scene) noexcept {
  if (around_) return step_among(scene);
  StepReport report;
  if (awake_count_ == 0) return report;
  if (!scene.tree.ties.empty() && awake_count_ < slot_count_) wake_all();
  choose_visited();
  begin_slots(scene);
  for (int i = 0; i < scene.options.iterations; ++i) {
    report.movement_mm = iterate(scene, i == 0, report);
    ++report.iterations;
    if (report.movement_mm == 0) break;
  }
  finish(scene, report);
  return report;
}

void ImplicitRods::begin_slots(RodScene& scene) {
  begin_sums_ = {};
  pulled_places_.clear();
  pose_ = 0;
  for (const Index batch : visited_batches_) {
    begin_batch(scene, batch, &visited_[batch * kLanes]);
    eliminate(batch);  // while it is still in the cache
    if (batches_.batches[batch].held) note_pulled(batch);
  }
  eliminated_ = true;
  start_tie_energy_ = tie_energy(scene, 0);
}

void ImplicitRods::begin_batch(const RodScene& scene, Index batch, const char* active) {
  kernels_->begin(batches_.batches[batch], active, scene, begin_sums_);
  if (around_) bind_to_tissue(batch, active);
}

/// Visits all awake slots, their children, and everything between them and the root.
void ImplicitRods::choose_visited() {
  if (all_visited_ && awake_count_ == slot_count_) return;
  for (const Index batch : visited_batches_) {
    listed_[batch] = 0;
    std::fill_n(&visited_[batch * kLanes], kLanes, char{0});
  }
  visited_batches_.clear();
  all_visited_ = awake_count_ == slot_count_;
  if (kMuchAwake * awake_count_ > slot_count_) {
    for (Index place = 0; place < visited_.size(); ++place) {
      const Index parent = batches_.batches[place / kLanes].parent[place % kLanes];
      if (!visited_[place] && !awake_[place] && !awake_[parent]) continue;
      visit(place);
      visit(parent);
    }
  } else {
    for (const Index place : awake_places_) {
      for (Index up = place; !visited_[up]; up = batches_.batches[up / kLanes].parent[up % kLanes]) visit(up);
      visit_children(place);
    }
  }
  std::sort(visited_batches_.begin(), visited_batches_.end());
}

void ImplicitRods::visit(Index place) {
  visited_[place] = 1;
  const auto batch = static_cast<Index>(place / kLanes);
  if (listed_[batch]) return;
  listed_[batch] = 1;
  visited_batches_.push_back(batch);
}

void ImplicitRods::visit_children(Index place) {
  for_children(place, [this](Index child) { visit(child); });
}

void ImplicitRods::note_pulled(Index batch) {
  for (Index place = batch * kLanes; place < (batch + 1) * kLanes; ++place)
    if (visited_[place] && pull(place, 0) != Vec3::Zero()) pulled_places_.push_back(place);
}

/// The displacement prescribed for a held slot.
Vec3 ImplicitRods::pull(Index place, std::size_t pose) const {
  const RodBatch& b = batches_.batches[place / kLanes];
  const std::size_t i = place % kLanes;
  if (b.hold[i] == Hold::free) return Vec3::Zero();
  return Vec3(b.target.x[i], b.target.y[i], b.target.z[i]) - position(place, pose);
}

Vec3 ImplicitRods::position(Index place, std::size_t pose) const {
  const Lanes3& p = batches_.batches[place / kLanes].pose[pose].position;
  return {p.x[place % kLanes], p.y[place % kLanes], p.z[place % kLanes]};
}

/// Increase of the objective when dragged slots are moved a part of the rest of the way to their targets and everything
/// else stands still: the springs to their parents and children are stretched.
double ImplicitRods::drag_energy(std::size_t pose, double part) const {
  const auto stretch = [this, pose](Index place, const Vec3& by) {
    const RodBatch& b = batches_.batches[place / kLanes];
    const std::size_t i = place % kLanes;
    const Lanes3 &m = b.pose[pose].misfit, &m0 = b.pose[0].misfit;
    const Vec3 misfit{m.x[i], m.y[i], m.z[i]}, since = misfit - Vec3{m0.x[i], m0.y[i], m0.z[i]};
    return 0.5 * b.stretch[i] * (by.dot(2 * misfit + by) + b.damping_rate[i] * by.dot(2 * since + by));
  };
  const auto way = [this, pose, part](Index place) -> Vec3 { return part * pull(place, pose); };
  double energy = 0;
  for (const Index place : pulled_places_) {
    const RodBatch& b = batches_.batches[place / kLanes];
    const Vec3 by = way(place);
    if (b.is_root[place % kLanes] == 0) energy += stretch(place, by - way(b.parent[place % kLanes]));
    for_children(place, [&](Index child) {
      if (pull(child, 0) == Vec3::Zero()) energy += stretch(child, -by);
    });
  }
  return energy;
}

/// Energy of the springs that close loops, uJ, after `pulled` of the rest of the way of what is dragged.
double ImplicitRods::tie_energy(const RodScene& scene, double pulled) const {
  double energy = 0;
  for (const auto& [slot, node_slot] : scene.tree.ties) {
    const Index a = batches_.place_of_slot[slot], b = batches_.place_of_slot[node_slot];
    Vec3 gap = position(a, pose_) - position(b, pose_);
    if (pulled > 0) gap += pulled * (pull(a, pose_) - pull(b, pose_));
    energy += 0.5 * scene.tie_stretch * gap.squaredNorm();
  }
  return energy;
}

/// One Gauss-Newton iteration. Returns the largest displacement.
double ImplicitRods::iterate(RodScene& scene, bool first, StepReport& report) {
  double before = drag_energy(0, 1);
  if (!first) {
    before = sum(move_sums_.value);
    begin_sums_.value = Lanes{};
  }
  before += tie_energy(scene, first ? 1 : 0);
  RodMove by{pose_, pose_ == 1 ? std::size_t{2} : std::size_t{1}};
  move_sums_ = {};
  solve(scene, &by);
  before += sum(begin_sums_.value);  // of all slots, or of those the solution visited
  if (first) energy_bound_ = before;
  pose_ = by.to;
  for (int attempt = 1; by.part > 0; ++attempt) {
    if (sum(move_sums_.value) + tie_energy(scene, 0) <= before * (1 + kEnergyTolerance)) break;
    ++report.rejections;
    if (!by.chained) by.part /= 2;
    if (attempt == kMostAttempts) by.part = 0;
    by.chained = !by.chained;
    move(by);
  }
  return by.part * std::sqrt(largest(move_sums_.largest));
}

void ImplicitRods::move(const RodMove& by) {
  move_sums_ = {};
  for (std::size_t i = visited_batches_.size(); i-- > 0;) {
    const Index batch = visited_batches_[i];
    kernels_->move(batches_, batch, &visited_[batch * kLanes], by, move_sums_);
  }
}

}  // namespace vmesh
