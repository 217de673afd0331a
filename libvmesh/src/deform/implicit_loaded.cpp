// ImplicitRods: slots that something acts on in the solution on the tree.
#include "deform/implicit_rods.h"
#include "deform/one_lane.h"

namespace vmesh {
namespace {

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Mat3 about(const Vec3& z, double transverse, double axial) {
  return transverse * Mat3::Identity() + (axial - transverse) * z * z.transpose();
}

/// Stiffness of the spring to the parent.
Mat6 spring_of(const RodBatch& b, std::size_t i, const Vec3& z) {
  Mat6 w = Mat6::Zero();
  w.topLeftCorner<3, 3>() = b.w_stretch[i] * Mat3::Identity();
  w.bottomRightCorner<3, 3>() = about(z, b.w_bend[i], b.w_twist[i]);
  return w;
}

/// x of y = (x.linear + lever x x.angular, x.angular).
Mat6 end_of(const Vec3& lever) {
  Mat6 t = Mat6::Identity();
  t.topRightCorner<3, 3>() = -cross_matrix(lever);
  return t;
}

}  // namespace

void ImplicitRods::linearise(double part) {
  around_->forget_stops();
  around_->linearise(part);
  take_loads();
}

/// What was eliminated with other loads is so no longer.
void ImplicitRods::take_loads() {
  const std::size_t count = around_->loaded_slots().size();
  if (loaded_.size() < count) loaded_.resize(count);
  for (Loaded& loaded : loaded_) loaded.done = false;
  eliminated_ = false;
}

/// Of a slot's inertia and of everything below it.
Mat6 ImplicitRods::stiffness_below(Index place) const {
  const RodBatch& b = batches_.batches[place / kLanes];
  const std::size_t i = place % kLanes;
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>() = b.step_mass[i] * Mat3::Identity();
  d.bottomRightCorner<3, 3>() =
      about(lane_of(b.pose[pose_].frame.z, i), b.step_inertia[i] + b.taut[i], 2 * b.step_inertia[i]);
  for (Index rank = 0; rank < b.child_ranks; ++rank) {
    const Index child = batches_.children[b.first_children + rank][i];
    d += lane_of(batches_.batches[child / kLanes].reduced, child % kLanes);
  }
  return d;
}

void ImplicitRods::eliminate_loaded(Index batch) {
  if (around_->loaded_slots().empty()) return;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Index place = static_cast<Index>(batch * kLanes + i);
    if (!visited_[place]) continue;
    const Index load = around_->load_index(batches_.batches[batch].slot[i]);
    if (load != kNone) eliminate_loaded(around_->loads()[load], place, loaded_[load]);
  }
}

/// With x of the slot, y = J x as in RodBatch, s = y - x_p, D its own stiffness and that of its children, f their
/// gradient, both of y, and X the load's stiffness between y and x_p, the energy to minimise over s is
///   1/2 y^T D y + f y + 1/2 s^T W s + w s + y^T X x_p + what only x_p decides.
/// So s = -(D + W)^-1 ((D + X) x_p + f + w), and nothing is subtracted from W, which may be much stiffer.
void ImplicitRods::eliminate_loaded(const SegmentLoad& load, Index place, Loaded& loaded) {
  RodBatch& b = batches_.batches[place / kLanes];
  const std::size_t i = place % kLanes;
  if (b.hold[i] != Hold::free) {
    if (b.is_root[i] != 0) return;
    Mat6 reduced = lane_of(b.reduced, i);
    reduced.topLeftCorner<3, 3>() += load.pp;
    set_lane_of(b.reduced, i, reduced);
    add_lane(b.reduced_gradient.linear, i, load.gradient_p + load.pu * pull(place, pose_));
    return;
  }
  const Vec3 z = lane_of(b.pose[pose_].frame.z, i);
  Mat6 d = stiffness_below(place);
  d.topLeftCorner<3, 3>() += load.uu;
  Vec6 f = lane_of(b.gradient, i);
  f.head<3>() += load.gradient_u;
  for (Index rank = 0; rank < b.child_ranks; ++rank) {
    const Index child = batches_.children[b.first_children + rank][i];
    f += lane_of(batches_.batches[child / kLanes].reduced_gradient, child % kLanes);
  }
  if (b.is_root[i] != 0) {
    set_lane_of(b.x, i, -d.ldlt().solve(f));
    return;
  }
  const Mat6 end = end_of(b.length[i] * z);
  const Mat6 own = end.transpose() * d * end;
  loaded.gradient = end.transpose() * f;
  Mat6 mixed = Mat6::Zero();
  mixed.leftCols<3>() = end.topRows<3>().transpose() * load.pu.transpose();
  loaded.own = own + mixed;
  loaded.sum.compute(own + spring_of(b, i, z));
  Mat6 reduced = own + mixed + mixed.transpose() - loaded.own.transpose() * loaded.sum.solve(loaded.own);
  reduced.topLeftCorner<3, 3>() += load.pp;
  Vec6 gradient = loaded.gradient -
                  loaded.own.transpose() * loaded.sum.solve(Vec6(loaded.gradient + lane_of(b.spring_gradient, i)));
  gradient.head<3>() += load.gradient_p;
  set_lane_of(b.reduced, i, reduced);
  set_lane_of(b.reduced_gradient, i, gradient);
  loaded.done = true;
}

void ImplicitRods::substitute_loaded(const RodScene& scene, Index batch, const FourFlags& rests) {
  if (around_->loaded_slots().empty()) return;
  RodBatch& b = batches_.batches[batch];
  for (std::size_t i = 0; i < kLanes; ++i) {
    if (!visited_[batch * kLanes + i] || b.hold[i] != Hold::free || b.is_root[i] != 0) continue;
    const Index load = around_->load_index(b.slot[i]);
    if (load == kNone || !loaded_[load].done) continue;
    const Loaded& loaded = loaded_[load];
    const Vec6 at_parent = lane_of(batches_.batches[b.parent[i] / kLanes].x, b.parent[i] % kLanes);
    const Vec6 apart =
        -loaded.sum.solve(Vec6(loaded.own * at_parent + loaded.gradient + lane_of(b.spring_gradient, i)));
    Vec6 x = end_of(b.length[i] * lane_of(b.pose[pose_].frame.z, i)) * (at_parent + apart);
    const double tolerance = scene.options.rest_tolerance;
    const bool hardly = x.head<3>().norm() <= tolerance * b.radius[i] && x.tail<3>().norm() <= tolerance;
    if ((hardly && rests[i]) || !x.allFinite()) x.setZero();
    set_lane_of(b.x, i, x);
  }
}

}  // namespace vmesh
