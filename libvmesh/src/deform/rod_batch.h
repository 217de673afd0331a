#pragma once

#include <array>
#include <vector>

#include "deform/rod_scene.h"

namespace vmesh {

/// As many slots as are worked on at once, a number of each: an extension that GCC and Clang share. Where the
/// processor's vectors are narrower the compiler takes several. What is done with them is in lanes.h.
constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(kLanes * sizeof(double))));

struct Lanes3 {
  Lanes x, y, z;
};
/// Columns.
struct Lanes33 {
  Lanes3 x, y, z;
};
struct LanesSpatial {
  Lanes3 linear, angular;
};
/// A symmetric 6x6 matrix in blocks of linear (l) and angular (a) rows and columns; what is on and below the diagonal.
struct LanesMatrix {
  Lanes entries[21];  ///< by rows
};

/// Where slots are, how far they have turned since the step's start, and misfit() of their segments.
struct LanesPose {
  Lanes3 position;
  Lanes33 frame;
  Lanes3 turned, misfit;
};

/// Four slots, none below another, with what a step needs to know of them. Each is one part of a quadratic energy on
/// the tree, in its displacement x: inertia and own gradient, and a spring to the parent's displacement x_p,
///   1/2 (y - x_p)^T W (y - x_p) + spring_gradient (y - x_p),   y = (x.linear + lever x x.angular, x.angular),
/// where lever is the segment, and W is isotropic against stretch, transversely isotropic about z against rotation.
/// Lanes without a slot hold zeros.
struct alignas(64) RodBatch {
  std::array<Index, kLanes> slot{};    ///< of a lane without one, that of the first
  std::array<Index, kLanes> parent{};  ///< places; a root's is its own
  Index first_children = 0;            ///< of RodBatches::children
  Index child_ranks = 0;               ///< the most children of a slot
  std::array<Hold, kLanes> hold{};     ///< as the step began
  bool held = false, rooted = false;   ///< any of them
  Lanes is_root{};                     ///< 1 or 0

  // Constant. The springs of a root are 0.
  Lanes mass{}, inertia{}, radius{}, length{};
  Lanes stretch{}, tip_xy{}, tip_z{}, damping_rate{};
  Lanes step_mass{}, step_inertia{};                                         ///< with drag, over the square of the step
  Lanes w_stretch{}, w_bend{}, w_twist{}, c_stretch{}, c_bend{}, c_twist{};  ///< W and its inverse, damping included
  Lanes33 turn{};

  /// At the step's start, and by turns after an iteration.
  std::array<LanesPose, 3> pose{};
  Lanes3 target{};  ///< of held slots
  Lanes3 predicted_position{}, predicted_x{}, predicted_y{};

  LanesSpatial gradient{};                             ///< of inertia
  LanesSpatial spring_gradient{}, elastic_gradient{};  ///< with and without damping
  Lanes taut{};     ///< tension times length: what turning the segment meets besides the springs
  Lanes elastic{};  ///< energy, uJ

  /// What the subtree below and with the slot means to the parent, and the solution.
  LanesMatrix reduced{};
  LanesSpatial reduced_gradient{}, x{};
};

/// The slots of a tree, large trees in parts, by height: how many of the part are below on the longest way to an end.
/// So children come before their parents, and what is of one height does not depend on each other. A place is a lane of
/// a batch, counted through.
struct RodBatches {
  std::vector<RodBatch> batches;  ///< and one more, of zeros
  /// For every batch and rank of a child, the places of these children; the place behind the last batch where there is
  /// none.
  std::vector<std::array<Index, kLanes>> children;
  std::vector<Index> place_of_slot;

  std::size_t size() const { return batches.size() - 1; }
};

/// At rest as the scene is.
RodBatches make_rod_batches(const RodScene& scene);

}  // namespace vmesh
