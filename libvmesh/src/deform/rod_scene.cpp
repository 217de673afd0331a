#include "deform/rod_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vmesh/core/error.h"

#include "deform/short_segment.h"

namespace vmesh {
namespace {

constexpr double kMilli = 1e3;  // N to mN
/// Springs that close loops are this much stiffer than the stiffest segment next to them, to keep the loop closed.
constexpr double kTieFactor = 100;

void check(const SegmentProperties& p, Index segment) {
  const auto fail = [segment](const char* what) {
    throw InvalidInput("segment " + std::to_string(segment) + ": its " + what);
  };
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(p.stretch_N)) fail("stiffness against stretch must be finite and above 0");
  if (!positive(p.bend_N_mm2)) fail("stiffness against bending must be finite and above 0");
  if (!positive(p.twist_N_mm2)) fail("stiffness against twist must be finite and above 0");
  if (p.twist_N_mm2 > 2 * p.bend_N_mm2) fail("stiffness against twist must be at most twice that against bending");
  if (!positive(p.mass_kg)) fail("mass must be finite and above 0");
  if (!positive(p.inertia_kg_mm2)) fail("inertia must be finite and above 0");
  if (!(std::isfinite(p.damping_s) && p.damping_s >= 0)) fail("damping time must be finite and at least 0");
  if (!(std::isfinite(p.squeeze_N_mm2) && p.squeeze_N_mm2 >= 0)) fail("squeeze stiffness must be finite, at least 0");
}

double length_of(const RodTree& tree, Index j) { return regular_length(tree.length[j], tree.radius[j]); }

/// Bending compliance between the midpoints of two consecutive segments, or between a root's frame and the midpoint of
/// its segment. Twist in the same proportion.
void set_angular_springs(const RodTree& tree, const std::vector<SegmentProperties>& properties, Index j, Rod& rod) {
  const auto half_segment = [&](Index slot, double SegmentProperties::*stiffness) {
    if (tree.segment[slot] == kNone) return 0.0;
    return 0.5 * length_of(tree, slot) / (kMilli * properties[tree.segment[slot]].*stiffness);
  };
  const auto joined = [&](double SegmentProperties::*stiffness) {
    return 1 / (half_segment(tree.parent[j], stiffness) + half_segment(j, stiffness));
  };
  rod.tip_xy = 0.5 * joined(&SegmentProperties::twist_N_mm2);
  rod.tip_z = std::max(0.0, joined(&SegmentProperties::bend_N_mm2) - rod.tip_xy);
}

void set_springs(const RodTree& tree, const std::vector<SegmentProperties>& properties, RodScene& scene) {
  for (Index j = 0; j < tree.size(); ++j) {
    Rod& rod = scene.rods[j];
    rod.parent = tree.parent[j];
    rod.radius = tree.radius[j];
    rod.turn = tree.turn[j];
    if (rod.parent == kNone) continue;
    const SegmentProperties& p = properties[tree.segment[j]];
    rod.length = tree.length[j];
    rod.stretch = kMilli * p.stretch_N / length_of(tree, j);
    rod.damping_s = p.damping_s;
    rod.inertia = p.inertia_kg_mm2;
    rod.mass += 0.5 * p.mass_kg;
    scene.rods[rod.parent].mass += 0.5 * p.mass_kg;
    set_angular_springs(tree, properties, j, rod);
  }
}

/// A root's frame represents half of its first segment; an isolated node is a ball of water.
void set_root_inertia(RodScene& scene) {
  constexpr double kWater_kg_mm3 = 1e-6;
  for (Index j = 0; j < scene.size(); ++j) {
    Rod& rod = scene.rods[j];
    if (rod.parent != kNone) continue;
    if (rod.first_child != kNone) {
      rod.inertia = 0.5 * scene.rods[rod.first_child].inertia;
    } else {
      rod.mass = 4.0 / 3 * M_PI * kWater_kg_mm3 * rod.radius * rod.radius * rod.radius;
      rod.inertia = 0.2 * rod.mass * rod.radius * rod.radius;
    }
  }
}

void link_children(RodScene& scene) {
  for (Index j = static_cast<Index>(scene.size()); j-- > 0;) {
    Rod& rod = scene.rods[j];
    if (rod.parent == kNone) continue;
    rod.next_sibling = scene.rods[rod.parent].first_child;
    scene.rods[rod.parent].first_child = j;
  }
}

void set_ties(RodScene& scene) {
  for (const auto& [slot, node_slot] : scene.tree.ties)
    scene.tie_stretch = std::max(scene.tie_stretch, kTieFactor * scene.rods[slot].stretch);
}

}  // namespace

RodScene make_rod_scene(const Centerline& centerline, const std::vector<SegmentProperties>& properties,
                        const SimulationOptions& options, std::span<const Index> roots) {
  if (properties.size() != centerline.segments().size())
    throw InvalidInput("there are " + std::to_string(properties.size()) + " segment properties for " +
                       std::to_string(centerline.segments().size()) + " segments; give one each");
  for (Index s = 0; s < properties.size(); ++s) check(properties[s], s);
  RodScene scene;
  scene.tree = make_rod_tree(centerline, roots);
  scene.options = options;
  const std::size_t n = scene.tree.size();
  scene.rods.resize(n);
  set_springs(scene.tree, properties, scene);
  link_children(scene);
  set_root_inertia(scene);
  set_ties(scene);
  scene.pose = rest_pose(scene.tree);
  scene.velocity.assign(n, Vec3::Zero());
  scene.spin = scene.force = scene.torque = scene.velocity;
  scene.hold.assign(n, Hold::free);
  scene.target = scene.pose.position;
  scene.moved.assign(n, 1);
  return scene;
}

double elastic_energy(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  if (rod.parent == kNone) return 0;
  const Mat3 apart = scene.pose.frame[rod.parent] * rod.turn - scene.pose.frame[j];
  return 0.5 * (rod.stretch * misfit(scene, j).squaredNorm() +
                rod.tip_xy * (apart.col(0).squaredNorm() + apart.col(1).squaredNorm()) +
                rod.tip_z * apart.col(2).squaredNorm());
}

double kinetic_energy(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  const double axial = scene.spin[j].dot(scene.pose.frame[j].col(2));
  return 0.5 *
         (rod.mass * scene.velocity[j].squaredNorm() + rod.inertia * (scene.spin[j].squaredNorm() + axial * axial));
}

double tie_energy(const RodScene& scene) {
  double sum = 0;
  for (const auto& [slot, node_slot] : scene.tree.ties)
    sum += (scene.pose.position[slot] - scene.pose.position[node_slot]).squaredNorm();
  return 0.5 * scene.tie_stretch * sum;
}

double elastic_energy(const RodScene& scene) {
  double sum = 0;
  for (Index j = 0; j < scene.size(); ++j) sum += elastic_energy(scene, j);
  return sum + tie_energy(scene);
}

double kinetic_energy(const RodScene& scene) {
  double sum = 0;
  for (Index j = 0; j < scene.size(); ++j) sum += kinetic_energy(scene, j);
  return sum;
}

}  // namespace vmesh
