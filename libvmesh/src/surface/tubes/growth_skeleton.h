#pragma once

#include <array>
#include <span>

#include "surface/tubes/vessel_rings.h"

namespace vmesh {

/// A stretch of a branch whose cross-sections are its own: rings that follow each other.
struct Tube {
  Index branch = kNone;
  std::span<const Ring> rings;                      ///< of those of the skeleton
  bool starts_at_tip = false, ends_at_tip = false;  ///< closed by a cap there
  bool periodic = false;                            ///< the last ring is followed by the first
};

/// The open end of a tube at which a junction docks.
struct TubeEnd {
  Index tube = kNone;
  bool at_end = false;  ///< at its last ring; at its first otherwise
};

/// A stretch of a branch between tubes, nodes or both. Ends without an opening are at the branch's ends.
struct Gap {
  Index branch = kNone;
  double begin = 0, end = 0;  ///< places
  std::array<TubeEnd, 2> openings;
};

/// What tubes leave over, as far as it hangs together: branching nodes and the gaps around them.
struct Junction {
  std::vector<Index> nodes;
  std::vector<Gap> gaps;
};

/// The ends of a junction's gaps at tubes, in the order of the gaps.
std::vector<TubeEnd> openings_of(const Junction& junction);

/// The graph that steers growth: junctions joined by tubes. Crowded branching nodes fall into one junction, siblings
/// part into tubes of their own where their cross-sections do, and a branch without a cross-section of its own is part
/// of a junction.
struct GrowthSkeleton {
  Rings rings;  ///< of the tubes
  std::vector<Tube> tubes;
  std::vector<Junction> junctions;

  std::size_t cycle_rank() const;
  std::size_t component_count() const;
};

/// `axes` are those of `find_branches`. Isolated nodes become junctions without gaps.
GrowthSkeleton make_growth_skeleton(const VesselField& field, const std::vector<BranchAxis>& axes, int around);

}  // namespace vmesh
