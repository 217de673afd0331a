#pragma once

#include <vector>

#include "vmesh/core/progress.h"

#include "render/camera.h"
#include "render/ray_scene.h"

namespace vmesh {

/// The colours given by an attribute.
struct AttributeColors {
  /// For every vertex or face, its value's position on the colour scale, in [0, 1], or its label; NaN: no value. Empty
  /// without an attribute.
  std::vector<double> values;
  bool per_face = false;
  bool categories = false;  ///< the values are labels
};

/// Computes the light of points of the surface.
class SurfaceShader {
 public:
  /// Arguments are kept by reference and must outlive the shader.
  SurfaceShader(const TriMesh& mesh, const RenderOptions& options, const Camera& camera, const RayScene& scene,
                AttributeColors attribute, const Progress& progress);

  /// The light from the surface at `hit` towards the camera; `pixel` is where the ray crosses the picture.
  Vec3 shade(const RayHit& hit, const Ray& ray, const Vec2& pixel) const;

 private:
  void measure_occlusion(const RayScene& scene, const Progress& progress);
  double openness_at(Index vertex, const RayScene& scene, double reach, const std::vector<Vec3>& directions) const;
  Vec3 base_color(const RayHit& hit, const Vec3& weights) const;
  double edge_opacity(Index face, const Vec2& pixel) const;

  const TriMesh& mesh_;
  const RenderOptions& options_;
  const Camera& camera_;
  AttributeColors attribute_;
  Vec3 material_, background_;
  std::vector<Vec3> normals_;     // of vertices, for smooth shading and occlusion
  std::vector<double> openness_;  // of vertices: share of the ambient light that arrives
  std::vector<Vec2> projected_;   // vertices in the picture, for edges
};

}  // namespace vmesh
