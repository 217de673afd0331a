#pragma once

#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A branch that was left out of growth because the other vessels cover it.
struct BuriedBranch {
  std::vector<Index> segments;  ///< of the full centerline
};

/// What is left of a centerline without its buried branches.
struct GrowthCenterline {
  Centerline centerline;
  std::vector<Index> node;     ///< of the full centerline, for every node
  std::vector<Index> segment;  ///< of the full centerline, for every segment
  std::vector<Index> cone;     ///< of the full field, for every cone of the new one
  std::vector<BuriedBranch> buried;
};

/// Leaves out branches with an end that the others cover, thinnest first. Such a branch is covered if every piece of it
/// lies in a single round cone of what is left, apart from a tenth of its radius: round cones are convex, so two
/// spheres within one have all that is between them within it. Of an end, what lies within the sphere of one node of
/// its branch goes as well; needles there, thinner than half of that sphere, may stand out of it by a quarter of its
/// radius. The volume is the same up to these; components never change.
GrowthCenterline without_buried_branches(const VesselField& field);

/// What was left out, in words. `full`: the centerline that it was left out of.
std::vector<GrowthSimplification> notes_of_buried(const GrowthCenterline& growth, const Centerline& full);

}  // namespace vmesh
