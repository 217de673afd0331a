#pragma once

#include <cstdint>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// Which synthetic tree to make.
struct SyntheticTreeOptions {
  std::size_t vertices = 1560;  ///< nodes of the centerline, exactly; 2 to 10,000,000
  std::uint64_t seed = 1;       ///< of the random numbers; each gives a different tree
};

/// A tree like a liver's portal vein: it enters a liver-shaped region at the hilum and branches until it fills it.
///   - One component without loops. Node 0 is the root, every other node follows its parent, segment i joins node
///     i + 1 (its b) to that node's parent (its a).
///   - About one end per eight nodes. The root's radius is 6.5 mm, twigs are thinner the more ends there are
///     (about 0.5 mm for 1,560 nodes). Where a vessel divides in two, the cube of its radius is the sum of the
///     cubes of the radii of the two nodes that follow (Murray's law); in between vessels taper gently.
///   - Vessels keep apart: the capsules of two segments, with the larger end radius of each, touch only when the
///     segments are near along the tree (path length at most twice the sum of their radii).
/// Deterministic: the same options give the same bytes wherever double is IEEE 754. Throws InvalidInput for a number of
/// vertices out of range.
Centerline synthetic_tree(const SyntheticTreeOptions& options = {});

/// Whether `p` lies in the region that synthetic trees fill: 205 x 150 x 120 mm, LPS, the right lobe at negative x.
/// Trees of fewer than about 1,500 nodes keep to the part of it around the hilum.
bool in_synthetic_tree_region(const Vec3& p);

}  // namespace vmesh
