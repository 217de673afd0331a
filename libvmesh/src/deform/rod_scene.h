#pragma once

#include <vector>

#include "vmesh/deform/simulation.h"

namespace vmesh {

/// One slot's springs and masses. Units: mm, s, kg; so forces are in mN and energies in uJ.
struct Rod {
  Index parent = kNone, first_child = kNone, next_sibling = kNone;
  double length = 0;     ///< to the parent, at rest
  double stretch = 0;    ///< spring from the parent, mN/mm
  double tip_xy = 0;     ///< angular springs between the tips of the x and y axes, mN mm; twist 2 tip_xy
  double tip_z = 0;      ///< between the tips of the z axes; bending tip_xy + tip_z
  double damping_s = 0;  ///< of both
  double mass = 0;
  double inertia = 0;  ///< of the frame: two masses at the tips of x and y
  double radius = 0;
  Mat3 turn = Mat3::Identity();
};

enum class Hold : char { free, fixed, clamped };

/// The state shared by both integrators, one entry per slot.
struct RodScene {
  RodTree tree;
  SimulationOptions options;
  std::vector<Rod> rods;
  double tie_stretch = 0;  ///< of the springs that close loops, mN/mm

  Pose pose;
  std::vector<Vec3> velocity, spin;  ///< mm/s, rad/s
  std::vector<Vec3> force, torque;   ///< mN, mN mm
  std::vector<Hold> hold;
  std::vector<Vec3> target;  ///< of held slots
  std::vector<char> moved;   ///< since the last clear_moved()

  std::size_t size() const { return rods.size(); }
  bool is_root(Index j) const { return rods[j].parent == kNone; }
};

/// A scene at rest with nothing held; `roots` as in make_rod_tree(). Throws InvalidInput for properties out of range.
RodScene make_rod_scene(const Centerline& centerline, const std::vector<SegmentProperties>& properties,
                        const SimulationOptions& options, std::span<const Index> roots = {});

/// Deviation of slot j's segment from its z axis times its rest length: zero if straight and of rest length.
inline Vec3 misfit(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  return scene.pose.position[j] - scene.pose.position[rod.parent] - rod.length * scene.pose.frame[j].col(2);
}

/// Energies of slot j alone, uJ.
double elastic_energy(const RodScene& scene, Index j);
double kinetic_energy(const RodScene& scene, Index j);
/// Energy of the springs that close loops, uJ.
double tie_energy(const RodScene& scene);
/// Elastic energy of all slots and ties, uJ.
double elastic_energy(const RodScene& scene);
double kinetic_energy(const RodScene& scene);

}  // namespace vmesh
