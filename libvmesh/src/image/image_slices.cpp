#include "vmesh/image/image_slices.h"

#include <algorithm>
#include <optional>

#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/memory.h"
#include "vmesh/image/image_io.h"

#include "byte_source.h"
#include "image_header.h"
#include "read_dicom.h"

namespace vmesh {
namespace {

using image::ByteSource;
using image::ImageHeader;
using image::PeekedBytes;

/// Whether all of a file is compressed. Throws InvalidInput if its name says otherwise.
bool is_packed(PeekedBytes& file, const ImageFormat& format, const std::string& name) {
  if (!format.compressed_whole) return false;
  const bool packed = file.peek(2) == "\x1f\x8b";
  if (packed != (extension_of(name) == ".gz"))
    throw InvalidInput(name +
                       (packed ? ": is compressed with gzip; name it .nii.gz" : ": is not compressed with gzip"));
  return packed;
}

std::uint64_t numbers_needed(const ImageHeader& header) { return header.voxels() * header.layers; }

std::uint64_t bytes_needed(const ImageHeader& header) { return numbers_needed(header) * size_of(header.type); }

[[noreturn]] void refuse_incomplete(const ImageHeader& header, std::uint64_t bytes, const std::string& name) {
  throw InvalidInput(name + ": the header claims " + std::to_string(header.voxels()) + " voxels, " +
                     std::to_string(bytes_needed(header)) + " bytes, but the file holds " + std::to_string(bytes) +
                     "; it is broken or incomplete");
}

/// Throws if a file of that size is too short to contain the voxels, or if there is not enough memory for a slice.
void check_size(std::uint64_t file_size, const ImageHeader& header, bool packed, const std::string& name) {
  constexpr double kMostUnpacked = 1032;  // bytes from one, by deflate
  const std::uint64_t bytes = file_size - std::min(file_size, header.data_begin);
  if (!packed && bytes < bytes_needed(header)) refuse_incomplete(header, bytes, name);
  if (packed && static_cast<double>(bytes_needed(header)) > kMostUnpacked * static_cast<double>(file_size))
    throw InvalidInput(name + ": the header claims " + std::to_string(header.voxels()) +
                       " voxels, more than the compressed file can contain; it is broken or incomplete");
  require_memory(static_cast<double>(header.size[0] * header.size[1] * header.layers) * sizeof(float),
                 name + ": a slice of " + std::to_string(header.size[0] * header.size[1]) + " voxels",
                 "crop it to the vessels, or store larger voxels");
}

ImageFrame frame_of(const ImageHeader& header) {
  ImageFrame image;
  image.frame.size = {header.size[0], header.size[1], header.size[2]};
  image.frame.origin = header.origin;
  image.frame.steps = header.steps;
  image.integer = is_integer(header.type) && header.slope == 1 && header.intercept == 0;
  image.warnings = header.warnings;
  image.segments = header.segments;
  return image;
}

/// Reads the values of voxels in blocks, whatever the size of slices.
class VoxelReader {
 public:
  VoxelReader(ByteSource& bytes, const ImageHeader& header, const std::string& name)
      : bytes_(bytes), header_(header), name_(name), block_(kBlock) {}

  /// The next values. `values` grows as they are read, so that its memory is bounded by what the file holds, whatever
  /// its header claims.
  void read(std::uint64_t count, std::vector<float>& values) {
    for (std::uint64_t done = 0; done < count;) {
      if (begin_ == end_) fill();
      const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(count - done, end_ - begin_));
      if (values.size() < done + step) values.resize(done + step);
      const std::size_t width = size_of(header_.type);
      image::read_numbers({block_.data() + begin_ * width, step * width},
                          {header_.type, header_.big_endian, header_.slope, header_.intercept},
                          std::span(values).subspan(done, step), name_, voxels_ - (end_ - begin_));
      begin_ += step;
      done += step;
    }
  }

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;

  /// Reads the next block. Throws InvalidInput if voxels are missing.
  void fill() {
    const std::size_t width = size_of(header_.type);
    begin_ = 0;
    end_ = static_cast<std::size_t>(std::min<std::uint64_t>(numbers_needed(header_) - voxels_, kBlock / width));
    const std::size_t count = bytes_.read(std::span(block_).first(end_ * width));
    if (count < end_ * width) refuse_incomplete(header_, voxels_ * width + count, name_);
    voxels_ += end_;
  }

