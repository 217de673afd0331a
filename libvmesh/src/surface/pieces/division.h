#pragma once

#include "vmesh/surface/generate.h"

#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// A place in a division: a ring, or a node that is in no stretch.
struct Anchor {
  RingPlace ring;
  Index node = kNone;
};

/// The seams at a piece's ends, in the order of its stretches.
std::vector<RingPlace> seams_of(const VesselTubes& tubes, const PiecePlan& plan);

Anchor anchor_of(const PiecePlan& plan);

/// A surface's pieces, and the seams at which they meet. Each seam lies between two pieces.
struct Division {
  std::vector<RingPlace> seams;                   ///< ascending
  std::vector<PiecePlan> plans;                   ///< by their first stretches; those of isolated nodes last
  std::vector<std::pair<Anchor, Anchor>> joined;  ///< places that are in one piece, although no vessel leads there
};

/// Divides a surface at rings where the tube around is as even as the rest will become, so that nothing is lost when
/// they stay as they are: a ring about halfway between two junctions, and more along far ways.
/// What the options would have refined there is no seam.
Division divide(const VesselTubes& tubes, const GenerateOptions& options);

/// The division without some seams, with the pieces at both of these anchors as one.
Division regrouped(const VesselTubes& tubes, const Division& division, const std::vector<RingPlace>& dissolved,
                   const std::vector<std::pair<Anchor, Anchor>>& joined);

}  // namespace vmesh
