#include <gtest/gtest.h>

#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

/// `tree` scaled by `factor`, with a few nodes moved almost onto their neighbours.
Centerline scaled(const Centerline& tree, double factor, Draw& draw) {
  std::vector<CenterlineNode> nodes = tree.nodes();
  for (CenterlineNode& node : nodes) {
    node.position *= factor;
    node.radius *= factor;
  }
  for (int i = 0; i < 3; ++i) {
    const CenterlineSegment& s = tree.segment(draw.below(static_cast<Index>(tree.segments().size())));
    nodes[s.b].position = nodes[s.a].position + 1e-7 * nodes[s.b].radius * draw.direction();
  }
  return {nodes, tree.segments()};
}

struct Case {
  double young_Pa, step_s, radius_mm;
};

/// A tree under extreme loads, and a bound on the energy that a step can add: that of all loads acting as an impulse at
/// its start, and of dragging with everything else standing still.
class Victim {
 public:
  Victim(const Case& c, Draw& draw)
      : step_s_(c.step_s),
        tree_(tree_of(c, draw)),
        material_{.young_Pa = c.young_Pa, .damping_s = 0.01 * draw.below(2)},
        properties_(segment_properties(tree_, material_)),
        simulation(tree_, properties_, options_of(c)) {
    if (draw.chance(0.7)) simulation.clamp(0);
  }

  Index count() const { return static_cast<Index>(tree_.nodes().size()); }
  Index tip() const { return count() - 1; }

  void pull_down() {
    simulation.set_gravity(Vec3(0, 0, -9810));
    double mass = 0;
    for (const SegmentProperties& p : properties_) mass += p.mass_kg;
    blow_J_ += 0.5e-6 * mass * std::pow(step_s_ * 9810, 2);
  }

  void push(Index node, const Vec3& force_N) {
    simulation.set_force(node, force_N);
    double mass = 0;
    for (const Index s : tree_.incident_segments(node)) mass += 0.5 * properties_[s].mass_kg;
    blow_J_ += 0.5 * std::pow(step_s_ * force_N.norm(), 2) / mass;
  }

  void drag(const Vec3& by) {
    const Index slot = simulation.tree().slot_of_node[tip()], parent = simulation.tree().parent[slot];
    const SegmentProperties& p = properties_[simulation.tree().segment[slot]];
    const Pose& pose = simulation.pose();
    const double length = simulation.tree().length[slot], radius = simulation.tree().radius[slot];
    const Vec3 misfit = pose.position[slot] - pose.position[parent] - length * pose.frame[slot].col(2);
    const double stretch = p.stretch_N / std::max(length, 1e-3 * radius);
    const double dashpot = material_.damping_s / step_s_;
    drag_J_ = 0.5e-3 * stretch * ((misfit + by).squaredNorm() + dashpot * by.squaredNorm()) +
              0.25e-6 * p.mass_kg * by.squaredNorm() / (step_s_ * step_s_);
    simulation.drag(tip(), simulation.position(tip()) + by);
  }

  double most_after_step_J() const {
    const double moving = std::sqrt(simulation.kinetic_energy_J()) + std::sqrt(2 * blow_J_);
    return simulation.elastic_energy_J() + drag_J_ + moving * moving;
  }

  void expect_sound() const {
    for (Index n = 0; n < count(); ++n) ASSERT_TRUE(simulation.position(n).allFinite()) << n;
    for (const Mat3& frame : simulation.pose().frame)
      ASSERT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-12);
  }

  void forget_drag() { drag_J_ = 0; }

 private:
  static Centerline tree_of(const Case& c, Draw& draw) {
    SyntheticTreeOptions shape;
    shape.vertices = 40;
    return scaled(synthetic_tree(shape), c.radius_mm / 6.5, draw);
  }
  static SimulationOptions options_of(const Case& c) {
    SimulationOptions options;
    options.step_s = c.step_s;
    return options;
  }

  double step_s_;
  Centerline tree_;
  Material material_;
  std::vector<SegmentProperties> properties_;
  double blow_J_ = 0, drag_J_ = 0;

 public:
  CenterlineSimulation simulation;
};

/// Kicks, then gravity and forces, then a tip dragged at 50 m/s and let go.
void torment(const Case& c, Draw& draw) {
  Victim victim(c, draw);
  for (int i = 0; i < 5; ++i) victim.simulation.set_velocity(1 + draw.below(victim.tip()), draw.in_cube(1e4));
  const Vec3 towards = draw.direction();
  double work = energy_J(victim.simulation), most = work;
  for (int i = 0; i < 60; ++i) {
    if (i == 10) victim.pull_down();
    if (i == 20) victim.push(draw.below(victim.count()), draw.in_cube(1));
    if (i >= 30 && i < 40) victim.drag(50e3 * c.step_s * towards);
    if (i == 40) victim.simulation.release(victim.tip());
    const double bound = victim.most_after_step_J();
    victim.forget_drag();
    const StepReport report = victim.simulation.step();
    ASSERT_LE(i < 10 ? report.work_J : 0, 1e-12 * most) << i;
    work += report.work_J;
    most = std::max(most, std::abs(work));
    const double energy = energy_J(victim.simulation);
    ASSERT_TRUE(std::isfinite(energy)) << i;
    victim.expect_sound();
    // Rounding of sums of a hundred terms, of which positions far from the origin leave fewer digits.
    ASSERT_LE(energy, work + 1e-9 * most) << i;
    ASSERT_LE(energy, bound + 1e-9 * std::max(most, bound)) << i;
  }
}

TEST(Stability, NoEnergyFromNowhere) {
  Draw draw(7);
  for (const double young_Pa : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11})
    for (const double step_s : {1e-4, 1e-3, 5e-3, 2e-2, 1e-1})
      for (const double radius_mm : {1e-3, 0.1, 1.0, 30.0, 1e3}) {
        SCOPED_TRACE(std::to_string(young_Pa) + " Pa, " + std::to_string(step_s) + " s, " + std::to_string(radius_mm) +
                     " mm");
        torment({young_Pa, step_s, radius_mm}, draw);
      }
}

}  // namespace
}  // namespace vmesh::testing
