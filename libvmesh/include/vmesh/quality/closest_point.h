#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The point of a mesh that is closest to a given point.
struct ClosestPoint {
  Vec3 point = Vec3::Zero();
  Index face = kNone;
  double distance = 0;  ///< mm
};

/// Finds the closest point of a mesh: Embree traverses boxes in float with a margin for rounding, and distances are
/// compared in double, so the result is the closest point up to the rounding of doubles. Works for any mesh with a
/// face: open, a soup of triangles, with coincident points and faces without area.
class ClosestPointIndex {
 public:
  /// Copies what it needs of `mesh`. Throws InvalidInput when there is no face, a face names a vertex that does not
  /// exist, or a corner is not finite or farther than 1e15 mm from the origin.
  explicit ClosestPointIndex(const TriMesh& mesh);
  ~ClosestPointIndex();
  ClosestPointIndex(ClosestPointIndex&&) noexcept;
  ClosestPointIndex& operator=(ClosestPointIndex&&) noexcept;

  /// `near`: a face that may be close, such as the result for a neighbouring point; saves time. Thread-safe. Of equally
  /// close faces, which one is found may depend on `near`. Throws InvalidInput when `p` is not finite or farther than
  /// 1e15 mm from the origin.
  ClosestPoint closest(const Vec3& p, Index near = kNone) const;

  /// The closest of the faces that `accepts` approves, if one is nearer than `limit` (mm). `accepts` is called for few
  /// faces, each nearer than the best so far.
  std::optional<ClosestPoint> closest_among(const Vec3& p, double limit, const std::function<bool(Index)>& accepts,
                                            Index near = kNone) const;

  /// The point of one face that is closest to `p`, which must be finite, and the square of its distance.
  ClosestPoint closest_on(Index face, const Vec3& p) const;
  double squared_distance(Index face, const Vec3& p) const;

 private:
  std::unique_ptr<class TriangleTree> tree_;
};

}  // namespace vmesh
