// ImplicitRods: the solution of one Gauss-Newton iteration on the tree, and with the springs that close loops.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

/// Loops are closed to this fraction of their opening without springs.
constexpr double kTieTolerance = 1e-6;
constexpr int kMostTieIterations = 60;

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

void add(std::vector<Vec3>& a, double factor, const std::vector<Vec3>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

bool is_zero(const LanesSpatial& x, std::size_t lane) {
  const auto zero = [lane](const Lanes3& v) { return v.x[lane] == 0 && v.y[lane] == 0 && v.z[lane] == 0; };
  return zero(x.linear) && zero(x.angular);
}

}  // namespace

void ImplicitRods::solve(const RodScene& scene, const RodMove* then) {
  restore_roots();
  if (around_ && !around_->links().empty())
    solve_links(scene, then);
  else if (scene.tree.ties.empty())
    solve_tree(scene, then);
  else
    solve_ties(scene, then);
}

void ImplicitRods::eliminate(Index batch) {
  kernels_->eliminate(batches_, batch, pose_, &visited_[batch * kLanes]);
  if (around_) eliminate_loaded(batch);
}

void ImplicitRods::solve_tree(const RodScene& scene, const RodMove* then) {
  if (!eliminated_) eliminate_all();
  eliminated_ = false;
  if (all_visited_)
    substitute_all(scene, then);
  else
    solve_growing(scene, then);
}

void ImplicitRods::eliminate_all() {
  for (const Index batch : visited_batches_) eliminate(batch);
}

void ImplicitRods::substitute_all(const RodScene& scene, const RodMove* then) {
  for (std::size_t i = visited_batches_.size(); i-- > 0;) solve_batch(scene, visited_batches_[i], then);
}

/// From the root outwards. Slots that move wake their children, whose batches come later but may not be listed yet.
void ImplicitRods::solve_growing(const RodScene& scene, const RodMove* then) {
  const std::size_t listed = visited_batches_.size();
  grown_batches_.clear();
  for (std::size_t i = listed; i > 0 || !grown_batches_.empty();) {
    Index batch = 0;
    if (grown_batches_.empty() || (i > 0 && visited_batches_[i - 1] > grown_batches_.front())) {
      batch = visited_batches_[--i];
    } else {
      batch = grown_batches_.front();
      std::pop_heap(grown_batches_.begin(), grown_batches_.end());
      grown_batches_.pop_back();
      visited_batches_.push_back(batch);
    }
    char* fresh = &fresh_[batch * kLanes];
    if (std::any_of(fresh, fresh + kLanes, [](char f) { return f != 0; })) {
      begin_batch(scene, batch, fresh);
      std::fill_n(fresh, kLanes, char{0});
    }
    solve_batch(scene, batch, then);
    wake_children(batch);
  }
  if (visited_batches_.size() > listed) std::sort(visited_batches_.begin(), visited_batches_.end());
}

void ImplicitRods::solve_batch(const RodScene& scene, Index batch, const RodMove* then) {
  const char* active = &visited_[batch * kLanes];
  const FourFlags rests = resting(scene, batch);
  kernels_->substitute(batches_, batch, pose_, active, rests.data(), scene.options.rest_tolerance);
  if (around_) substitute_loaded(scene, batch, rests);
  if (then) kernels_->move(batches_, batch, active, *then, move_sums_);
}

/// Which slots of a batch are at rest; they remain so unless they move by more than the tolerance.
ImplicitRods::FourFlags ImplicitRods::resting(const RodScene& scene, Index batch) const {
  FourFlags rests{};
  for (std::size_t i = 0; i < kLanes; ++i) {
    const std::size_t place = batch * kLanes + i;
    rests[i] = !awake_[place] || quiet_steps_[place] >= scene.options.rest_steps;
  }
  return rests;
}

/// Wakes the children of slots that move.
void ImplicitRods::wake_children(Index batch) {
  const RodBatch& b = batches_.batches[batch];
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Index place = static_cast<Index>(batch * kLanes + i);
    if (!visited_[place] || is_zero(b.x, i)) continue;
    if (!awake_[place]) wake_place(place);
    for_children(place, [this](Index child) {
      if (visited_[child]) return;
      visited_[child] = fresh_[child] = 1;
      const auto other = static_cast<Index>(child / kLanes);
      if (listed_[other]) return;
      listed_[other] = 1;
      grown_batches_.push_back(other);
      std::push_heap(grown_batches_.begin(), grown_batches_.end());
    });
  }
}

/// The solution x with `load` pulling on the ties, and how far it opens them.
void ImplicitRods::solve_loaded(const RodScene& scene, const std::vector<Vec3>& load, std::vector<Vec3>& opening,
                                const RodMove* then) {
  const auto& ties = scene.tree.ties;
  const auto lane_of = [this](Index slot, auto field) -> Vec3 {
    const Index place = batches_.place_of_slot[slot];
    const Lanes3& v = field(batches_.batches[place / kLanes]).linear;
    return {v.x[place % kLanes], v.y[place % kLanes], v.z[place % kLanes]};
  };
  const auto pull = [&](Index slot, const Vec3& by) {
    const Index place = batches_.place_of_slot[slot];
    Lanes3& g = batches_.batches[place / kLanes].gradient.linear;
    g.x[place % kLanes] += by.x(), g.y[place % kLanes] += by.y(), g.z[place % kLanes] += by.z();
  };
  const auto pull_all = [&](double sign) {
    for (std::size_t i = 0; i < ties.size(); ++i)
      pull(ties[i].slot, sign * load[i]), pull(ties[i].node_slot, -sign * load[i]);
  };
  pull_all(1);
  eliminated_ = false;
  solve_tree(scene, then);
  if (!then) pull_all(-1);  // moving evaluates the gradients anew
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const auto x = [](const RodBatch& b) -> const LanesSpatial& { return b.x; };
    opening[i] = lane_of(ties[i].slot, x) - lane_of(ties[i].node_slot, x);
  }
}

/// The forces F in the ties follow from F / k = gap + opening(F), by conjugate gradients: opening() is affine in F,
/// with as many equations as there are loops.
void ImplicitRods::solve_ties(const RodScene& scene, const RodMove* then) {
  const auto& ties = scene.tree.ties;
  for (Vec3& f : tie_load_) f.setZero();
  solve_loaded(scene, tie_load_, tie_opening_, nullptr);
  for (std::size_t i = 0; i < ties.size(); ++i)
    tie_residual_[i] = position(batches_.place_of_slot[ties[i].slot], pose_) -
                       position(batches_.place_of_slot[ties[i].node_slot], pose_) + tie_opening_[i];
  tie_direction_ = tie_residual_;
  double norm = dot(tie_residual_, tie_residual_);
  const double enough = kTieTolerance * kTieTolerance * norm;
  for (int i = 0; i < kMostTieIterations && norm > enough; ++i) {
    solve_loaded(scene, tie_direction_, tie_image_, nullptr);
    for (std::size_t t = 0; t < ties.size(); ++t)
      tie_image_[t] = tie_opening_[t] - tie_image_[t] + tie_direction_[t] / scene.tie_stretch;
    const double step = norm / dot(tie_direction_, tie_image_);
    add(tie_load_, step, tie_direction_);
    add(tie_residual_, -step, tie_image_);
    const double next = dot(tie_residual_, tie_residual_);
    for (std::size_t t = 0; t < ties.size(); ++t)
      tie_direction_[t] = tie_residual_[t] + next / norm * tie_direction_[t];
    norm = next;
  }
  solve_loaded(scene, tie_load_, tie_image_, then);
}

}  // namespace vmesh
