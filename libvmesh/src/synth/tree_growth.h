#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vmesh/core/types.h"

// Grows the skeleton of a synthetic tree: branches as smooth curves that fill the liver region and keep apart.
namespace vmesh::growth {

struct Branch {
  Index parent = kNone;
  std::array<Index, 2> children{kNone, kNone};
  Index depth = 0;         ///< branches between this one and the trunk
  double arc = 0;          ///< length along the tree from the root to path.front()
  double length = 0;       ///< of path
  double radius = 0;       ///< at its start; it never widens
  double weight = 0;       ///< share of the region that it supplies; the sum of its children's weights
  std::vector<Vec3> path;  ///< a fine polyline; starts at the last point of the parent's

  bool is_leaf() const { return children[0] == kNone; }
};

/// The vessel radius that supplies a share of the region: root_radius * (weight / total)^exponent.
struct RadiusLaw {
  double root_radius = 6.5;
  double exponent = 0.5;
  double total = 1;

  double operator()(double weight) const;
};
RadiusLaw radius_law(std::size_t ends);

/// How much of the liver a tree with `ends` ends fills, as a scale around the hilum.
double region_scale(std::size_t ends);

/// Grows a tree with about `ends` ends, the best of a few attempts if some find no room to divide; branch 0 is the
/// trunk, parents come before their children. Weights add up to `total` at most.
std::vector<Branch> grow(std::size_t ends, std::uint64_t seed, double& total);

}  // namespace vmesh::growth
