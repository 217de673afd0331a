#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <png.h>
#include <unistd.h>

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

[[noreturn]] void fail(const fs::path& path, const char* what, int error_number) {
  std::string text = path.string() + ": " + what;
  if (error_number != 0) text += std::string(": ") + std::strerror(error_number);
  throw WriteError(text + "; check the folder, its permissions and the free space");
}

void write_bytes(const fs::path& named, const fs::path& opened, const std::vector<char>& bytes) {
  errno = 0;
  std::ofstream stream(opened, std::ios::binary | std::ios::trunc);
  if (!stream) fail(named, "cannot be created", errno);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) fail(named, "cannot be written completely", errno);
}

// Removes a temporary file unless it was renamed.
struct Temporary {
  fs::path path;
  ~Temporary() {
    std::error_code ignored;
    if (!path.empty()) fs::remove(path, ignored);
  }
};

fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> counter = 0;
  std::string name(1, '.');
  name += path.filename().string() + "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
  return fs::path(path).replace_filename(name);
}

}  // namespace

void write_png(const fs::path& path, const Image& image) {
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != count) {
    throw InvalidInput("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                       " pixels with " + std::to_string(image.pixels.size()) + " of them cannot be written");
  }
  const auto bytes = encode(path, image);

  std::error_code error;
  const fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const auto status = fs::status(target, error);
  if (fs::is_directory(status)) throw WriteError(path.string() + ": this is a folder; give the name of a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {  // a pipe or a device cannot be replaced
    write_bytes(path, target, bytes);
    return;
  }
  Temporary temporary{temporary_name(target)};
  write_bytes(path, temporary.path, bytes);
  fs::rename(temporary.path, target, error);
  if (error) fail(path, "cannot be put in place", error.value());
  temporary.path.clear();
}

}  // namespace vmesh
