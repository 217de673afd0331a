#include "vmesh/image/image_io.h"

#include <algorithm>
#include <string_view>

#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/memory.h"

#include "dicom_files.h"
#include "image_header.h"
#include "read_by_itk.h"
#include "unpack.h"

namespace vmesh {
namespace {

using image::ImageHeader;
using image::NumberType;

ImageHeader parse_header(std::string_view content, const std::string& file_name, const std::string& name) {
  if (file_name.ends_with(".nrrd")) return image::parse_nrrd_header(content, name);
  if (file_name.ends_with(".mha")) return image::parse_meta_header(content, name);
  const bool packed = content.starts_with("\x1f\x8b");
  if (packed != file_name.ends_with(".gz"))
    throw InvalidInput(name +
                       (packed ? ": is compressed with gzip; name it .nii.gz" : ": is not compressed with gzip"));
  constexpr std::uint64_t kLongestHeader = 540;
  return image::parse_nifti_header(packed ? image::unpacked(content, kLongestHeader) : content, name);
}

/// Throws if `packed` is too short to contain the voxels, or if there is not enough memory for them, as stored and as
/// float.
void check_size(std::string_view packed, const ImageHeader& header, const std::string& name) {
  constexpr double kMostUnpacked = 1032;  // bytes from one, by deflate
  const auto voxels = static_cast<double>(header.voxels()), bytes = static_cast<double>(bytes_of(header.type));
  if (voxels * bytes > kMostUnpacked * static_cast<double>(packed.size()))
    throw InvalidInput(name + ": the header claims " + std::to_string(header.voxels()) +
                       " voxels, more than the compressed file can contain; it is broken or incomplete");
  require_memory(voxels * (bytes + sizeof(float)),
                 name + ": an image of " + std::to_string(header.voxels()) + " voxels",
                 "crop it to the vessels, or store larger voxels");
}

/// The bytes of all voxels: part of `content`, or uncompressed into `store`. Throws InvalidInput if there are fewer.
std::string_view voxel_bytes(std::string_view content, const ImageHeader& header, bool all_packed, std::string& store,
                             const std::string& name) {
  const std::uint64_t needed = header.voxels() * bytes_of(header.type);
  if (all_packed || header.packed) check_size(content, header, name);
  if (all_packed) content = store = image::unpacked(content, header.data_begin + needed);
  content.remove_prefix(static_cast<std::size_t>(std::min<std::uint64_t>(header.data_begin, content.size())));
  if (header.packed) content = store = image::unpacked(content, needed);
  if (content.size() < needed)
    throw InvalidInput(name + ": the header claims " + std::to_string(header.voxels()) + " voxels, " +
                       std::to_string(needed) + " bytes, but the file holds " + std::to_string(content.size()) +
                       "; it is broken or incomplete");
  return content;
}

std::vector<float> values_of(std::string_view bytes, const ImageHeader& header, const std::string& name) {
  std::vector<float> values(header.voxels());
  image::read_numbers(bytes, {header.type, header.big_endian, header.slope, header.intercept}, values, name);
  return values;
}

/// Whether there is a parser here; other formats are read through ITK.
bool has_own_format(const std::filesystem::path& path) {
  const std::string name = image::folded(path.filename().string());
  for (const char* ending : {".nii", ".nii.gz", ".nrrd", ".mha"})
    if (name.ends_with(ending)) return true;
  return false;
}

}  // namespace

bool is_image_path(const std::filesystem::path& path) {
  const std::string name = image::folded(path.filename().string());
  for (const char* ending : {".mhd", ".nhdr", ".hdr", ".img", ".dcm"})
    if (name.ends_with(ending)) return true;
  return has_own_format(path);
}

bool is_image(const std::filesystem::path& path) { return is_image_path(path) || image::is_dicom(path); }

LoadedImage parse_image(std::string_view content, const std::string& source) {
  if (!has_own_format(source))
    throw Unsupported(source + ": images are .nii, .nii.gz, .nrrd or .mha, or a folder of DICOM files");
  const std::string file_name = image::folded(std::filesystem::path(source).filename().string());
  const ImageHeader header = parse_header(content, file_name, source);
  check_place(header, source);
  std::string store;
  const std::string_view bytes = voxel_bytes(content, header, file_name.ends_with(".gz"), store, source);
  LoadedImage loaded;
  loaded.image.size = {header.size[0], header.size[1], header.size[2]};
  loaded.image.origin = header.origin;
  loaded.image.steps = header.steps;
  loaded.image.values = values_of(bytes, header, source);
  loaded.integer = is_integer(header.type) && header.slope == 1 && header.intercept == 0;
  loaded.warnings = header.warnings;
  return loaded;
}

LoadedImage read_image(const std::filesystem::path& path) {
  std::error_code error;
  const bool own = has_own_format(path) && !std::filesystem::is_directory(path, error);
  return own || !is_image(path) ? parse_image(read_file(path), path.string()) : image::read_by_itk(path);
}

}  // namespace vmesh
