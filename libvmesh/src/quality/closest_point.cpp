#include "vmesh/quality/closest_point.h"

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

}  // namespace vmesh
