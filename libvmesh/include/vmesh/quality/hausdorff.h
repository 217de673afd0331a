#pragma once

#include <algorithm>
#include <optional>

#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A pair of points that attests a distance: `to` is the closest point of the other mesh.
struct DistanceWitness {
  Vec3 from = Vec3::Zero();
  Index from_face = kNone;
  Vec3 to = Vec3::Zero();
  Index to_face = kNone;
};

/// The one-sided Hausdorff distance (the largest distance of a point of one mesh from the other) as an interval that
/// contains the true value, mm. Both ends allow for the rounding of doubles.
struct OneSidedHausdorff {
  double lower = 0;
  double upper = 0;
  DistanceWitness witness;  ///< its length is at least `lower`
};

/// Both directions. The symmetric distance lies between the larger of the lower and the larger of the upper bounds.
struct Hausdorff {
  OneSidedHausdorff forward;   ///< from the first mesh to the second
  OneSidedHausdorff backward;  ///< from the second to the first

  /// The direction that has the larger distance.
  const OneSidedHausdorff& larger() const { return backward.lower > forward.lower ? backward : forward; }
  double lower() const { return std::max(forward.lower, backward.lower); }
  double upper() const { return std::max(forward.upper, backward.upper); }
};

struct HausdorffOptions {
  /// Largest width of the interval, mm.
  double tolerance = 1e-4;
  Progress progress;
};

/// For all functions below: a mesh is the set of points of its faces; it may be open or a soup of triangles, with
/// coincident points and faces without area; loose vertices do not count. Deterministic. hausdorff() runs its
/// directions on two threads of the caller's arena (oneTBB), the others use one. They throw InvalidInput for a mesh
/// without faces, a face that names a vertex that does not exist, a corner that is not finite or farther than 1e15 mm
/// from the origin, and a tolerance that is not positive or finer than doubles can resolve at the size of the meshes
/// (2^-40 of their coordinates and extents); Cancelled when the progress asks to stop.
///
/// Branch and bound over the faces of `from`: distances at corners bound a triangle's from both sides; what remains is
/// bisected. After Tang, Lee, Kim, "Interactive Hausdorff distance computation for general polygonal models", 2009; the
/// upper bounds use that the distance from one face is convex, and so are weighted means of the distances from several.
OneSidedHausdorff one_sided_hausdorff(const TriMesh& from, const TriMesh& to, const HausdorffOptions& options = {});

/// Both directions, each to the tolerance.
Hausdorff hausdorff(const TriMesh& a, const TriMesh& b, const HausdorffOptions& options = {});

/// Only the larger of both directions: the second search ignores distances below the result of the first.
/// `witness.from` is on `b` when `from_second` is set.
struct SymmetricHausdorff {
  double lower = 0;
  double upper = 0;
  DistanceWitness witness;
  bool from_second = false;
};
SymmetricHausdorff symmetric_hausdorff(const TriMesh& a, const TriMesh& b, const HausdorffOptions& options = {});

/// Whether the one-sided distance is larger than `limit` (mm): returns a witness of a larger distance if there is one,
/// and nullopt if the distance is at most `limit`; up to `limit` + tolerance it may return either. Also throws
/// InvalidInput unless `limit` is finite and not negative.
std::optional<DistanceWitness> hausdorff_exceeds(const TriMesh& from, const TriMesh& to, double limit,
                                                 const HausdorffOptions& options = {});

}  // namespace vmesh
