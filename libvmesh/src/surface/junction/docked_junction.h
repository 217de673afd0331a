#pragma once

#include "vmesh/core/progress.h"

#include "surface/remesh/bound_surface.h"
#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// Number of branches at a node from which on some walls always nearly touch, so that only guarded steps give a sound
/// surface. Measured on stars of equal branches, without this: the first sound rung of the ladder is the first with 64,
/// the second with 100, the fifth with 250.
inline constexpr std::size_t kHub = 160;  // idle 112 to 224
/// Most branches of a node around which faces are not crowded: the more, the longer and narrower the pits between them.
inline constexpr std::size_t kUncrowded = 250;

/// A vertex of the surface; where it belongs to a kept ring, which vertex of which ring.
struct DockedVertex {
  Vec3 position;
  Index cone;
  double fineness, lift;
  Index dock = kNone;           ///< index into docks_of(junction): the dock of the ring's tube
  Index number = 0;             ///< in the ring
  double elongation_share = 1;  ///< see BoundSurface
};

/// The finished surface of a junction and of the tube ends around it, up to one ring of each tube that is kept
/// unchanged.
struct DockedJunction {
  std::vector<DockedVertex> vertices;
  std::vector<Triangle> faces;
  std::size_t filled_loops = 0;  ///< loops of the centerline that are too short to have a hole
  std::size_t unproven = 0;      ///< faces for which the limit on the error is not proven
  std::size_t crossings = 0;     ///< vertices of faces that intersect each other
  std::size_t tangles = 0;       ///< those of them on neighbouring vessels, and vertices off the boundary
  /// If it hangs: the vertices off the boundary, too many to be mended, and the vessels' radii there. Growth went
  /// around a hole that the volume has and the graph has not, as where vessels part and are rounded together again.
  std::vector<BoundSurface::Spot> hanging;
  /// If it does not hang but is too tangled to be refined any further (OptimizeReport::hopeless): the same of its
  /// tangles.
  std::vector<BoundSurface::Spot> hopeless;
};

/// Number of rings at each end of a tube that the junction's surface replaces. The next ring is kept and joins the two.
std::size_t rings_given_away(const Tube& tube);

/// The kept ring at an end of a tube, next to those that the junction's surface replaces.
Index kept_ring(const Tube& tube, bool at_end);

/// Grows a junction, docks its tubes and optimises the surface around the docks. Where faces intersect, other variants
/// are tried (resolution, rims as cut) and the best is kept; unless it `may_hang`, not where the first hangs, which
/// others do as well. `fine_places`: where the lattice and edges are finer. `guarded`: also tries variants in which
/// only guarded steps are taken.
DockedJunction make_docked_junction(const VesselRings& tubes, const GrowthSkeleton& skeleton, const Junction& junction,
                                    const GenerateOptions& options, const std::vector<FinePlace>& fine_places,
                                    bool guarded, bool may_hang, const Progress& progress);

}  // namespace vmesh
