#pragma once

#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/render/image.h"

#include "render/camera.h"

namespace vmesh {

/// A picture being drawn, in linear light.
class Canvas {
 public:
  Canvas(int width, int height, const Vec3& background);

  int width() const { return width_; }
  int height() const { return height_; }
  Vec3& at(int x, int y) { return light_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)]; }

  /// Blends `light` over a pixel with the given opacity; does nothing outside the picture.
  void blend(int x, int y, const Vec3& light, double opacity);
  /// Fills the axis-parallel rectangle between two corners, its borders anti-aliased.
  void fill(const Vec2& low, const Vec2& high, const Vec3& light);
  /// Draws a line with round ends, anti-aliased.
  void stroke(const Vec2& from, const Vec2& to, double thickness, const Vec3& light);

  Image image() const;

 private:
  int width_, height_;
  std::vector<Vec3> light_;
};

/// Distance of `p` from the segment a b.
double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b);

}  // namespace vmesh
