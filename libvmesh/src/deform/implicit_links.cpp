// ImplicitRods: what acts between slots. The tree is eliminated once; what forces between slots change then only takes
// the slots between them and their roots.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"
#include "deform/one_lane.h"

namespace vmesh {
namespace {

/// Links are solved to this fraction of what they are without each other.
constexpr double kLinkTolerance = 1e-6;
constexpr int kMostLinkIterations = 200;

}  // namespace

/// What the surroundings link, and the springs that close loops.
void ImplicitRods::collect_links(const RodScene& scene) {
  links_ = around_->links();
  for (const auto& [slot, node_slot] : scene.tree.ties) {
    const Vec3 gap = position(batches_.place_of_slot[slot], pose_) - position(batches_.place_of_slot[node_slot], pose_);
    for (int axis = 0; axis < 3; ++axis)
      links_.push_back({slot, node_slot, 1, 1, Vec3::Unit(axis), scene.tie_stretch, scene.tie_stretch * gap[axis]});
  }
}

/// The joints for the links, children before parents, and of each link the ends at which it pulls, times the root of
/// its stiffness.
void ImplicitRods::set_joints(const RodScene& scene) {
  joints_.clear();
  link_ends_.clear();
  if (joint_of_place_.empty()) joint_of_place_.assign(visited_.size(), kNone);
  std::vector<Index> places;
  for (const VesselLink& link : links_)
    for (const Index slot : {link.first, link.second})
      for (Index place = batches_.place_of_slot[slot]; joint_of_place_[place] == kNone;
           place = batches_.batches[place / kLanes].parent[place % kLanes]) {
        joint_of_place_[place] = place;
        places.push_back(place);
      }
  std::sort(places.begin(), places.end());
  for (Index i = 0; i < places.size(); ++i) joint_of_place_[places[i]] = i;
  for (const Index place : places) joints_.push_back(joint_at(place));
  for (const VesselLink& link : links_) {
    LinkEnds& ends = link_ends_.emplace_back();
    const auto add = [&](Index slot, double weight) {
      ends.joint[ends.count] = joint_of_place_[batches_.place_of_slot[slot]];
      ends.pull[ends.count++] = weight * std::sqrt(link.stiffness) * link.direction;
    };
    const auto add_both = [&](Index slot, double t, double sign) {
      const Index parent = scene.rods[slot].parent;
      add(slot, sign * (parent == kNone ? 1 : t));
      if (parent != kNone) add(parent, sign * (1 - t));
    };
    add_both(link.first, link.first_t, 1);
    add_both(link.second, link.second_t, -1);
  }
  for (const Index place : places) joint_of_place_[place] = kNone;
}

ImplicitRods::Joint ImplicitRods::joint_at(Index place) {
  const RodBatch& b = batches_.batches[place / kLanes];
  const std::size_t i = place % kLanes;
  const Index load = around_->load_index(b.slot[i]);
  Joint joint;
  joint.place = place;
  joint.hold = b.hold[i];
  if (b.is_root[i] == 0) {
    joint.parent = joint_of_place_[b.parent[i]];
    joint.loaded = load != kNone && loaded_[load].done ? &loaded_[load] : nullptr;
    joint.z = lane_of(b.pose[pose_].frame.z, i);
    joint.lever = b.length[i] * joint.z;
    joint.stretch = b.c_stretch[i], joint.bend = b.c_bend[i], joint.twist = b.c_twist[i];
    joint.reduced = lane_of(b.reduced, i);
    joint.before = joint.loaded ? joint.loaded->gradient : lane_of(b.reduced_gradient, i);
    return joint;
  }
  Mat6 below = stiffness_below(place);
  if (load != kNone) below.topLeftCorner<3, 3>() += around_->loads()[load].uu;
  joint.reduced.setZero();
  if (joint.hold == Hold::free)
    joint.reduced = below.ldlt().solve(Mat6(Mat6::Identity()));
  else if (joint.hold == Hold::fixed)
    joint.reduced.bottomRightCorner<3, 3>() = below.bottomRightCorner<3, 3>().ldlt().solve(Mat3(Mat3::Identity()));
  joint.before = lane_of(b.x, i);
  return joint;
}

/// The force on the parent of a joint, without anything moving there, when `force` acts on the joint; leaves what
/// give_way() needs. With W the spring, D what is below and R what the parent feels of both,
///   W (W + D)^-1 = I - R W^-1.
Vec6 ImplicitRods::passed_on(Joint& joint) {
  if (joint.hold != Hold::free) joint.force.head<3>().setZero();
  if (joint.hold == Hold::clamped) return joint.passed = Vec6::Zero();
  joint.carried = joint.force;
  joint.carried.tail<3>() += joint.lever.cross(Vec3(joint.force.head<3>()));
  if (joint.loaded)
    joint.passed = joint.carried - joint.loaded->own.transpose() * joint.loaded->sum.solve(joint.carried);
  else
    joint.passed = joint.carried - joint.reduced * yielding(joint, joint.carried);
  return joint.passed;
}

/// How a joint's spring gives way to a force: W^-1.
Vec6 ImplicitRods::yielding(const Joint& joint, const Vec6& force) {
  const Vec3 turning = force.tail<3>();
  Vec6 way;
  way << joint.stretch * force.head<3>(),
      joint.bend * turning + (joint.twist - joint.bend) * joint.z.dot(turning) * joint.z;
  return way;
}

/// How much the forces on the joints change their displacements.
void ImplicitRods::give_way() {
  for (Joint& joint : joints_)
    if (joint.parent != kNone) joints_[joint.parent].force += passed_on(joint);
  for (std::size_t k = joints_.size(); k-- > 0;) {
    Joint& joint = joints_[k];
    if (joint.parent == kNone) {
      joint.way = -joint.reduced * joint.force;
      continue;
    }
    const Vec6& at_parent = joints_[joint.parent].way;
    if (joint.loaded)
      joint.way = at_parent - joint.loaded->sum.solve(Vec6(joint.loaded->own * at_parent + joint.carried));
    else
      joint.way = at_parent - yielding(joint, joint.reduced * at_parent + joint.passed);
    joint.way.head<3>() -= joint.lever.cross(Vec3(joint.way.tail<3>()));
    if (joint.hold != Hold::free) joint.way.head<3>().setZero();
    if (joint.hold == Hold::clamped) joint.way.setZero();
  }
}

void ImplicitRods::pull_links(const Eigen::VectorXd& force) {
  for (Joint& joint : joints_) joint.force.setZero();
  for (std::size_t i = 0; i < link_ends_.size(); ++i)
    for (std::size_t end = 0; end < link_ends_[i].count; ++end)
      joints_[link_ends_[i].joint[end]].force.head<3>() +=
          force[static_cast<Eigen::Index>(i)] * link_ends_[i].pull[end];
}

/// How far the links open while their ends move by `way` of a joint, times the roots of their stiffnesses.
template <class Way>
void ImplicitRods::open_links(const Way& way, Eigen::VectorXd& opening) const {
  for (std::size_t i = 0; i < link_ends_.size(); ++i) {
    double open = 0;
    for (std::size_t end = 0; end < link_ends_[i].count; ++end)
      open += link_ends_[i].pull[end].dot(way(joints_[link_ends_[i].joint[end]]));
    opening[static_cast<Eigen::Index>(i)] = open;
  }
}

/// The force F in a link of stiffness k follows from F = slope + k opening(F); opening() is affine in the forces. By
/// conjugate gradients for F over the root of k: as many equations as there are links.
void ImplicitRods::solve_links(const RodScene& scene, const RodMove* then) {
  collect_links(scene);
  if (!eliminated_) eliminate_all();
  set_joints(scene);
  substitute_all(scene, nullptr);
  const auto count = static_cast<Eigen::Index>(links_.size());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(count), image(count), residual(count);
  open_links(
      [this](const Joint& joint) {
        return lane_of(batches_.batches[joint.place / kLanes].x.linear, joint.place % kLanes);
      },
      residual);
  for (std::size_t i = 0; i < links_.size(); ++i)
    residual[static_cast<Eigen::Index>(i)] += links_[i].slope / std::sqrt(links_[i].stiffness);
  Eigen::VectorXd direction = residual;
  double norm = residual.squaredNorm();
  const double enough = kLinkTolerance * kLinkTolerance * norm;
  for (int i = 0; i < kMostLinkIterations && norm > enough; ++i) {
    pull_links(direction);
    give_way();
    open_links([](const Joint& joint) -> Vec3 { return joint.way.head<3>(); }, image);
    image = direction - image;
    const double curvature = direction.dot(image);
    if (!(curvature > 0)) break;
    force += norm / curvature * direction;
    residual -= norm / curvature * image;
    const double next = residual.squaredNorm();
    direction = residual + next / norm * direction;
    norm = next;
  }
  pull_links(force);
  give_way();
  let_go_on(1);
  substitute_all(scene, then);
  let_go_on(0);
  eliminated_ = !then;
}

/// Adds the effect of the joints' forces, or 0 of it, to what elimination has left. The solution at roots stays until
/// restore_roots().
void ImplicitRods::let_go_on(double part) {
  for (const Joint& joint : joints_) {
    RodBatch& b = batches_.batches[joint.place / kLanes];
    const std::size_t i = joint.place % kLanes;
    if (joint.parent == kNone) {
      if (part == 0) continue;
      moved_roots_.emplace_back(joint.place, joint.before);
      set_lane_of(b.x, i, joint.before + part * joint.way);
    } else if (joint.loaded) {
      joint.loaded->gradient = joint.before + part * joint.carried;
    } else {
      set_lane_of(b.reduced_gradient, i, joint.before + part * joint.passed);
    }
  }
}

/// To the solution without links, which elimination found.
void ImplicitRods::restore_roots() {
  for (const auto& [place, x] : moved_roots_) set_lane_of(batches_.batches[place / kLanes].x, place % kLanes, x);
  moved_roots_.clear();
}

}  // namespace vmesh
