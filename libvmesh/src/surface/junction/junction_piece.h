#pragma once

#include "vmesh/core/progress.h"

#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// Branches of a node from which on there are always walls that nearly touch, so that only guarded steps lead to a
/// sound surface. Measured on stars of equal branches, without this: with 64 the first rung of the ladder is sound,
/// with 100 the second, with 250 the fifth.
inline constexpr std::size_t kHub = 160;  // idle 112 to 224

/// A vertex of the surface, and the vertex of a kept ring that it is, if any.
struct PieceVertex {
  Vec3 position;
  Index cone;
  double fineness, lift;
  Index dock = kNone;  ///< of the junction's (docks_of), at whose tube the ring is
  Index number = 0;    ///< in the ring
  double elongation_share = 1;
};

/// The finished surface of a junction and of the tubes around it up to a ring each that is kept as it was.
struct JunctionPiece {
  std::vector<PieceVertex> vertices;
  std::vector<Triangle> faces;
  std::size_t filled_loops = 0;  ///< loops of the centerline that are too short to have a hole
  std::size_t unproven = 0;      ///< faces for which the limit on the error is not proven
  std::size_t crossings = 0;     ///< vertices of faces that intersect each other
  std::size_t tangles = 0;       ///< these of neighbouring vessels, and vertices off the boundary
};

/// Rings at the end of a tube that belong to the piece of the junction there and are replaced by it. The next one joins
/// them.
std::size_t rings_given_away(const Tube& tube);

/// The ring of the tube's end that joins what the junction there replaces, and is kept.
Index kept_ring(const Tube& tube, bool at_end);

/// Grows a junction, docks its tubes and optimises around their seams. Where faces intersect, other resolutions of the
/// junction's surface are tried, then its threads within the lattice; the best is kept. `guarded`: variants on which no
/// step is taken after which faces cross are among them.
JunctionPiece make_junction_piece(const VesselTubes& tubes, const GrowthSkeleton& skeleton, const Junction& junction,
                                  const GenerateOptions& options, bool guarded, const Progress& progress);

}  // namespace vmesh
