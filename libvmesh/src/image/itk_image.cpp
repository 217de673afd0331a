// Header and voxels in two files, through ITK.
#include <algorithm>
#include <bit>
#include <fstream>
#include <limits>
#include <memory>

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include "vmesh/core/error.h"

#include "foreign_image.h"
#include "number_type.h"

namespace vmesh::image {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

/// The message of an ITK exception on one line, without the object that reports it.
std::string reason(const itk::ExceptionObject& error) {
  std::string text = error.GetDescription();
  if (const std::size_t end = text.find("): "); text.starts_with("ITK ERROR") && end != std::string::npos)
    text.erase(0, end + 3);
  for (char& c : text)
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  constexpr std::size_t kMostShown = 300;
  return text.substr(0, kMostShown);
}

NumberType number_type(itk::ImageIOBase::IOComponentEnum type, const std::string& name) {
  using Type = itk::ImageIOBase::IOComponentEnum;
  constexpr bool kLong = sizeof(long) == 8;
  switch (type) {
    case Type::UCHAR:
      return NumberType::u8;
    case Type::CHAR:
      return NumberType::i8;
    case Type::USHORT:
      return NumberType::u16;
    case Type::SHORT:
      return NumberType::i16;
    case Type::UINT:
      return NumberType::u32;
    case Type::INT:
      return NumberType::i32;
    case Type::ULONG:
      return kLong ? NumberType::u64 : NumberType::u32;
    case Type::LONG:
      return kLong ? NumberType::i64 : NumberType::i32;
    case Type::ULONGLONG:
      return NumberType::u64;
    case Type::LONGLONG:
      return NumberType::i64;
    case Type::FLOAT:
      return NumberType::f32;
    case Type::DOUBLE:
      return NumberType::f64;
    default:
      throw Unsupported(name +
                        ": voxels of this type are not supported; store integers or real numbers, one per voxel");
  }
}

bool is_pair(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".hdr" || extension == ".img";
}

/// One file of a NIfTI or Analyze pair: `lower` and `upper` are its extension in lower and upper case.
std::filesystem::path part_of_pair(std::filesystem::path path, const char* lower, const char* upper) {
  if (lower_extension(path) == lower) return path;
  const bool shouts = path.extension() == ".IMG" || path.extension() == ".HDR";
  return path.replace_extension(shouts ? upper : lower);
}

/// The first bytes of a NIfTI-1 or Analyze header.
std::string beginning_of_header(const std::filesystem::path& path) {
  std::string header(348, '\0');
  std::ifstream file(part_of_pair(path, ".hdr", ".HDR"), std::ios::binary);
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  return header;
}

/// Analyze has no field for the frame: left and right are a matter of convention.
bool is_analyze(const std::filesystem::path& path) {
  constexpr std::size_t kMagic = 344;
  return is_pair(path) && beginning_of_header(path).compare(kMagic, 2, "ni") != 0;
}

/// ITK silently fills what is missing in the second file of a pair with 0.
void check_pair_is_complete(const std::filesystem::path& path, std::size_t voxels) {
  const std::filesystem::path data = part_of_pair(path, ".img", ".IMG");
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(data, error);
  if (error) throw InvalidInput(path.string() + ": " + data.string() + " is needed, uncompressed, and cannot be read");
  const std::string header = beginning_of_header(path);
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(header[at])); };
  constexpr std::size_t kBits = 72;
  const bool big_endian = byte(0) == 0;  // of 348, the first number of a header
  const std::size_t bits = big_endian ? byte(kBits) << 8u | byte(kBits + 1) : byte(kBits) | byte(kBits + 1) << 8u;
  if (size >= voxels * (bits / 8)) return;
  throw InvalidInput(data.string() + ": is cut off: " + std::to_string(voxels * (bits / 8)) + " bytes are claimed, " +
                     std::to_string(size) + " are there");
}

void check_one_data_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("ElementDataFile")) continue;
    if (line.find("LIST") == std::string::npos && line.find('%') == std::string::npos) return;
    throw Unsupported(path.string() + ": voxels in many files are not supported; store them in one");
  }
}

