#include "render/surface_shader.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "render/canvas.h"
#include "render/color.h"

namespace vmesh {
namespace {

const Vec3 kBackFace(0.80, 0.02, 0.62);  // magenta
const Vec3 kEdge(0.015, 0.015, 0.02);
constexpr double kEdgeOpacity = 0.75;
constexpr double kHaze = 0.14;            // share of background at the far end if no attribute is shown
constexpr double kOcclusionReach = 0.10;  // of the mesh's diagonal
constexpr double kOcclusionRays = 1.5e6;  // over the whole sphere, divided evenly among the vertices

// Evenly spread unit vectors (Fibonacci spiral).
std::vector<Vec3> sphere_directions(int count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    directions.push_back({r * std::cos(golden * i), r * std::sin(golden * i), z});
  }
  return directions;
}

double diagonal_of(const TriMesh& mesh) {
  Vec3 low = mesh.vertices[mesh.faces[0][0]], high = low;
  for (const auto& face : mesh.faces) {
    for (const Index v : face) {
      low = low.cwiseMin(mesh.vertices[v]);
      high = high.cwiseMax(mesh.vertices[v]);
    }
  }
  return (high - low).norm();
}

}  // namespace

SurfaceShader::SurfaceShader(const TriMesh& mesh, const RenderOptions& options, const Camera& camera,
                             const RayScene& scene, AttributeColors attribute, const Progress& progress)
    : mesh_(mesh),
      options_(options),
      camera_(camera),
      attribute_(std::move(attribute)),
      material_(linear_from_srgb(options.material)),
      background_(linear_from_srgb(options.background)),
      normals_(vertex_normals(mesh)) {
  if (options.occlusion > 0) measure_occlusion(scene, progress);
  if (options.edges) {
    for (const Vec3& p : mesh.vertices) projected_.push_back(camera.project(p));
  }
}

// Measures how much of a cosine-weighted hemisphere is open at every vertex.
void SurfaceShader::measure_occlusion(const RayScene& scene, const Progress& progress) {
  constexpr std::size_t kBatch = 1 << 14, kTogether = 64;  // vertices
  const double reach = kOcclusionReach * diagonal_of(mesh_);
  const std::size_t count = mesh_.vertices.size();
  const auto directions =
      sphere_directions(static_cast<int>(std::clamp(kOcclusionRays / static_cast<double>(count), 32., 96.)));
  openness_.assign(count, 1);
  for (std::size_t first = 0; first < count; first += kBatch) {
    report_progress(progress, "light", static_cast<double>(first) / static_cast<double>(count));
    const std::size_t last = std::min(count, first + kBatch);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(first, last, kTogether), [&](const auto& range) {
      for (std::size_t v = range.begin(); v < range.end(); ++v)
        openness_[v] = openness_at(static_cast<Index>(v), scene, reach, directions);
    });
  }
}

// Near obstacles count more than far ones.
double SurfaceShader::openness_at(Index vertex, const RayScene& scene, double reach,
                                  const std::vector<Vec3>& directions) const {
  const Vec3& normal = normals_[vertex];
  const double offset = 1e-3 * reach;
  double total = 0, blocked = 0;
  RayScene::Packet packet;
  std::array<double, 4> weights{};
  std::size_t filled = 0;
  const auto flush = [&] {
    for (std::size_t i = filled; i < 4; ++i) packet[i] = packet[0];
    const auto hits = scene.cast(packet, reach);
    for (std::size_t i = 0; i < filled; ++i) {
      if (hits[i].face != kNone) blocked += weights[i] * (1 - hits[i].distance / reach);
    }
    filled = 0;
  };
  for (const Vec3& d : directions) {
    const double cosine = normal.dot(d);
    if (cosine <= 0.08) continue;  // a ray along the surface would hit adjacent facets
    total += cosine;
    weights[filled] = cosine;
    packet[filled++] = {mesh_.vertices[vertex] + offset * normal, d};
    if (filled == 4) flush();
  }
  if (filled > 0) flush();
  return total > 0 ? 1 - blocked / total : 1;
}

