#pragma once

#include "vmesh/core/types.h"
#include "vmesh/render/image.h"

// Colours as light: linear red, green, blue in [0, 1]. Pixels are sRGB.
namespace vmesh {

Vec3 linear_from_srgb(const Color& color);
Color srgb_from_linear(const Vec3& light);

/// The colour scale of attributes, t in [0, 1]: dark violet over blue and green to yellow. Lightness grows evenly (in
/// OKLab), so that equal steps look equal, also in grey.
Vec3 color_scale(double t);

/// A colour for a label (rounded to an integer), neither dark nor pale. Labels that differ by less than ten have
/// clearly distinct colours.
Vec3 category_color(double label);

/// The colour of elements without a value.
inline const Vec3 kNoValue(0.32, 0.32, 0.32);

}  // namespace vmesh
