#include "vmesh/quality/closest_point.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/error.h"

#include "quality/triangle_tree.h"

namespace vmesh {

ClosestPointIndex::ClosestPointIndex(const TriMesh& mesh) : tree_(std::make_unique<TriangleTree>(mesh)) {}
ClosestPointIndex::~ClosestPointIndex() = default;
ClosestPointIndex::ClosestPointIndex(ClosestPointIndex&&) noexcept = default;
ClosestPointIndex& ClosestPointIndex::operator=(ClosestPointIndex&&) noexcept = default;

ClosestPoint ClosestPointIndex::closest(const Vec3& p, Index near) const {
  if (!within_reach(p))
    throw InvalidInput("the closest point of a point that is not finite or farther than 1e15 mm is not defined");
  const NearestFace found = tree_->nearest(p, near < tree_->face_count() ? near : kNone);
  return {tree_->frame(found.face).closest(p), found.face, found.distance};
}

std::optional<ClosestPoint> ClosestPointIndex::closest_among(const Vec3& p, double limit,
                                                             const std::function<bool(Index)>& accepts,
                                                             Index near) const {
  if (!within_reach(p))
    throw InvalidInput("the closest point of a point that is not finite or farther than 1e15 mm is not defined");
  const NearestFace found =
      tree_->nearest_among(p, std::min(limit, 1e15), accepts, near < tree_->face_count() ? near : kNone);
  if (found.face == kNone) return std::nullopt;
  return ClosestPoint{tree_->frame(found.face).closest(p), found.face, found.distance};
}

ClosestPoint ClosestPointIndex::closest_on(Index face, const Vec3& p) const {
  return {tree_->frame(face).closest(p), face, std::sqrt(squared_distance(face, p))};
}

double ClosestPointIndex::squared_distance(Index face, const Vec3& p) const {
  return tree_->frame(face).squared_distance(p);
}

}  // namespace vmesh
