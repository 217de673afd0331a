#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace vmesh {

/// Red, green, blue in sRGB.
using Color = std::array<std::uint8_t, 3>;

/// A picture: rows from the top, each from the left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;  ///< width * height

  const Color& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Writes a PNG file, under a temporary name first: `path` is complete or as it was before. Throws WriteError when it
/// cannot be written, InvalidInput for an image without pixels or whose number of pixels does not match its size.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace vmesh
