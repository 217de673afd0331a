#pragma once

#include <Eigen/Core>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/render/render.h"

namespace vmesh {

using Vec2 = Eigen::Vector2d;

struct Ray {
  Vec3 origin, direction;  ///< direction is a unit vector
};

/// Maps pixels to rays and points to pixels. The mesh is fitted into the picture without its rightmost columns, which
/// a legend may take.
class Camera {
 public:
  Camera(const TriMesh& mesh, const RenderOptions& options, int reserved_columns);

  /// The ray through the point (x, y) of the picture, in pixels from its top left corner.
  Ray ray(double x, double y) const;
  /// Where `p` appears, in pixels.
  Vec2 project(const Vec3& p) const;
  /// Whether `p` can be projected: it is neither behind the eye nor next to it.
  bool is_in_front(const Vec3& p) const {
    return distance_ == 0 || distance_ - (p - center_).dot(towards_) > kNearest * distance_;
  }
  /// Distance of `p` behind the foremost point of the mesh, as a share of the mesh's depth.
  double depth_share(const Vec3& p) const { return (front_ - (p - center_).dot(towards_)) / depth_; }

  const Vec3& right() const { return right_; }
  const Vec3& up() const { return up_; }
  const Vec3& towards() const { return towards_; }  ///< from the mesh to the camera

 private:
  static constexpr double kNearest = 1e-3;  // of distance_

  void fit(const TriMesh& mesh, const RenderOptions& options);

  Vec3 right_, up_, towards_;
  Vec3 center_ = Vec3::Zero();  // appears at middle_
  Vec2 middle_;                 // pixels
  double mm_per_pixel_ = 1;     // in the plane of center_
  double distance_ = 0;         // of the eye from center_; 0: orthographic
  double front_ = 0, depth_ = 1;
  double usable_width_, height_;
};

}  // namespace vmesh