/// The ITK reader of a file, with the header read.
itk::ImageIOBase::Pointer opened(const std::filesystem::path& path) {
  const std::string name = path.string(), extension = lower_extension(path);
  itk::ImageIOBase::Pointer io;
  if (extension == ".mhd") {
    io = itk::MetaImageIO::New().GetPointer();
  } else if (extension == ".nhdr") {
    io = itk::NrrdImageIO::New().GetPointer();
  } else {
    io = itk::NiftiImageIO::New().GetPointer();
  }
  if (!io->CanReadFile(name.c_str()))
    throw InvalidInput(name + ": its header is damaged, or of another kind, or the file that belongs to it is missing");
  if (extension == ".mhd") check_one_data_file(path);
  io->SetFileName(name);
  io->ReadImageInformation();
  if (io->GetNumberOfComponents() != 1)
    throw Unsupported(name + ": has " + std::to_string(io->GetNumberOfComponents()) +
                      " numbers per voxel; give an image of one");
  for (unsigned a = 3; a < io->GetNumberOfDimensions(); ++a)
    if (io->GetDimensions(a) != 1)
      throw Unsupported(name + ": has " + std::to_string(io->GetNumberOfDimensions()) +
                        " dimensions; give an image of 3");
  if (io->GetNumberOfDimensions() < 3)
    throw InvalidInput(name + ": has " + std::to_string(io->GetNumberOfDimensions()) +
                       " dimensions; give an image of 3");
  return io;
}

/// Reads all voxels. If the file ends too early, MetaIO silently leaves the rest of the buffer unchanged; that is
/// detected by checking that earlier contents were overwritten.
void read_whole(itk::ImageIOBase& io, std::span<char> stored, std::size_t of_voxel, const std::string& name) {
  constexpr char kMark = '\x5a', kOtherMark = '\x69';
  const std::span<char> last = stored.last(of_voxel);
  std::fill(last.begin(), last.end(), kMark);
  io.Read(stored.data());
  if (std::find(last.begin(), last.end(), kMark) == last.end()) return;
  const std::string before(last.begin(), last.end());
  std::fill(last.begin(), last.end(), kOtherMark);
  io.Read(stored.data());
  if (before != std::string_view(last.data(), last.size()))
    throw InvalidInput(name + ": the file with its voxels is cut off");
}

/// Runs `work`, turning ITK's exceptions into InvalidInput.
template <class Work>
auto with_itk(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const itk::ExceptionObject& error) {
    throw InvalidInput(path.string() + ": cannot be read; it is damaged or incomplete: " + reason(error));
  }
}

}  // namespace

ForeignHeader itk_header(const std::filesystem::path& path, Warnings& warnings) {
  return with_itk(path, [&] {
    const itk::ImageIOBase::Pointer io = opened(path);
    ForeignHeader header;
    for (unsigned a = 0; a < 3; ++a) {
      header.size[a] = io->GetDimensions(a);
      header.origin[a] = io->GetOrigin(a);
      for (unsigned b = 0; b < 3; ++b) header.steps[a][b] = io->GetDirection(a)[b] * io->GetSpacing(a);
    }
    const NumberType type = number_type(io->GetComponentType(), path.string());
    header.bytes = bytes_of(type);
    header.integer = is_integer(type);
    if (is_analyze(path))
      warnings += path.string() +
                  ": Analyze files do not say which side is left and where they lie; ITK's convention is assumed\n";
    return header;
  });
}

Warnings itk_voxels(const std::filesystem::path& path, std::span<float> values) {
  return with_itk(path, [&] {
    const std::string name = path.string();
    const itk::ImageIOBase::Pointer io = opened(path);
    itk::ImageIORegion all(io->GetNumberOfDimensions());
    for (unsigned a = 0; a < io->GetNumberOfDimensions(); ++a) all.SetSize(a, io->GetDimensions(a));
    io->SetIORegion(all);
    const NumberType type = number_type(io->GetComponentType(), name);
    if (static_cast<std::uint64_t>(io->GetImageSizeInPixels()) != values.size())
      throw InvalidInput(name + ": has changed while it was read");
    const std::size_t bytes = values.size() * bytes_of(type);
    const auto stored = std::make_unique_for_overwrite<char[]>(bytes);
    if (is_pair(path)) check_pair_is_complete(path, values.size());
    read_whole(*io, {stored.get(), bytes}, bytes_of(type), name);
    read_numbers({stored.get(), bytes}, {type, std::endian::native == std::endian::big}, values, name);
    return Warnings();
  });
}

}  // namespace vmesh::image
