#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The point of a mesh that is closest to some other point.
struct ClosestPoint {
  Vec3 point = Vec3::Zero();
  Index face = kNone;
  double distance = 0;  ///< mm
};

/// Finds the closest point of a mesh: Embree walks the boxes in float with room for its rounding, distances are
/// compared in double, so that what is found is the closest point up to the rounding of doubles.
/// Any mesh with a face will do: open, a soup of triangles, with coincident points and faces without area.
class ClosestPointIndex {
 public:
  /// Copies what it needs of `mesh`. Throws InvalidInput when there is no face, a face names a vertex that does not
  /// exist, or a corner is not finite or farther than 1e15 mm from the origin.
  explicit ClosestPointIndex(const TriMesh& mesh);
  ~ClosestPointIndex();
  ClosestPointIndex(ClosestPointIndex&&) noexcept;
  ClosestPointIndex& operator=(ClosestPointIndex&&) noexcept;

  /// `near`: a face that may be close, such as the answer for a neighbouring point; saves time. Any number of threads
  /// may ask at once. Of equally close faces, which one is found may depend on `near`. Throws InvalidInput when `p` is
  /// not finite or farther than 1e15 mm from the origin.
  ClosestPoint closest(const Vec3& p, Index near = kNone) const;

  /// The closest of the faces that `accepts` takes, when one is nearer than `limit` (mm). `accepts` is asked about few
  /// faces, each of them nearer than what was found before.
  std::optional<ClosestPoint> closest_among(const Vec3& p, double limit, const std::function<bool(Index)>& accepts,
                                            Index near = kNone) const;

 private:
  std::unique_ptr<class TriangleTree> tree_;
};

}  // namespace vmesh
