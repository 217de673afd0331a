#include "dicom_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include <gdcmImageReader.h>

#include "vmesh/core/error.h"

#include "dicom_files.h"
#include "dicom_stack.h"
#include "number_type.h"

namespace vmesh::image {
namespace {

std::string described(const std::vector<const DicomFile*>& series) {
  const DicomFile& first = *series.front();
  std::string text = first.modality.empty() ? "image" : first.modality;
  if (!first.description.empty()) text += " \"" + first.description + "\"";
  text += first.many_frames ? ", many frames in one file" : ", " + std::to_string(series.size()) + " slices";
  return text + " of " + std::to_string(first.columns) + " x " + std::to_string(first.rows) + ": " +
         first.path.string();
}

using SeriesByUid = std::map<std::string, std::vector<const DicomFile*>>;

[[noreturn]] void refuse_several(const SeriesByUid& series, const std::string& name) {
  constexpr std::size_t kMostListed = 20;
  std::string list;
  std::size_t count = 0;
  for (const auto& [uid, files] : series) {
    if (count++ == kMostListed) break;
    list += "\n  " + described(files);
  }
  if (series.size() > kMostListed) list += "\n  and " + std::to_string(series.size() - kMostListed) + " more";
  throw InvalidInput(name + ": this folder contains " + std::to_string(series.size()) +
                     " DICOM series; instead of the folder, give a file of the one you mean:" + list);
}

/// The files of the only series in a folder.
std::vector<DicomFile> only_series_in(const std::filesystem::path& folder) {
  std::vector<DicomFile> images;
  for (const std::filesystem::path& path : dicom_files_in(folder))
    if (std::optional<DicomFile> file = identify(path)) images.push_back(*std::move(file));
  if (images.empty())
    throw InvalidInput(folder.string() + ": none of its DICOM files contains an image; give the folder of the slices");
  SeriesByUid series;
  for (const DicomFile& file : images) series[file.series].push_back(&file);
  if (series.size() > 1) refuse_several(series, folder.string());
  return images;
}

/// The files of the series that a file belongs to, in the same folder.
std::vector<DicomFile> series_of(const std::filesystem::path& path) {
  const std::optional<DicomFile> named = identify(path);
  if (!named)
    throw InvalidInput(path.string() +
                       ": this DICOM file contains no image; give a slice, or the folder of the slices");
  if (named->many_frames) return {*named};
  std::vector<DicomFile> files;
  for (const std::filesystem::path& beside : dicom_files_in(path.has_parent_path() ? path.parent_path() : "."))
    if (const auto file = identify(beside); file && file->series == named->series) files.push_back(*file);
  return files;
}

struct Series {
  DicomStack stack;
  DicomVoxels voxels;
};

Series read_series(const std::filesystem::path& path) {
  std::error_code error;
  const std::vector<DicomFile> files =
      std::filesystem::is_directory(path, error) ? only_series_in(path) : series_of(path);
  Series series;
  std::vector<DicomSlice> slices;
  for (const DicomFile& file : files) {
    DicomVoxels voxels;
    for (DicomSlice& slice : slices_of(file, &voxels)) slices.push_back(std::move(slice));
    series.voxels = voxels;
  }
  series.stack = stacked(std::move(slices), series.voxels.slice_step, path.string());
  return series;
}

NumberType number_type(const gdcm::PixelFormat& format, const std::string& name) {
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      return NumberType::u8;
    case gdcm::PixelFormat::INT8:
      return NumberType::i8;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      return NumberType::u16;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      return NumberType::i16;
    case gdcm::PixelFormat::UINT32:
      return NumberType::u32;
    case gdcm::PixelFormat::INT32:
      return NumberType::i32;
    case gdcm::PixelFormat::FLOAT32:
      return NumberType::f32;
    case gdcm::PixelFormat::FLOAT64:
      return NumberType::f64;
    default:
      throw Unsupported(name + ": voxels of this type are not supported; store the image as .nii.gz");
  }
}

[[noreturn]] void fail_to_read(const std::string& name) {
  throw InvalidInput(name +
                     ": the voxels of this DICOM file cannot be read; it is damaged or cut off, or compressed in a "
                     "way that GDCM does not know; fetch it again");
}

/// The frames of a file, one after another, as they are stored.
struct StoredFrames {
  NumberType type = NumberType::u8;
  std::vector<char> bytes;
};

StoredFrames frames_of(const std::filesystem::path& path, std::size_t voxels) {
  const std::string name = path.string();
  gdcm::ImageReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read()) fail_to_read(name);
  const gdcm::Image& image = reader.GetImage();
  StoredFrames frames{number_type(image.GetPixelFormat(), name), {}};
  const std::size_t bytes = image.GetBufferLength();
  if (bytes != voxels * size_of(frames.type)) fail_to_read(name);
  check_not_cut_off(path, bytes);
  frames.bytes.resize(bytes);
  if (!image.GetBuffer(frames.bytes.data())) fail_to_read(name);
  return frames;
}