Vec3 SurfaceShader::base_color(const RayHit& hit, const Vec3& weights) const {
  const auto& [values, per_face, categories] = attribute_;
  if (values.empty()) return material_;
  const auto& face = mesh_.faces[hit.face];
  double value = 0;
  if (per_face) {
    value = values[hit.face];
  } else if (categories) {
    Eigen::Index nearest = 0;
    weights.maxCoeff(&nearest);
    value = values[face[static_cast<std::size_t>(nearest)]];
  } else {
    for (int i = 0; i < 3; ++i) value += weights[i] * values[face[static_cast<std::size_t>(i)]];
  }
  if (std::isnan(value)) return kNoValue;
  return categories ? category_color(value) : color_scale(value);
}

// Edges have the same width all over the picture; where triangles are hardly wider than the lines, the lines fade.
double SurfaceShader::edge_opacity(Index face, const Vec2& pixel) const {
  const auto& [a, b, c] = mesh_.faces[face];
  const Vec2 &p = projected_[a], &q = projected_[b], &r = projected_[c];
  const double distance =
      std::min({distance_to_line(pixel, p, q), distance_to_line(pixel, q, r), distance_to_line(pixel, r, p)});
  const double longest = std::max({(p - q).norm(), (q - r).norm(), (r - p).norm()});
  if (longest <= 0) return 0;
  const Vec2 u = q - p, w = r - p;
  const double height = std::abs(u.x() * w.y() - u.y() * w.x()) / longest;
  const double width = options_.edge_width_px;
  const double fade = std::clamp(height / (5 * width), 0.15, 1.0);
  return kEdgeOpacity * fade * std::clamp(width / 2 + 0.5 - distance, 0.0, 1.0);
}

Vec3 SurfaceShader::shade(const RayHit& hit, const Ray& ray, const Vec2& pixel) const {
  const auto& face = mesh_.faces[hit.face];
  const Vec3 weights(1 - hit.u - hit.v, hit.u, hit.v);
  const Vec3 facet = area_normal(mesh_, hit.face);
  const bool back = facet.dot(ray.direction) > 0;

  Vec3 normal = facet;
  if (options_.smooth) {
    const Vec3 mixed = weights[0] * normals_[face[0]] + weights[1] * normals_[face[1]] + weights[2] * normals_[face[2]];
    if (mixed.squaredNorm() > 1e-6) normal = mixed;
  }
  if (back) normal = -normal;
  normal.normalize();
  const Vec3 eye = -ray.direction;
  // Interpolated normals may point away from the viewer at the outline; there they are made perpendicular to the view.
  if (const double away = normal.dot(eye); away < 0) normal = (normal - away * eye).normalized();

  const bool marked = back && options_.highlight_back_faces;
  const bool coloured = !attribute_.values.empty();
  Vec3 color = marked ? kBackFace : base_color(hit, weights);

  double open = 1;
  if (!openness_.empty() && !back) {
    open = weights[0] * openness_[face[0]] + weights[1] * openness_[face[1]] + weights[2] * openness_[face[2]];
    open = 1 - options_.occlusion * (1 - open);
  }

  // Lights move with the camera: a large one at the upper left, a weak one at the right, and ambient light.
  const Vec3 key = (-0.45 * camera_.right() + 0.65 * camera_.up() + 0.75 * camera_.towards()).normalized();
  const Vec3 fill = (0.80 * camera_.right() + 0.10 * camera_.up() + 0.60 * camera_.towards()).normalized();
  const double wrapped = std::max(0.0, (normal.dot(key) + 0.25) / 1.25);
  const double sky = 0.5 + 0.5 * normal.dot(camera_.up());
  const double ambient = 0.24 + 0.16 * sky;
  const double diffuse = open * open * ambient + open * (0.68 * wrapped + 0.16 * std::max(0.0, normal.dot(fill)));
  color *= coloured ? 0.25 + 0.82 * diffuse : 1.08 * diffuse;

  if (!coloured && !marked) {
    const Vec3 half = (key + eye).normalized();
    const double gloss = std::pow(std::max(0.0, normal.dot(half)), 42);
    const double rim = std::pow(1 - std::clamp(normal.dot(eye), 0.0, 1.0), 3);
    color += Vec3::Constant(0.16 * gloss * open + 0.05 * rim * open);
    const double haze = kHaze * std::clamp(camera_.depth_share(ray.origin + hit.distance * ray.direction), 0.0, 1.0);
    color += haze * (background_ - color);
  }
  if (options_.edges) color += edge_opacity(hit.face, pixel) * (kEdge - color);
  return color;
}

}  // namespace vmesh
