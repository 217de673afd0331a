#include "render/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vmesh {
namespace {

double decode(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }
double encode(double l) { return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055; }

// B. Ottosson, "A perceptual color space for image processing", 2020.
Vec3 linear_from_oklab(double lightness, double a, double b) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  const Vec3 rgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                 -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                 -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s);
  return rgb.cwiseMax(0).cwiseMin(1);
}

}  // namespace

Vec3 linear_from_srgb(const Color& color) {
  return {decode(color[0] / 255.0), decode(color[1] / 255.0), decode(color[2] / 255.0)};
}

Color srgb_from_linear(const Vec3& light) {
  // Finer than the result's steps everywhere: sRGB is steepest at black, with 12.92.
  constexpr int kSteps = 1 << 14;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
      t[static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(std::lround(255 * encode(static_cast<double>(i) / kSteps)));
    }
    return t;
  }();
  const auto look_up = [](double l) { return table[static_cast<std::size_t>(std::clamp(l, 0.0, 1.0) * kSteps + 0.5)]; };
  return {look_up(light.x()), look_up(light.y()), look_up(light.z())};
}

Vec3 color_scale(double t) {
  struct Chroma {
    double a, b;
  };
  // Violet, blue, teal, green, yellow.
  constexpr std::array<Chroma, 5> kKnots{
      {{0.085, -0.115}, {-0.005, -0.110}, {-0.075, -0.020}, {-0.120, 0.085}, {-0.040, 0.175}}};
  const double x = std::clamp(t, 0.0, 1.0) * (kKnots.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), kKnots.size() - 2);
  const double f = x - static_cast<double>(i);
  const auto mix = [f](double p, double q) { return p + f * (q - p); };
  return linear_from_oklab(0.30 + 0.62 * std::clamp(t, 0.0, 1.0), mix(kKnots[i].a, kKnots[i + 1].a),
                           mix(kKnots[i].b, kKnots[i + 1].b));
}

Vec3 category_color(double label) {
  // The golden angle separates the hues of nearby numbers; alternating lightness separates numbers with similar hues.
  constexpr std::array<double, 3> kLightness{0.72, 0.56, 0.84};
  constexpr double kChroma = 0.14;
  const double number = std::round(label), turns = number * (3 - std::sqrt(5.0)) / 2;
  const double hue = 2 * std::numbers::pi * (turns - std::floor(turns));
  const auto level = static_cast<std::size_t>(number - 3 * std::floor(number / 3));
  return linear_from_oklab(kLightness[level], kChroma * std::cos(hue), kChroma * std::sin(hue));
}

Color label_color(double label) { return srgb_from_linear(category_color(label)); }

}  // namespace vmesh
