// ImplicitRods: slots that something acts on in the solution on the tree, and what acts between slots.
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Links are solved to this fraction of what they are without each other.
constexpr double kLinkTolerance = 1e-5;
constexpr int kMostLinkIterations = 100;

Vec3 lane(const Lanes3& v, std::size_t i) { return {v.x[i], v.y[i], v.z[i]}; }
Vec6 lane(const LanesSpatial& v, std::size_t i) {
  Vec6 r;
  r << lane(v.linear, i), lane(v.angular, i);
  return r;
}
void add_lane(Lanes3& to, std::size_t i, const Vec3& v) { to.x[i] += v.x(), to.y[i] += v.y(), to.z[i] += v.z(); }
void set_lane_of(Lanes3& to, std::size_t i, const Vec3& v) { to.x[i] = v.x(), to.y[i] = v.y(), to.z[i] = v.z(); }
void set_lane_of(LanesSpatial& to, std::size_t i, const Vec6& v) {
  set_lane_of(to.linear, i, v.head<3>());
  set_lane_of(to.angular, i, v.tail<3>());
}

Mat6 lane(const LanesMatrix& m, std::size_t i) {
  Mat6 r;
  for (int row = 0, k = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column, ++k) r(row, column) = r(column, row) = m.entries[k][i];
  return r;
}
void set_lane_of(LanesMatrix& to, std::size_t i, const Mat6& m) {
  for (int row = 0, k = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column, ++k) to.entries[k][i] = m(row, column);
}

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
  around_->linearise(part);
  const std::size_t count = around_->loaded_slots().size();
  if (loaded_.size() < count) loaded_.resize(count);
  for (std::size_t i = 0; i < count; ++i) loaded_[i].done = false;
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
    Mat6 reduced = lane(b.reduced, i);
    reduced.topLeftCorner<3, 3>() += load.pp;
    set_lane_of(b.reduced, i, reduced);
    add_lane(b.reduced_gradient.linear, i, load.gradient_p + load.pu * pull(place, pose_));
    return;
  }
  const Vec3 z = lane(b.pose[pose_].frame.z, i);
  Mat6 d = Mat6::Zero();
  Vec6 f = lane(b.gradient, i);
  d.topLeftCorner<3, 3>() = b.step_mass[i] * Mat3::Identity() + load.uu;
  d.bottomRightCorner<3, 3>() = about(z, b.step_inertia[i] + b.taut[i], 2 * b.step_inertia[i]);
  f.head<3>() += load.gradient_u;
  for (Index rank = 0; rank < b.child_ranks; ++rank) {
    const Index child = batches_.children[b.first_children + rank][i];
    const RodBatch& c = batches_.batches[child / kLanes];
    d += lane(c.reduced, child % kLanes);
    f += lane(c.reduced_gradient, child % kLanes);
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
  Vec6 gradient =
      loaded.gradient - loaded.own.transpose() * loaded.sum.solve(Vec6(loaded.gradient + lane(b.spring_gradient, i)));
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
    const Vec6 at_parent = lane(batches_.batches[b.parent[i] / kLanes].x, b.parent[i] % kLanes);
    const Vec6 apart = -loaded.sum.solve(Vec6(loaded.own * at_parent + loaded.gradient + lane(b.spring_gradient, i)));
    Vec6 x = end_of(b.length[i] * lane(b.pose[pose_].frame.z, i)) * (at_parent + apart);
    const double tolerance = scene.options.rest_tolerance;
    const bool hardly = x.head<3>().norm() <= tolerance * b.radius[i] && x.tail<3>().norm() <= tolerance;
    if ((hardly && rests[i]) || !x.allFinite()) x.setZero();
    set_lane_of(b.x, i, x);
  }
}

/// What the surroundings link, and the springs that close loops.
void ImplicitRods::collect_links(const RodScene& scene) {
  links_ = around_->links();
  for (const auto& [slot, node_slot] : scene.tree.ties) {
    const Vec3 gap = position(batches_.place_of_slot[slot], pose_) - position(batches_.place_of_slot[node_slot], pose_);
    for (int axis = 0; axis < 3; ++axis)
      links_.push_back({slot, node_slot, 1, 1, Vec3::Unit(axis), scene.tie_stretch, scene.tie_stretch * gap[axis]});
  }
}

/// The solution x with forces along the links, each over the root of its stiffness, and how far it opens them, times
/// that root.
void ImplicitRods::solve_linked(const RodScene& scene, const Eigen::VectorXd& force, Eigen::VectorXd& opening,
                                const RodMove* then) {
  const auto for_ends = [&](const VesselLink& link, auto visit) {
    const auto of_slot = [&](Index slot, double t, double sign) {
      const Index parent = scene.rods[slot].parent;
      visit(batches_.place_of_slot[slot], sign * (parent == kNone ? 1 : t));
      if (parent != kNone) visit(batches_.place_of_slot[parent], sign * (1 - t));
    };
    of_slot(link.first, link.first_t, 1);
    of_slot(link.second, link.second_t, -1);
  };
  std::vector<std::pair<Index, Vec3>> kept;
  for (std::size_t i = 0; i < links_.size(); ++i)
    for_ends(links_[i], [&](Index place, double weight) {
      Lanes3& g = batches_.batches[place / kLanes].gradient.linear;
      kept.emplace_back(place, lane(g, place % kLanes));
      add_lane(g, place % kLanes,
               weight * std::sqrt(links_[i].stiffness) * force[static_cast<int>(i)] * links_[i].direction);
    });
  eliminated_ = false;
  for (Loaded& loaded : loaded_) loaded.done = false;
  solve_tree(scene, then);
  if (then) return;  // moving evaluates the gradients anew
  for (std::size_t i = kept.size(); i-- > 0;)
    set_lane_of(batches_.batches[kept[i].first / kLanes].gradient.linear, kept[i].first % kLanes, kept[i].second);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    double open = 0;
    for_ends(links_[i], [&](Index place, double weight) {
      open += weight * links_[i].direction.dot(lane(batches_.batches[place / kLanes].x.linear, place % kLanes));
    });
    opening[static_cast<int>(i)] = std::sqrt(links_[i].stiffness) * open;
  }
}

/// The force F in a link of stiffness k follows from F = slope + k opening(F); opening() is affine in the forces. By
/// conjugate gradients for F over the root of k: as many equations as there are links.
void ImplicitRods::solve_links(const RodScene& scene, const RodMove* then) {
  collect_links(scene);
  const auto count = static_cast<Eigen::Index>(links_.size());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(count), unlinked(count), image(count), residual(count);
  solve_linked(scene, force, unlinked, nullptr);
  for (Eigen::Index i = 0; i < count; ++i)
    residual[i] = unlinked[i] +
                  links_[static_cast<std::size_t>(i)].slope / std::sqrt(links_[static_cast<std::size_t>(i)].stiffness);
  Eigen::VectorXd direction = residual;
  double norm = residual.squaredNorm();
  const double enough = kLinkTolerance * kLinkTolerance * norm;
  for (int i = 0; i < kMostLinkIterations && norm > enough; ++i) {
    solve_linked(scene, direction, image, nullptr);
    image = direction + unlinked - image;
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) break;
    force += norm / curvature * direction;
    residual -= norm / curvature * image;
    const double next = residual.squaredNorm();
    direction = residual + next / norm * direction;
    norm = next;
  }
  solve_linked(scene, force, image, then);
}

}  // namespace vmesh
