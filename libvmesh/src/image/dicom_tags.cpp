#include "dicom_tags.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>

#include <gdcmAttribute.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include "vmesh/core/error.h"

#include "image_header.h"

namespace vmesh::image {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

const Tag kModality(0x0008, 0x0060), kSeriesDescription(0x0008, 0x103e), kSeriesUid(0x0020, 0x000e);
const Tag kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037), kFrames(0x0028, 0x0008);
const Tag kPixelSpacing(0x0028, 0x0030), kSliceStep(0x0018, 0x0088);
const Tag kIntercept(0x0028, 0x1052), kSlope(0x0028, 0x1053), kSegmentationType(0x0062, 0x0001);
const Tag kSharedGroups(0x5200, 0x9229), kFrameGroups(0x5200, 0x9230);
const Tag kPlanePosition(0x0020, 0x9113), kPlaneOrientation(0x0020, 0x9116), kPixelMeasures(0x0028, 0x9110);
const Tag kRescaling(0x0028, 0x9145), kSegmentOfFrame(0x0062, 0x000a);
const Tag kPixelData(0x7fe0, 0x0010);

/// The element's printable text, trimmed; empty if there is no such element.
std::string text_of(const DataSet& data, const Tag& tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetPointer() == nullptr) return {};
  std::string text(value->GetPointer(), value->GetLength());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  text.erase(0, text.find_first_not_of(' '));
  for (char& c : text)
    if (c < 0x20 || c == 0x7f) c = '?';
  return text;
}

/// The numbers of an element of decimal strings: `count` of them or none.
std::vector<double> decimals_of(const DataSet& data, const Tag& tag, std::size_t count) {
  std::string text = text_of(data, tag);
  for (char& c : text)
    if (c == '\\') c = ' ';
  if (text.empty()) return {};
  try {
    std::vector<double> numbers = numbers_in(text, "", "");
    for (const double number : numbers)
      if (!std::isfinite(number)) return {};
    if (numbers.size() == count) return numbers;
  } catch (const InvalidInput&) {
  }
  return {};
}

/// The element's unsigned short, or `otherwise`.
template <std::uint16_t group, std::uint16_t element>
std::size_t short_of(const DataSet& data, std::size_t otherwise) {
  const Tag tag(group, element);
  if (!data.FindDataElement(tag)) return otherwise;
  const gdcm::ByteValue* value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetLength() < sizeof(std::uint16_t)) return otherwise;
  gdcm::Attribute<group, element> attribute;
  attribute.SetFromDataSet(data);
  return static_cast<std::size_t>(attribute.GetValue());
}

std::vector<DataSet> items_of(const DataSet& data, const Tag& tag) {
  std::vector<DataSet> items;
  if (!data.FindDataElement(tag)) return items;
  const gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = data.GetDataElement(tag).GetValueAsSQ();
  if (!sequence) return items;
  for (std::size_t i = 1; i <= sequence->GetNumberOfItems(); ++i)
    items.push_back(sequence->GetItem(i).GetNestedDataSet());
  return items;
}

/// Reads everything but the voxels. Throws InvalidInput.
void read_tags(gdcm::Reader& reader, const std::filesystem::path& path) {
  reader.SetFileName(path.c_str());
  if (!reader.ReadUpToTag(kPixelData, {kPixelData}))
    throw InvalidInput(path.string() +
                       ": this DICOM file is damaged or cut off; fetch it again, or take it out of the folder");
}

/// Whether the items of compressed voxels are complete up to their end marker.
bool fragments_end(const std::filesystem::path& path, std::uint64_t begin) {
  constexpr std::uint32_t kItem = 0xe000fffe, kEnd = 0xe0ddfffe;  // as they are stored, the group first
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(begin));
  for (std::array<unsigned char, 8> head; file.read(reinterpret_cast<char*>(head.data()), head.size());) {
    const auto number = [&](std::size_t at) {
      return head[at] | head[at + 1] << 8u | head[at + 2] << 16u | static_cast<std::uint32_t>(head[at + 3]) << 24u;
    };
    if (number(0) == kEnd) return true;
    if (number(0) != kItem) return false;
    file.seekg(number(4), std::ios::cur);
  }
  return false;
}

std::size_t frames_of(const DataSet& data) {
  const std::vector<double> frames = decimals_of(data, kFrames, 1);
  return frames.empty() || !(frames[0] >= 1 && frames[0] <= 1e7) ? 1 : static_cast<std::size_t>(frames[0]);
}

/// The groups of attributes of a frame; single slices have the attributes in the file itself.
class FrameGroups {
 public:
  FrameGroups(const DataSet& data, const DataSet& shared, const DataSet& own)
      : data_(data), shared_(shared), own_(own) {}

  /// The data set of `group`, or the file's own if there is none.
  DataSet in(const Tag& group) const {
    for (const DataSet* place : {&own_, &shared_}) {
      std::vector<DataSet> items = items_of(*place, group);
      if (!items.empty()) return std::move(items.front());
    }
    return data_;
  }

 private:
  const DataSet &data_, &shared_, &own_;
};

