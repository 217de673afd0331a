#pragma once

#include <array>
#include <vector>

#include "deform/rod_scene.h"

namespace vmesh {

/// One number for each of the slots that are processed at once, by a vector extension of GCC and Clang. Where the
/// processor's vectors are narrower, the compiler uses several. Operations are in lanes.h.
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
/// A symmetric 6x6 matrix in blocks of linear (l) and angular (a) rows and columns: the entries on and below the
/// diagonal.
struct LanesMatrix {
  Lanes entries[21];  ///< by rows
};

/// Positions and frames of slots, their rotations since the start of the step, and misfit() of their segments.
struct LanesPose {
  Lanes3 position;
  Lanes33 frame;
  Lanes3 turned, misfit;
};

/// Four slots, none below another, with the data of a step. Each contributes one term to a quadratic energy on the
/// tree, in its displacement x: inertia and own gradient, and a spring to the parent's displacement x_p,
///   1/2 (y - x_p)^T W (y - x_p) + spring_gradient (y - x_p),   y = (x.linear + lever x x.angular, x.angular),
/// where lever is the segment, and W is isotropic for stretch and transversely isotropic about z for rotation. Lanes
/// without a slot hold zeros.
struct alignas(64) RodBatch {
  std::array<Index, kLanes> slot{};    ///< for a lane without one, that of the first lane
  std::array<Index, kLanes> parent{};  ///< places; a root's is its own
  Index first_children = 0;            ///< of RodBatches::children
  Index child_ranks = 0;               ///< largest number of children of a slot
  std::array<Hold, kLanes> hold{};     ///< as of the start of the step
  bool held = false, rooted = false;   ///< any of them
  Lanes is_root{};                     ///< 1 or 0

  // Constant. The springs of a root are 0.
  Lanes mass{}, inertia{}, radius{}, length{};
  Lanes stretch{}, tip_xy{}, tip_z{}, damping_rate{};
  Lanes step_mass{}, step_inertia{};  ///< with drag, divided by the square of the step
  Lanes w_stretch{}, w_bend{}, w_twist{}, c_stretch{}, c_bend{}, c_twist{};  ///< W and its inverse, damping included
  Lanes33 turn{};

  /// At the start of the step, and alternately after an iteration.
  std::array<LanesPose, 3> pose{};
  Lanes3 target{};  ///< of held slots
  Lanes3 predicted_position{}, predicted_x{}, predicted_y{};

  LanesSpatial gradient{};                             ///< of inertia
  LanesSpatial spring_gradient{}, elastic_gradient{};  ///< with and without damping
  Lanes taut{};     ///< tension times length: geometric stiffness against rotating the segment
  Lanes elastic{};  ///< energy, uJ

  /// The slot's subtree reduced to its effect on the parent, and the solution.
  LanesMatrix reduced{};
  LanesSpatial reduced_gradient{}, x{};
};

/// The slots of a tree (large trees in blocks) by height, the number of slots of the block below on the longest path to
/// an end. So children come before their parents, and slots of equal height are independent of each other. A place is
/// the number of a lane, counted over all batches.
struct RodBatches {
  std::vector<RodBatch> batches;  ///< plus one of zeros
  /// For every batch and rank of a child, the places of these children; where there is none, the place after the last
  /// batch.
  std::vector<std::array<Index, kLanes>> children;
  std::vector<Index> place_of_slot;

  std::size_t size() const { return batches.size() - 1; }
};

/// Batches of the scene at rest.
RodBatches make_rod_batches(const RodScene& scene);

}  // namespace vmesh
