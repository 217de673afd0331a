#pragma once

#include <array>
#include <memory>

#include "vmesh/mesh/tri_mesh.h"

#include "render/camera.h"

namespace vmesh {

/// Where a ray meets the mesh first.
struct RayHit {
  Index face = kNone;   ///< kNone: nowhere
  double distance = 0;  ///< along the ray
  double u = 0, v = 0;  ///< weights of the face's second and third corner
};

/// A mesh prepared for ray casting.
class RayScene {
 public:
  explicit RayScene(const TriMesh& mesh);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Four rays at a time; hits farther than `reach` do not count.
  using Packet = std::array<Ray, 4>;
  std::array<RayHit, 4> cast(const Packet& rays, double reach) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace vmesh