/// The same for a segmentation with one bit per voxel, lowest bit first.
StoredFrames frames_of_bits(const std::filesystem::path& path, std::size_t voxels) {
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  const gdcm::Tag pixel_data(0x7fe0, 0x0010);
  if (!reader.Read() || !reader.GetFile().GetDataSet().FindDataElement(pixel_data)) fail_to_read(path.string());
  const gdcm::ByteValue* bits = reader.GetFile().GetDataSet().GetDataElement(pixel_data).GetByteValue();
  check_not_cut_off(path, (voxels + 7) / 8);
  if (bits == nullptr || bits->GetLength() < (voxels + 7) / 8) fail_to_read(path.string());
  StoredFrames frames{NumberType::u8, std::vector<char>(voxels)};
  for (std::size_t v = 0; v < voxels; ++v)
    frames.bytes[v] = static_cast<char>(static_cast<unsigned char>(bits->GetPointer()[v / 8]) >> (v % 8) & 1);
  return frames;
}

/// The values of one frame.
void read_frame(const StoredFrames& frames, const DicomSlice& slice, std::span<float> values) {
  const std::size_t bytes = values.size() * size_of(frames.type);
  const bool big_endian = std::endian::native == std::endian::big;
  read_numbers(std::string_view(frames.bytes.data(), frames.bytes.size()).substr(slice.frame * bytes, bytes),
               {frames.type, big_endian, slice.slope, slice.intercept}, values, slice.path.string());
}

/// Writes segment numbers where a frame of a segmentation is not 0. Returns how many voxels already belonged to another
/// segment.
std::size_t label(std::span<const float> frame, int segment, std::span<float> layer) {
  std::size_t shared = 0;
  for (std::size_t v = 0; v < frame.size(); ++v) {
    if (frame[v] == 0) continue;
    shared += layer[v] != 0 ? 1 : 0;
    layer[v] = std::max(layer[v], static_cast<float>(segment));
  }
  return shared;
}

}  // namespace

DicomHeader dicom_header(const std::filesystem::path& path) {
  const auto [stack, voxels] = read_series(path);
  DicomHeader header{stack.size, stack.origin, stack.steps};
  header.bytes = std::max<std::size_t>(1, voxels.bits / 8);
  header.integer = std::all_of(stack.slices.begin(), stack.slices.end(), [](const DicomSlice& slice) {
    return slice.slope == std::floor(slice.slope) && slice.intercept == std::floor(slice.intercept);
  });
  return header;
}

std::string dicom_voxels(const std::filesystem::path& path, std::span<float> values) {
  const auto [stack, voxels] = read_series(path);
  const std::size_t area = stack.size[0] * stack.size[1];
  if (values.size() != area * stack.size[2]) throw InvalidInput(path.string() + ": has changed while it was read");
  std::map<std::filesystem::path, std::size_t> frames_in;
  for (const DicomSlice& slice : stack.slices) ++frames_in[slice.path];
  std::size_t shared = 0;
  StoredFrames frames;
  std::filesystem::path last;
  std::vector<float> segment(area);
  for (std::size_t s = 0; s < stack.slices.size(); ++s) {
    const DicomSlice& slice = stack.slices[s];
    const std::size_t count = frames_in.at(slice.path) * area;
    if (slice.path != last)
      frames = voxels.bits == 1 ? frames_of_bits(slice.path, count) : frames_of(slice.path, count);
    last = slice.path;
    const std::span<float> layer = values.subspan(stack.layer[s] * area, area);
    if (slice.segment > 0) {
      read_frame(frames, slice, segment);
      shared += label(segment, slice.segment, layer);
    } else {
      read_frame(frames, slice, layer);
    }
  }
  if (shared == 0) return {};
  return path.string() + ": " + std::to_string(shared) +
         " voxels belong to several segments; they are assigned to the one with the highest number\n";
}

}  // namespace vmesh::image
