#pragma once

#include <vector>

#include "render/camera.h"
#include "render/ray_scene.h"

namespace vmesh {

/// What an attribute says about colours.
struct AttributeColors {
  /// For every vertex or face where its value lies on the colour scale, in [0, 1], or its label; NaN: no value. Empty
  /// without attribute.
  std::vector<double> values;
  bool per_face = false;
  bool categories = false;  ///< the values are labels
};

/// Gives points of the surface their light.
class SurfaceShader {
 public:
  /// What is kept by reference must outlive the shader.
  SurfaceShader(const TriMesh& mesh, const RenderOptions& options, const Camera& camera, const RayScene& scene,
                AttributeColors attribute);

  /// The light of the surface at `hit` towards the camera; `pixel` is where the ray went through the picture.
  Vec3 shade(const RayHit& hit, const Ray& ray, const Vec2& pixel) const;

 private:
  void measure_occlusion(const RayScene& scene);
  Vec3 base_color(const RayHit& hit, const Vec3& weights) const;
  double edge_opacity(Index face, const Vec2& pixel) const;

  const TriMesh& mesh_;
  const RenderOptions& options_;
  const Camera& camera_;
  AttributeColors attribute_;
  Vec3 material_, background_;
  std::vector<Vec3> normals_;     // of vertices, for smooth shading and occlusion
  std::vector<double> openness_;  // of vertices: share of the light of the surroundings that arrives
  std::vector<Vec2> projected_;   // vertices in the picture, for edges
};

}  // namespace vmesh
