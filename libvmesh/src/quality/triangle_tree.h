#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

#include "quality/triangle_frame.h"

namespace vmesh {

/// A face and its distance (mm) from some point.
struct NearestFace {
  Index face = kNone;
  double distance = 0;
};

/// Whether `p` is finite and near enough for squared distances to be in the range of float.
inline bool within_reach(const Vec3& p) {
  constexpr double kFarthest = 1e15;  // mm
  return (p.array().abs() <= kFarthest).all();
}

/// The smallest box around all corners of a mesh's faces. Throws InvalidInput like ClosestPointIndex.
struct Extent {
  Vec3 low, high;
  double diagonal() const { return (high - low).norm(); }
  /// The largest absolute coordinate: what rounding is relative to.
  double magnitude() const { return low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff(); }
};
Extent measure_extent(const TriMesh& mesh);

/// The faces of a mesh in a tree of boxes, for closest points.
class TriangleTree {
 public:
  explicit TriangleTree(const TriMesh& mesh);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  /// The face closest to `p`. `near`: a face that bounds the search.
  NearestFace nearest(const Vec3& p, Index near = kNone) const;
  /// The face closest to `p` among those that `accepts` approves and that are nearer than `limit`; kNone if there is
  /// none.
  NearestFace nearest_among(const Vec3& p, double limit, const std::function<bool(Index)>& accepts,
                            Index near = kNone) const;

  std::size_t face_count() const { return frames_.size(); }
  const TriangleFrame& frame(Index face) const { return frames_[face]; }
  const Extent& extent() const { return extent_; }

 private:
  // Error bound of the float traversal at `p`, mm.
  double float_slack(const Vec3& local) const;

  struct Embree;
  Extent extent_;
  Vec3 center_;  // Embree's coordinates are relative to this point
  double half_diagonal_;
  std::vector<TriangleFrame> frames_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace vmesh
