#include "vmesh/render/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"

#include "render/camera.h"
#include "render/canvas.h"
#include "render/color.h"
#include "render/legend.h"
#include "render/ray_scene.h"
#include "render/shown_tiles.h"
#include "render/surface_shader.h"

namespace vmesh {
namespace {

void require(bool good, const std::string& message) {
  if (!good) throw InvalidInput("render: " + message);
}

void check_options(const RenderOptions& o) {
  constexpr int kSmallest = 16, kLargest = 16384;
  const auto fits = [](int size) { return size >= kSmallest && size <= kLargest; };
  require(fits(o.width) && fits(o.height), "a picture of " + std::to_string(o.width) + " x " +
                                               std::to_string(o.height) + " pixels; width and height are 16 to 16384");
  require(std::isfinite(o.view.azimuth_deg) && std::isfinite(o.view.elevation_deg), "the view direction is not finite");
  require(!o.look_at || o.look_at->allFinite(), "the point to look at is not finite");
  require(std::isfinite(o.view_height_mm) && o.view_height_mm >= 0, "the height of the view is negative or not finite");
  require(std::isfinite(o.zoom) && o.zoom > 0, "the zoom is not positive");
  require(o.field_of_view_deg >= 0 && o.field_of_view_deg < 120, "the field of view is not in [0, 120) degrees");
  require(std::isfinite(o.edge_width_px) && o.edge_width_px > 0, "the width of edges is not positive");
  require(o.occlusion >= 0 && o.occlusion <= 1, "the occlusion is not in [0, 1]");
  require(!o.range ||
              (std::isfinite(o.range->first) && std::isfinite(o.range->second) && o.range->first <= o.range->second),
          "the range of the colour scale is not finite or runs backwards");
}

void check_mesh(const TriMesh& mesh) {
  require(!mesh.faces.empty(), "the mesh has no faces; there is nothing to draw");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    require(mesh.vertices[v].allFinite(), "the position of vertex " + std::to_string(v) + " is not finite");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      require(v < mesh.vertices.size(), "face " + std::to_string(f) + " names vertex " + std::to_string(v) +
                                            ", but there are " + std::to_string(mesh.vertices.size()));
    }
  }
}

// The attribute as needed by legend and shader.
struct Coloring {
  Legend legend;
  AttributeColors colors;
};

void check_attribute(const TriMesh& mesh, const MeshAttribute& attribute, AttributeDomain domain) {
  const bool per_face = domain == AttributeDomain::face;
  const std::size_t expected = per_face ? mesh.faces.size() : mesh.vertices.size();
  require(attribute.values.size() == expected, "attribute \"" + attribute.name + "\" has " +
                                                   std::to_string(attribute.values.size()) + " values for " +
                                                   std::to_string(expected) + (per_face ? " faces" : " vertices"));
}

bool has_missing(const MeshAttribute& attribute) {
  return std::any_of(attribute.values.begin(), attribute.values.end(), [](double x) { return std::isnan(x); });
}

Coloring color_by_scale(const MeshAttribute& attribute, const RenderOptions& options) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : attribute.values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (options.range) std::tie(low, high) = *options.range;
  require(low <= high, "attribute \"" + attribute.name + "\" has no finite value");
  Coloring coloring;
  for (const double value : attribute.values) {
    // Halved, as the difference of two finite doubles may overflow.
    const double t = high > low ? (value / 2 - low / 2) / (high / 2 - low / 2) : 0.5;
    coloring.colors.values.push_back(std::isnan(value) ? value : std::clamp(t, 0.0, 1.0));
  }
  coloring.legend = {attribute.name, low, high, attribute.integer, has_missing(attribute), {}};
  return coloring;
}

Coloring color_by_category(const MeshAttribute& attribute) {
  constexpr double kMostLabel = 0x1p53;
  std::set<double> labels;
  for (const double value : attribute.values) {
    require(std::isnan(value) || std::abs(value) <= kMostLabel,
            "attribute \"" + attribute.name + "\" has values too large for labels");
    if (!std::isnan(value)) labels.insert(std::round(value));
  }
  require(!labels.empty(), "attribute \"" + attribute.name + "\" has no finite value");
  Coloring coloring;
  coloring.colors.values = attribute.values;
  coloring.colors.categories = true;
  coloring.legend.name = attribute.name;
  coloring.legend.has_missing = has_missing(attribute);
  coloring.legend.categories.assign(labels.begin(), labels.end());
  return coloring;
}

Coloring make_coloring(const TriMesh& mesh, const MeshAttribute& attribute, AttributeDomain domain,
                       const RenderOptions& options) {
  check_attribute(mesh, attribute, domain);
  Coloring coloring = options.categories ? color_by_category(attribute) : color_by_scale(attribute, options);
  coloring.colors.per_face = domain == AttributeDomain::face;
  return coloring;
}

