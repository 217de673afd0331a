#pragma once

#include <vector>

#include "render/camera.h"
#include "render/ray_scene.h"

namespace vmesh {

/// Gives points of the surface their light.
class SurfaceShader {
 public:
  /// What is kept by reference must outlive the shader. `scale_positions`: for every vertex (or face, see
  /// `per_face`) where its attribute value lies on the colour scale, in [0, 1], or NaN; empty without attribute.
  SurfaceShader(const TriMesh& mesh, const RenderOptions& options, const Camera& camera, const RayScene& scene,
                std::vector<double> scale_positions, bool per_face);

  /// The light of the surface at `hit` towards the camera; `pixel` is where the ray went through the picture.
  Vec3 shade(const RayHit& hit, const Ray& ray, const Vec2& pixel) const;

 private:
  void measure_occlusion(const RayScene& scene);
  Vec3 base_color(const RayHit& hit, const Vec3& weights) const;
  double edge_opacity(Index face, const Vec2& pixel) const;

  const TriMesh& mesh_;
  const RenderOptions& options_;
  const Camera& camera_;
  std::vector<double> scale_positions_;
  bool per_face_;
  Vec3 material_, background_;
  std::vector<Vec3> normals_;     // of vertices, for smooth shading and occlusion
  std::vector<double> openness_;  // of vertices: share of the light of the surroundings that arrives
  std::vector<Vec2> projected_;   // vertices in the picture, for edges
};

}  // namespace vmesh
