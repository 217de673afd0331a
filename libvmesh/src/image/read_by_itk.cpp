#include "read_by_itk.h"

#include <algorithm>
#include <cstring>
#include <new>

#include <sys/mman.h>

#include "vmesh/core/child_process.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/memory.h"

#include "dicom_files.h"
#include "foreign_image.h"
#include "image_header.h"

namespace vmesh::image {
namespace {

/// Memory shared with a child process, which writes the voxels.
class SharedVoxels {
 public:
  explicit SharedVoxels(std::uint64_t count) : count_(count) {
    data_ = ::mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (data_ == MAP_FAILED) throw std::bad_alloc();
  }
  ~SharedVoxels() { ::munmap(data_, bytes()); }
  SharedVoxels(const SharedVoxels&) = delete;
  SharedVoxels& operator=(const SharedVoxels&) = delete;

  std::span<float> values() const { return {static_cast<float*>(data_), count_}; }

 private:
  std::size_t bytes() const { return count_ * sizeof(float); }

  std::size_t count_;
  void* data_;
};

std::vector<std::filesystem::path> files_behind(const std::filesystem::path& path, bool dicom) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return dicom_files_in(path);
  const InputFile there(path);
  if (dicom) return dicom_files_in(path.has_parent_path() ? path.parent_path() : ".");
  std::vector<std::filesystem::path> files = {path};
  for (const char* beside : {".raw", ".zraw", ".img", ".img.gz", ".raw.gz"})
    files.push_back(std::filesystem::path(path).replace_extension(beside));
  return files;
}

/// Total size of the files, which bounds the time that reading them may take.
std::size_t size_of(const std::vector<std::filesystem::path>& files) {
  std::size_t size = 0;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    if (!error) size += static_cast<std::size_t>(bytes);
  }
  return size;
}

ImageHeader header_from(const std::string& answer, const std::string& name) {
  if (answer.size() < sizeof(ForeignHeader)) throw InvalidInput(name + ": the answer of the library is cut off");
  ForeignHeader foreign;
  std::memcpy(static_cast<void*>(&foreign), answer.data(), sizeof foreign);
  ImageHeader header;
  set_size(header, {foreign.size.begin(), foreign.size.end()}, name);
  for (int a = 0; a < 3; ++a) {
    header.origin[a] = foreign.origin[a];
    header.steps.col(a) = Vec3(foreign.steps[a].data());
  }
  check_place(header, name);
  return header;
}

void add_lines(std::string_view text, std::vector<std::string>& lines) {
  for (std::string_view line; take_line(text, line);) lines.emplace_back(line);
}

}  // namespace

void read_by_itk(const std::filesystem::path& path, const ImageBegin& begin, const SliceVisitor& visit) {
  const std::string name = path.string();
  const bool dicom = is_dicom(path);
  if (!dicom && folded(path.extension().string()) == ".dcm")
    throw InvalidInput(name + ": this is not a DICOM file: it does not start like one");
  const std::size_t file_size = size_of(files_behind(path, dicom));
  const std::string answer = in_child_process(name, file_size, [&] {
    Warnings warnings;
    const ForeignHeader header = dicom ? dicom_header(path, warnings) : itk_header(path, warnings);
    return std::string(reinterpret_cast<const char*>(&header), sizeof header) + warnings;
  });
  const ImageHeader header = header_from(answer, name);
  ForeignHeader foreign;
  std::memcpy(static_cast<void*>(&foreign), answer.data(), sizeof foreign);
  ImageFrame image;
  image.integer = foreign.integer;
  add_lines(std::string_view(answer).substr(sizeof foreign), image.warnings);

  // Per voxel besides the values: what the library needs, then what is returned.
  const std::uint64_t more = std::max<std::uint64_t>(foreign.bytes, sizeof(float));
  require_memory(static_cast<double>(header.voxels()) * static_cast<double>(sizeof(float) + more),
                 name + ": an image of " + std::to_string(header.voxels()) + " voxels",
                 "crop it to the vessels, or store larger voxels");
  const SharedVoxels voxels(header.voxels());
  add_lines(
      in_child_process(name, file_size,
                       [&] { return dicom ? dicom_voxels(path, voxels.values()) : itk_voxels(path, voxels.values()); }),
      image.warnings);
  image.frame.size = {header.size[0], header.size[1], header.size[2]};
  image.frame.origin = header.origin;
  image.frame.steps = header.steps;
  begin(image);
  const std::size_t area = header.size[0] * header.size[1];
  for (std::size_t k = 0; k < header.size[2]; ++k) visit(k, voxels.values().subspan(k * area, area));
}

}  // namespace vmesh::image
