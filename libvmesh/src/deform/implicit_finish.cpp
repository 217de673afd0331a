// ImplicitRods: velocities, the energy bound and rest, at the end of a step.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

/// Steps between orthonormalisations of the frames: rounding adds up to about 1e-14 in between.
constexpr std::size_t kSharpenEvery = 64;

}  // namespace

void ImplicitRods::finish(RodScene& scene, StepReport& report) {
  const bool sharpens = ++steps_ % kSharpenEvery == 0;
  const std::size_t awake_before = awake_count_;
  FinishSums sums;
  FourFlags quiet{};
  for (const Index batch : visited_batches_) {
    kernels_->finish(batches_, batch, &visited_[batch * kLanes], {pose_, sharpens, quiet.data()}, scene, sums);
    for (std::size_t i = 0; i < kLanes; ++i)
      if (awake_[batch * kLanes + i]) settle(scene, static_cast<Index>(batch * kLanes + i), quiet[i]);
  }
  if (around_) end_among(scene);
  report.work_J = 1e-6 * govern(scene, sums);
  pose_ = 0;
  if (awake_count_ < awake_before) std::erase_if(awake_places_, [this](Index place) { return !awake_[place]; });
  report.awake = awake_count_;
}

/// Scales the velocities of free slots down if there is more energy than there may be; with exact minimisation and
/// convex springs there never is. Returns the work done, uJ. Where the springs hold more energy than the forces at the
/// end of the step account for, because a slot was dragged far or the minimum was not reached, the work is that
/// difference: at most the energy of dragging first with everything else standing still.
double ImplicitRods::govern(RodScene& scene, const FinishSums& sums) const {
  const double before = start_tie_energy_ + sum(begin_sums_.energy) + around_before_;
  const double work = sum(sums.work) + around_work_;
  const double elastic = tie_energy(scene, 0) + sum(sums.elastic) + around_after_;
  const double free = sum(sums.free), held = sum(sums.held);
  const double allowed = std::max(0.0, std::min(before + work - held, energy_bound_) - elastic);
  if (free > allowed) {
    const double factor = std::sqrt(allowed / free);
    for (const Index batch : visited_batches_) {
      const RodBatch& b = batches_.batches[batch];
      for (std::size_t i = 0; i < kLanes; ++i) {
        if (!visited_[batch * kLanes + i]) continue;
        if (b.hold[i] == Hold::free) scene.velocity[b.slot[i]] *= factor;
        scene.spin[b.slot[i]] *= factor;
      }
    }
  }
  return std::max(work, elastic + held - before);
}

/// Counts quiet steps; brings a slot to rest after enough of them, and skips it from one step later on, after it has
/// been processed at rest.
void ImplicitRods::settle(RodScene& scene, Index place, bool quiet) {
  const double tolerance = scene.options.rest_tolerance;
  const char enough = static_cast<char>(scene.options.rest_steps);
  quiet_steps_[place] = quiet && tolerance > 0 ? static_cast<char>(quiet_steps_[place] + 1) : char{0};
  if (quiet_steps_[place] == enough) {
    const Index slot = batches_.batches[place / kLanes].slot[place % kLanes];
    scene.velocity[slot].setZero();
    scene.spin[slot].setZero();
  } else if (quiet_steps_[place] > enough) {
    awake_[place] = 0;
    --awake_count_;
  }
}

}  // namespace vmesh
