#pragma once

#include <vector>

#include "deform/matrix6.h"
#include "deform/rod_scene.h"

namespace vmesh {

/// One slot's part of a quadratic energy on a tree, in its displacement x: inertia and own gradient, and a spring to
/// the parent's displacement x_p,
///   1/2 (y - x_p)^T W (y - x_p) + spring_gradient (y - x_p),   y = (x.linear + lever x x.angular, x.angular),
/// where W is isotropic against stretch, and transversely isotropic about z against rotation.
struct RodEquation {
  double mass = 0, inertia = 0;  ///< inertia about the transverse axes, half of that about z
  double taut = 0;               ///< tension times length: what turning the segment meets besides the springs
  Vec3 z = Vec3::UnitZ();
  Vec3 lever = Vec3::Zero();
  double stretch = 0, bend = 0, twist = 0;                                   ///< W
  double stretch_compliance = 0, bend_compliance = 0, twist_compliance = 0;  ///< their inverses
  Spatial gradient, spring_gradient;
  Spatial elastic_gradient;  ///< spring_gradient without damping
  Hold hold = Hold::free;
  Vec3 prescribed = Vec3::Zero();  ///< displacement of a held slot

  // What the subtree below and with this slot means to the parent, and the solution.
  Matrix6 reduced = {};
  Vector6 reduced_gradient = {};
  Spatial x;
};

/// Asks the memory for what is written to soon.
template <class T>
inline void fetch(const T& place) {
  for (std::size_t i = 0; i < sizeof(T); i += 64) __builtin_prefetch(reinterpret_cast<const char*>(&place) + i, 1);
}

/// Eliminates slot j, whose children are: computes `reduced`, or for a root x.
void eliminate(std::vector<RodEquation>& equations, const std::vector<Rod>& rods, Index j);

/// x of slot j from its parent's.
void substitute(std::vector<RodEquation>& equations, Index j, Index parent);

}  // namespace vmesh
