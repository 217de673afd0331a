#pragma once

#include <array>
#include <span>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// A ball that a lattice covers, mm. In it no edge is longer than `longest`.
struct LatticeBall {
  Vec3 center;
  double radius;
  double longest;
};

/// A body-centred cubic lattice of tetrahedra, bisected wherever smaller ones are needed. Resolution may vary by any
/// factor; the tetrahedra always meet face to face. Points are numbered; point 0 is the origin.
///
/// A tetrahedron is bisected at its longest edge, together with all others around that edge; those with a longer edge
/// are bisected at that first (Rivara). Of the two opposite long edges of an unbisected tetrahedron, one joins points
/// of the first cubic grid and one of the second; the latter is bisected first. From then on the longest edge is
/// unique, every tetrahedron has one of three shapes (Maubach 1995), and edges halve with every third bisection.
class GradedLattice {
 public:
  using Tetrahedron = std::array<Index, 4>;  ///< its corners, in positive order

  /// `spacing` is the edge of the lattice's cubes, `frame` its directions. Unbisected tetrahedra extend two spacings
  /// beyond every ball. `origin` must lie in one of them.
  GradedLattice(const Vec3& origin, const Eigen::Matrix3d& frame, double spacing, std::span<const LatticeBall> balls);

  std::size_t size() const { return at_.size(); }
  Vec3 position(Index point) const { return origin_ + frame_ * (unit_ * at_[point]); }
  /// Longest edge of the tetrahedra around a point, mm.
  double spacing(Index point) const { return unit_ * longest_[point]; }
  /// Whether tetrahedra around the point are missing.
  bool at_border(Index point) const { return at_border_[point] != 0; }

  const std::vector<Tetrahedron>& tetrahedra() const { return tetrahedra_; }
  /// The numbers of the tetrahedra around a point, ascending.
  std::span<const Index> around(Index point) const {
    return {around_.data() + around_offsets_[point], around_.data() + around_offsets_[point + 1]};
  }

 private:
  class Maker;

  Vec3 origin_;
  Eigen::Matrix3d frame_;
  double unit_;           // mm; half the edge of a cube
  std::vector<Vec3> at_;  // in units and along the frame; exact, multiples of a power of two
  std::vector<char> at_border_;
  std::vector<double> longest_;  // in units
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<Index> around_, around_offsets_;
};

}  // namespace vmesh