// Sixteen sample positions in a pixel, four packets of four; each packet has one in every quarter of the pixel.
struct Place {
  double x, y;
};
constexpr std::array<std::array<Place, 4>, 4> kPlaces{{
    {{{0.125, 0.375}, {0.625, 0.125}, {0.375, 0.875}, {0.875, 0.625}}},
    {{{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}},
    {{{0.125, 0.125}, {0.625, 0.375}, {0.375, 0.625}, {0.875, 0.875}}},
    {{{0.375, 0.375}, {0.875, 0.125}, {0.125, 0.875}, {0.625, 0.625}}},
}};

class PixelSampler {
 public:
  PixelSampler(const Camera& camera, const RayScene& scene, const SurfaceShader& shader, const Vec3& background)
      : camera_(camera), scene_(scene), shader_(shader), background_(background) {}

  /// Casts four rays, and twelve more if these disagree.
  Vec3 sample(int x, int y) const {
    constexpr double kTolerance = 0.02;
    std::array<Vec3, 4> lights;
    cast(x, y, 0, lights);
    Vec3 low = lights[0], high = lights[0], sum = Vec3::Zero();
    for (const Vec3& light : lights) {
      low = low.cwiseMin(light);
      high = high.cwiseMax(light);
      sum += light;
    }
    if ((high - low).maxCoeff() < kTolerance) return sum / 4;
    for (std::size_t packet = 1; packet < kPlaces.size(); ++packet) {
      cast(x, y, packet, lights);
      for (const Vec3& light : lights) sum += light;
    }
    return sum / 16;
  }

 private:
  void cast(int x, int y, std::size_t packet, std::array<Vec3, 4>& lights) const {
    RayScene::Packet rays;
    std::array<Vec2, 4> pixels;
    for (std::size_t i = 0; i < 4; ++i) {
      pixels[i] = {x + kPlaces[packet][i].x, y + kPlaces[packet][i].y};
      rays[i] = camera_.ray(pixels[i].x(), pixels[i].y());
    }
    const auto hits = scene_.cast(rays, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < 4; ++i) {
      // Bright spots are clamped before averaging, or outlines next to them would stay jagged.
      lights[i] = hits[i].face == kNone ? background_ : shader_.shade(hits[i], rays[i], pixels[i]).cwiseMin(1);
    }
  }

  const Camera& camera_;
  const RayScene& scene_;
  const SurfaceShader& shader_;
  const Vec3& background_;
};

// Samples the leftmost `columns` of the picture, band by band.
void cast_rays(const PixelSampler& sampler, const ShownTiles& shown, int columns, Canvas& canvas,
               const Progress& progress) {
  constexpr int kBand = 32, kTogether = 8;  // rows; rows and columns
  for (int first = 0; first < canvas.height(); first += kBand) {
    report_progress(progress, "picture", static_cast<double>(first) / canvas.height());
    const int last = std::min(first + kBand, canvas.height());
    tbb::parallel_for(tbb::blocked_range2d<int>(first, last, kTogether, 0, columns, kTogether), [&](const auto& block) {
      for (int y = block.rows().begin(); y < block.rows().end(); ++y) {
        for (int x = block.cols().begin(); x < block.cols().end(); ++x) {
          if (shown.may_show_mesh(x, y)) canvas.at(x, y) = sampler.sample(x, y);
        }
      }
    });
  }
}

Image draw(const TriMesh& mesh, const RenderOptions& options, Coloring coloring, bool with_legend,
           const Progress& progress) {
  constexpr double kBytesPerPixel = 28;
  require_memory(double(options.width) * options.height * kBytesPerPixel, "a picture of this size", "make it smaller");
  const int reserved = with_legend ? legend_width(coloring.legend, options.width, options.height) : 0;
  const Camera camera(mesh, options, reserved);
  const RayScene scene(mesh);
  const SurfaceShader shader(mesh, options, camera, scene, std::move(coloring.colors), progress);
  const Vec3 background = linear_from_srgb(options.background);
  const PixelSampler sampler(camera, scene, shader, background);
  const ShownTiles shown(mesh, camera, options.width, options.height);
  Canvas canvas(options.width, options.height, background);
  cast_rays(sampler, shown, options.width - reserved, canvas, progress);
  if (with_legend) draw_legend(canvas, coloring.legend, background);
  return canvas.image();
}

}  // namespace

Image render(const TriMesh& mesh, const RenderOptions& options, const Progress& progress) {
  check_options(options);
  check_mesh(mesh);
  return draw(mesh, options, {}, false, progress);
}

Image render(const TriMesh& mesh, const MeshAttribute& attribute, AttributeDomain domain, const RenderOptions& options,
             const Progress& progress) {
  check_options(options);
  check_mesh(mesh);
  return draw(mesh, options, make_coloring(mesh, attribute, domain, options), options.legend, progress);
}

}  // namespace vmesh
