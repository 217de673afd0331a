#include <cstring>
#include <string>
#include <vector>

#include <png.h>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/render/image.h"

namespace vmesh {
namespace {

namespace fs = std::filesystem;

std::vector<char> encode(const fs::path& path, const Image& image) {
  png_image header;
  std::memset(&header, 0, sizeof header);
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::vector<char> bytes(size);
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr)) {
    throw WriteError(path.string() + ": cannot be encoded as PNG: " + header.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace

void write_png(const fs::path& path, const Image& image) {
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != count) {
    throw InvalidInput("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                       " pixels with " + std::to_string(image.pixels.size()) + " of them cannot be written");
  }
  AtomicFile file(path);
  const std::vector<char> bytes = encode(path, image);
  file.write({bytes.data(), bytes.size()});
  file.commit();
}

}  // namespace vmesh
