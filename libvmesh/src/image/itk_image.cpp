// Header and voxels in two files, through ITK.
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

/// What an exception of ITK says, without the object that says it, on one line.
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

/// With its header read.
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

/// Analyze has no field for the frame: what left and right are is a custom.
bool is_analyze(const std::filesystem::path& path) {
  constexpr std::size_t kMagic = 344;
  std::filesystem::path header = path;
  if (lower_extension(path) == ".img") header.replace_extension(path.extension() == ".IMG" ? ".HDR" : ".hdr");
  if (lower_extension(header) != ".hdr") return false;
  char magic[4] = {};
  std::ifstream file(header, std::ios::binary);
  file.seekg(kMagic);
  file.read(magic, sizeof magic);
  return std::string_view(magic, 2) != "ni";
}

/// Runs `work`, with what ITK throws as InvalidInput.
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
                  ": Analyze files do not say what is left and right, and where they lie; as ITK takes it is assumed\n";
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
    io->Read(stored.get());
    read_numbers({stored.get(), bytes}, {type, std::endian::native == std::endian::big}, values, name);
    return Warnings();
  });
}

}  // namespace vmesh::image
