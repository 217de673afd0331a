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

/// Finds end branches that the other vessels cover, thinnest first. A branch is covered if every interval of it lies in
/// a single round cone of the rest, to within a tenth of its radius: a round cone is convex, so it contains everything
/// between two spheres that it contains. Ends are also trimmed of what lies within the sphere of one node of their
/// branch; needles there, thinner than half of that sphere, may protrude by a quarter of its radius. Without them the
/// volume is the same up to these tolerances; components never change.
std::vector<BuriedBranch> find_buried_branches(const VesselField& field);
/// The same in less memory, but slower around nodes of hundreds of branches.
std::vector<BuriedBranch> find_buried_branches(const ConeRelations& cones);

/// Leaves them out.
GrowthCenterline without_buried_branches(const Centerline& full, std::vector<BuriedBranch> buried);
GrowthCenterline without_buried_branches(const VesselField& field);

/// Describes what was left out. `full`: the complete centerline.
std::vector<GrowthSimplification> notes_of_buried(const std::vector<BuriedBranch>& buried, const Centerline& full);

}  // namespace vmesh
