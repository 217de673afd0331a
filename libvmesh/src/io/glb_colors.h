// Colours in GLB: 16 bits, linear; those of attributes: 0 to 255, sRGB (IEC 61966-2-1).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace vmesh::io {

constexpr std::array<const char*, 4> kGlbColorChannels = {"red", "green", "blue", "alpha"};
constexpr std::uint16_t kGlbColorWhite = 65535;
/// Names of accessors of colours, which tell whether there was an alpha channel.
constexpr const char* kGlbColor = "colour";
constexpr const char* kGlbColorAndAlpha = "colour and alpha";

/// Of the channel of that number. Alpha is linear everywhere.
inline std::uint16_t glb_color(double value, std::size_t channel) {
  const double v = std::isfinite(value) ? std::clamp(value / 255, 0.0, 1.0) : 0;
  const double linear = channel == 3 ? v : v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(kGlbColorWhite * linear));
}

/// The whole number of which glb_color() made `stored`.
inline double color_of_glb(double stored, std::size_t channel) {
  const double v = stored / kGlbColorWhite;
  return std::round(255 * (channel == 3 ? v : v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055));
}

}  // namespace vmesh::io
