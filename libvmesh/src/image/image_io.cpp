#include "vmesh/image/image_io.h"

#include <algorithm>
#include <span>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/image/image_slices.h"

#include "dicom_files.h"
#include "image_header.h"

namespace vmesh {
namespace {

/// Appends a slice of an image of `voxels` voxels. Memory grows as slices arrive, as what a compressed file holds may
/// be less than its header claims. Capacities are the whole, a third of it, a ninth and so on: values move early, and
/// need at most 16 bytes for every voxel there is.
void append(std::span<const float> slice, std::size_t voxels, std::vector<float>& values) {
  constexpr std::size_t kGrowth = 3;
  const std::size_t needed = values.size() + slice.size();
  if (needed > values.capacity()) {
    std::size_t capacity = voxels;
    while (capacity / kGrowth >= needed) capacity /= kGrowth;
    values.reserve(capacity);
  }
  values.insert(values.end(), slice.begin(), slice.end());
}

/// The image whose slices `read` reads, given what to call first and what for every slice.
template <class Read>
LoadedImage collected(const std::string& name, Read read) {
  LoadedImage loaded;
  std::size_t voxels = 0;
  const auto begin = [&](const ImageFrame& image) {
    loaded = {image.frame, image.integer, image.warnings, image.segments};
    voxels = image.frame.size[0] * image.frame.size[1] * image.frame.size[2];
    require_memory(static_cast<double>(voxels) * sizeof(float),
                   name + ": an image of " + std::to_string(voxels) + " voxels",
                   "crop it to the vessels, or store larger voxels");
  };
  read(begin, [&](std::size_t, std::span<const float> slice) { append(slice, voxels, loaded.image.values); });
  return loaded;
}

}  // namespace

bool is_image_path(const std::filesystem::path& path) {
  return std::ranges::any_of(image_formats(), [&](const ImageFormat& format) {
    return !longest_extension(path, format.extensions).empty() || !longest_extension(path, format.of_parts).empty();
  });
}

bool takes_voxel_size(const std::filesystem::path& path) {
  const ImageFormat* format = find_format(image_formats(), path);
  return format != nullptr && std::ranges::find(format->options, "voxel-size") != format->options.end();
}

bool is_image(const std::filesystem::path& path) { return is_image_path(path) || image::is_dicom(path); }

std::vector<double> values_of(const std::vector<std::string>& names, const std::vector<ImageSegment>& segments) {
  std::vector<double> values;
  for (const std::string& name : names) {
    const auto found =
        std::ranges::find_if(segments, [&](const ImageSegment& segment) { return lower(segment.name) == lower(name); });
    if (found == segments.end())
      throw InvalidInput("there is no segment " + image::cited(name) + "; " + image::list_of(segments));
    values.push_back(found->value);
  }
  return values;
}

LoadedImage parse_image(std::string_view content, const std::string& source, const ImageReadOptions& options) {
  return collected(source, [&](const auto& begin, const auto& visit) {
    parse_image_slices(content, source, begin, visit, options);
  });
}

LoadedImage read_image(const std::filesystem::path& path, const ImageReadOptions& options) {
  return collected(path.string(),
                   [&](const auto& begin, const auto& visit) { read_image_slices(path, begin, visit, options); });
}

}  // namespace vmesh
