#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/end_section.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// An end that stays as it is, across the vessel, in spite of its section.
struct SectionNotKept {
  Index node = kNone;  ///< of the centerline
  std::string reason;
};

struct SectionEnds {
  std::vector<Index> kept;  ///< nodes at which the surface ends in their sections, ascending
  std::vector<SectionNotKept> not_kept;
  /// Nodes of `kept` where there is no room for the section's area in spite of `to_area`: the vertices lie on its ring.
  std::vector<Index> narrowed;
};

/// Moves the ring of every opening whose node has a section, and the vertices behind it progressively less, so that the
/// surface ends in the section's plane. Where the section's ring is known, the vertices lie on it, in the directions
/// from the middle in which they were; else they are what the plane cuts out of the vessel. With `to_area` they are
/// then scaled to the section's area, which a polygon on its ring does not have. Centre and normal of the opening
/// become the section's. An end stays as it is if the section's plane is more than 45 degrees off the opening's, or its
/// centre more than half a radius, and where faces would cross or a triangle's skewness exceed kWorstSkewness. Nodes
/// are numbered as in `result`, whose check and defects remain those of before.
SectionEnds end_at_sections(GenerateResult& result, const std::vector<EndSection>& sections, bool to_area);

}  // namespace vmesh
