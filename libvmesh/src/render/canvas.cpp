#include "render/canvas.h"

#include <algorithm>
#include <cmath>

#include "render/color.h"

namespace vmesh {

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

Canvas::Canvas(int width, int height, const Vec3& background)
    : width_(width),
      height_(height),
      light_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

void Canvas::blend(int x, int y, const Vec3& light, double opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Vec3& pixel = at(x, y);
  pixel += std::clamp(opacity, 0.0, 1.0) * (light - pixel);
}

void Canvas::fill(const Vec2& low, const Vec2& high, const Vec3& light) {
  const auto covered = [](double pixel, double from, double to) {
    return std::clamp(std::min(pixel + 1, to) - std::max(pixel, from), 0.0, 1.0);
  };
  for (int y = static_cast<int>(std::floor(low.y())); y < high.y(); ++y) {
    for (int x = static_cast<int>(std::floor(low.x())); x < high.x(); ++x) {
      blend(x, y, light, covered(x, low.x(), high.x()) * covered(y, low.y(), high.y()));
    }
  }
}

void Canvas::stroke(const Vec2& from, const Vec2& to, double thickness, const Vec3& light) {
  const double reach = thickness / 2 + 1;
  const Vec2 low = from.cwiseMin(to) - Vec2::Constant(reach), high = from.cwiseMax(to) + Vec2::Constant(reach);
  for (int y = static_cast<int>(std::floor(low.y())); y <= high.y(); ++y) {
    for (int x = static_cast<int>(std::floor(low.x())); x <= high.x(); ++x) {
      blend(x, y, light, thickness / 2 + 0.5 - distance_to_line({x + 0.5, y + 0.5}, from, to));
    }
  }
}

Image Canvas::image() const {
  Image image{width_, height_, std::vector<Color>(light_.size())};
  std::transform(light_.begin(), light_.end(), image.pixels.begin(), srgb_from_linear);
  return image;
}

}  // namespace vmesh