DicomSlice slice_of(const DicomFile& file, const FrameGroups& groups, std::size_t frame) {
  const std::vector<double> position = decimals_of(groups.in(kPlanePosition), kPosition, 3);
  const std::vector<double> axes = decimals_of(groups.in(kPlaneOrientation), kOrientation, 6);
  const std::vector<double> spacing = decimals_of(groups.in(kPixelMeasures), kPixelSpacing, 2);
  if (position.empty() || axes.empty() || spacing.empty())
    throw InvalidInput(file.path.string() +
                       ": does not say where its slices lie (ImagePositionPatient, ImageOrientationPatient, "
                       "PixelSpacing); give the original series of slices");
  const Vec3 row(axes[0], axes[1], axes[2]), column(axes[3], axes[4], axes[5]);
  constexpr double kRounding = 1e-2;
  if (std::abs(row.norm() - 1) > kRounding || std::abs(column.norm() - 1) > kRounding ||
      std::abs(row.dot(column)) > kRounding || !(spacing[0] > 0) || !(spacing[1] > 0))
    throw InvalidInput(file.path.string() + ": its axes are not perpendicular, or the spacing is not above 0");
  DicomSlice slice{file.path, frame, Vec3(position.data()), {}, file.columns, file.rows};
  slice.steps.col(0) = spacing[1] * row.normalized();  // the spacing of rows comes first
  slice.steps.col(1) = spacing[0] * column.normalized();
  const DataSet rescaling = groups.in(kRescaling);
  const std::vector<double> slope = decimals_of(rescaling, kSlope, 1),
                            intercept = decimals_of(rescaling, kIntercept, 1);
  if (!slope.empty() && slope[0] != 0) slice.slope = slope[0];
  if (!intercept.empty()) slice.intercept = intercept[0];
  return slice;
}

DicomVoxels voxels_of(const DataSet& data, const FrameGroups& groups) {
  DicomVoxels voxels;
  voxels.bits = short_of<0x0028, 0x0100>(data, 16);
  const std::vector<double> step = decimals_of(groups.in(kPixelMeasures), kSliceStep, 1);
  if (!step.empty()) voxels.slice_step = std::abs(step[0]);
  return voxels;
}

void check_supported(const DataSet& data, const DicomFile& file) {
  const std::string name = file.path.string();
  if (const std::size_t samples = short_of<0x0028, 0x0002>(data, 1); samples != 1)
    throw Unsupported(name + ": has " + std::to_string(samples) +
                      " numbers per voxel, like colour pictures; give "
                      "an image with one");
  if (text_of(data, kSegmentationType) == "FRACTIONAL")
    throw Unsupported(name + ": a segmentation by fractions is not supported; store it as binary, or as .nii.gz");
}

}  // namespace

std::optional<DicomFile> identify(const std::filesystem::path& path) {
  gdcm::Reader reader;
  read_tags(reader, path);
  const DataSet& data = reader.GetFile().GetDataSet();
  gdcm::MediaStorage storage;
  storage.SetFromFile(reader.GetFile());
  DicomFile file{path, text_of(data, kSeriesUid), text_of(data, kModality), text_of(data, kSeriesDescription)};
  file.rows = short_of<0x0028, 0x0010>(data, 0);
  file.columns = short_of<0x0028, 0x0011>(data, 0);
  if (file.rows == 0 || file.columns == 0) {
    if (!gdcm::MediaStorage::IsImage(storage)) return std::nullopt;
    throw InvalidInput(path.string() +
                       ": this DICOM file is damaged or cut off: it does not say how large its image is");
  }
  file.many_frames = frames_of(data) > 1 || data.FindDataElement(kFrameGroups);
  if (file.many_frames) file.series = path.string();
  return file;
}

void check_not_cut_off(const std::filesystem::path& path, std::size_t bytes) {
  gdcm::Reader reader;
  read_tags(reader, path);
  const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  if (syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian)
    throw Unsupported(path.string() + ": deflated DICOM files are not supported; store the series anew");
  const std::uint64_t begin = reader.GetStreamCurrentPosition();
  if (syntax.IsEncapsulated() ? fragments_end(path, begin) : std::filesystem::file_size(path) >= begin + bytes) return;
  throw InvalidInput(path.string() + ": this DICOM file is cut off: voxels are missing; fetch it again");
}

std::vector<DicomSlice> slices_of(const DicomFile& file, DicomVoxels* voxels) {
  gdcm::Reader reader;
  read_tags(reader, file.path);
  const DataSet& data = reader.GetFile().GetDataSet();
  check_supported(data, file);
  const std::vector<DataSet> shared = items_of(data, kSharedGroups), frames = items_of(data, kFrameGroups);
  const std::size_t count = frames_of(data);
  const DataSet none;
  if (count > 1 && frames.size() != count)
    throw Unsupported(file.path.string() + ": does not say where each of its " + std::to_string(count) +
                      " frames lies; give a series of slices, or .nii.gz");
  std::vector<DicomSlice> slices;
  for (std::size_t f = 0; f < count; ++f) {
    const FrameGroups groups(data, shared.empty() ? none : shared.front(), frames.empty() ? none : frames[f]);
    slices.push_back(slice_of(file, groups, f));
    const std::vector<DataSet> segment = frames.empty() ? frames : items_of(frames[f], kSegmentOfFrame);
    if (!segment.empty()) slices.back().segment = static_cast<int>(short_of<0x0062, 0x000b>(segment.front(), 0));
    if (f == 0 && voxels != nullptr) *voxels = voxels_of(data, groups);
  }
  return slices;
}

}  // namespace vmesh::image