  ByteSource& bytes_;
  const ImageHeader& header_;
  const std::string& name_;
  std::vector<char> block_;
  std::size_t begin_ = 0, end_ = 0;  ///< voxels in the block that have not been used
  std::uint64_t voxels_ = 0;         ///< read so far, up to the end of the block
};

/// The chosen segments of an image of several layers. Throws InvalidInput if there are none, or if a value is that of
/// several segments.
std::vector<ImageSegment> chosen_segments(const ImageHeader& header, const ImageReadOptions& options,
                                          const std::string& name) {
  const auto is_named = [&](const ImageSegment& segment) {
    return std::ranges::any_of(options.segments, [&](const auto& word) { return lower(word) == lower(segment.name); });
  };
  std::vector<ImageSegment> chosen;
  for (const ImageSegment& segment : header.segments) {
    if (is_named(segment)) chosen.push_back(segment);
  }
  for (const double value : options.labels) {
    const auto has_value = [&](const ImageSegment& segment) { return segment.value == value; };
    if (std::ranges::any_of(chosen, has_value)) continue;
    if (std::ranges::count_if(header.segments, has_value) > 1)
      throw InvalidInput(
          name + ": several segments have the value chosen; choose by name: " + image::list_of(header.segments));
    std::ranges::copy_if(header.segments, std::back_inserter(chosen), has_value);
  }
  if (chosen.empty())
    throw InvalidInput(name + ": its segments overlap, in " + std::to_string(header.layers) +
                       " layers; choose by name or value, with --label: " + image::list_of(header.segments));
  return chosen;
}

/// One value for every voxel, from those of its layers.
void unite_layers(const std::vector<ImageSegment>& chosen, std::size_t layers, std::vector<float>& slice) {
  for (std::size_t v = 0; v < slice.size() / layers; ++v) {
    float value = 0;
    for (const ImageSegment& segment : chosen) {
      if (slice[v * layers + segment.layer] == static_cast<float>(segment.value))
        value = static_cast<float>(segment.value);
    }
    slice[v] = value;
  }
  slice.resize(slice.size() / layers);
}

void visit_voxels(ByteSource& bytes, const ImageHeader& header, const std::vector<ImageSegment>& chosen,
                  const std::string& name, const SliceVisitor& visit) {
  VoxelReader reader(bytes, header, name);
  std::vector<float> slice;
  for (std::size_t k = 0; k < header.size[2]; ++k) {
    reader.read(header.size[0] * header.size[1] * header.layers, slice);
    if (header.layers > 1) unite_layers(chosen, header.layers, slice);
    visit(k, slice);
  }
}

/// Reads the voxels from `content`, the bytes of a file of that size, unpacked if all of it is compressed.
void parse_voxels(ByteSource& content, std::uint64_t file_size, bool all_packed, ImageHeader header,
                  const std::string& name, const ImageBegin& begin, const SliceVisitor& visit,
                  const ImageReadOptions& options) {
  if (header.data_at_end) header.data_begin = file_size - std::min(file_size, bytes_needed(header));
  check_size(file_size, header, all_packed || header.packed, name);
  std::vector<ImageSegment> chosen;
  if (header.layers > 1) chosen = chosen_segments(header, options, name);
  begin(frame_of(header));
  skip(content, header.data_begin);
  if (!header.packed) return visit_voxels(content, header, chosen, name, visit);
  image::UnpackedBytes unpacked(content);
  visit_voxels(unpacked, header, chosen, name, visit);
}

/// Opens a file that belongs to the one that was given, to hold its `what`. Throws ReadError naming both.
InputFile open_second(const std::string& given, const std::filesystem::path& path, const char* what) try {
  return InputFile(path);
} catch (const ReadError& error) {
  throw ReadError(given + ": its " + what + " in another file: " + error.what());
}

/// `file_size`: of all bytes that `file` will give; `source` names it. `in_memory`: no other file belongs to it.
void parse(ByteSource& file, std::uint64_t file_size, const std::string& source, bool in_memory,
           const ImageBegin& begin, const SliceVisitor& visit, const ImageReadOptions& options) {
  const ImageFormat* format = find_format(image_formats(), source);
  if (!format) throw Unsupported(source + ": images are " + listed_image_extensions());
  if (!format->parse_header) refuse_without(format->needs, source);
  PeekedBytes stored(file);
  const bool all_packed = is_packed(stored, *format, source);
  std::optional<image::UnpackedBytes> unpacked;
  if (all_packed) unpacked.emplace(stored);
  PeekedBytes content(all_packed ? static_cast<ByteSource&>(*unpacked) : stored);
  const ImageHeader header = format->parse_header(content.peek(format->header_bytes), source);
  image::check_place(header.origin, header.steps, source);
  if (header.data_file.empty())
    return parse_voxels(content, file_size, all_packed, header, source, begin, visit, options);
  if (in_memory) throw Unsupported(source + ": its voxels are in another file; store header and voxels in one");
  const std::filesystem::path path = std::filesystem::path(source).parent_path() / header.data_file;
  InputFile data = open_second(source, path, "voxels are");
  image::BytesOfFile voxels(data);
  parse_voxels(voxels, data.size(), false, header, path.string(), begin, visit, options);
}

}  // namespace

void parse_image_slices(std::string_view content, const std::string& source, const ImageBegin& begin,
                        const SliceVisitor& visit, const ImageReadOptions& options) {
  if (const ImageFormat* format = find_format(image_formats(), source); format && format->read)
    return format->read(source, content, begin, visit, options);
  image::BytesInMemory bytes(content);
  parse(bytes, content.size(), source, true, begin, visit, options);
}

void read_image_slices(const std::filesystem::path& path, const ImageBegin& begin, const SliceVisitor& visit,
                       const ImageReadOptions& options) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error), is_img = extension_of(path) == ".img";
  const bool is_dicom = is_folder || (!is_img && find_format(image_formats(), path) == nullptr);
  if (is_dicom && is_image(path)) return image::read_dicom(path, begin, visit);
  if (is_img) {
    const std::filesystem::path header = image::other_of_pair(path, ".hdr", ".HDR");
    const InputFile there = open_second(path.string(), header, "header is");
    return read_image_slices(header, begin, visit, options);
  }
  if (const ImageFormat* format = find_format(image_formats(), path); format && format->read)
    return format->read(path.string(), std::nullopt, begin, visit, options);
  InputFile file(path);
  // Files that the system generates do not tell their size; an empty one is refused.
  if (file.size() == 0) return parse_image_slices(read_file(path), path.string(), begin, visit, options);
  image::BytesOfFile bytes(file);
  parse(bytes, file.size(), path.string(), false, begin, visit, options);
}

void visit_slices(const VoxelImage& image, const SliceVisitor& visit) {
  const std::size_t area = image.size[0] * image.size[1];
  for (std::size_t k = 0; k < image.size[2]; ++k) visit(k, std::span(image.values).subspan(k * area, area));
}

}  // namespace vmesh
