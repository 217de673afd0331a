#pragma once

#include <vector>

#include "vmesh/centerline/branches.h"

namespace vmesh {

/// Whether a branch is a loop without a branching node.
inline bool is_loop(const Centerline& centerline, const Branch& branch) {
  return branch.nodes.front() == branch.nodes.back() && centerline.degree(branch.nodes.front()) == 2;
}

/// A branch by arc length: its axis from place 0 to place length(), in mm.
class BranchAxis {
 public:
  BranchAxis(const Centerline& centerline, const Branch& branch);

  struct Point {
    std::size_t nth;  ///< index into the branch's segments
    double t;         ///< parameter on that segment, from its node a
    Vec3 position;
    double radius;
  };

  const Branch& branch() const { return *branch_; }
  double length() const { return places_.back(); }
  /// A loop without a branching node: places repeat with length().
  bool periodic() const { return periodic_; }
  bool starts_at_tip() const { return starts_at_tip_; }
  bool ends_at_tip() const { return ends_at_tip_; }

  /// The point of the axis at `place`, which is clamped to the axis, or wrapped around if it is periodic.
  Point at(double place) const;
  /// Unit chord from `place` - reach to `place` + reach: the smoothed direction of the vessel.
  Vec3 direction(double place, double reach) const;
  /// Place of parameter `t` of the branch's segment number `nth`.
  double place_of(std::size_t nth, double t) const;
  /// Distance of two places along the branch.
  double apart(double place, double other) const;
  double node_place(std::size_t node) const { return places_[node]; }

  /// Length of the segment at `place`, the shorter one at a node.
  double shortest_at(double place) const;
  /// Integral of ds / radius over the branch.
  double length_in_radii() const { return radii_.back(); }
  /// The integral up to `place`.
  double radii_of(double place) const;
  /// The place at which that integral reaches `radii`.
  double place_at_radii(double radii) const;

 private:
  bool reversed(std::size_t nth) const;

  const Centerline* centerline_;
  const Branch* branch_;
  bool periodic_, starts_at_tip_, ends_at_tip_;
  std::vector<double> places_, radii_;  // of the branch's nodes: arc length, and integral of ds / radius
};

}  // namespace vmesh
