#include "read_dicom.h"

#include <algorithm>
#include <cstring>
#include <new>

#include <sys/mman.h>

#include "vmesh/core/child_process.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/memory.h"

#include "dicom_files.h"
#include "dicom_image.h"
#include "image_header.h"

namespace vmesh::image {
namespace {

/// Memory shared with a child process, which writes the voxels.
class SharedVoxels {
 public:
  explicit SharedVoxels(std::size_t count) : count_(count) {
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

/// The files of a folder, or those beside a file, whose series it may stand for.
std::vector<std::filesystem::path> files_behind(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return dicom_files_in(path);
  const InputFile there(path);
  if (!is_dicom(path)) throw InvalidInput(path.string() + ": this is not a DICOM file: it does not start like one");
  return dicom_files_in(path.has_parent_path() ? path.parent_path() : ".");
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

DicomHeader header_of(const std::filesystem::path& path, std::size_t file_size) {
  const std::string answer = in_child_process(path.string(), file_size, [&] {
    const DicomHeader header = dicom_header(path);
    return std::string(reinterpret_cast<const char*>(&header), sizeof header);
  });
  DicomHeader header;
  if (answer.size() != sizeof header) throw InvalidInput(path.string() + ": the answer of GDCM is cut off");
  std::memcpy(static_cast<void*>(&header), answer.data(), sizeof header);
  check_place(header.origin, header.steps, path.string());
  return header;
}

}  // namespace

void read_dicom(const std::filesystem::path& path, const ImageBegin& begin, const SliceVisitor& visit) {
  const std::string name = path.string();
  const std::size_t file_size = size_of(files_behind(path));
  const DicomHeader header = header_of(path, file_size);
  const std::size_t area = header.size[0] * header.size[1], count = area * header.size[2];
  // Per voxel besides the values: what the library needs, then what is returned.
  const std::size_t more = std::max(header.bytes, sizeof(float));
  require_memory(static_cast<double>(count) * static_cast<double>(sizeof(float) + more),
                 name + ": an image of " + std::to_string(count) + " voxels",
                 "crop it to the vessels, or store larger voxels");
  const SharedVoxels voxels(count);
  const std::string warnings = in_child_process(name, file_size, [&] { return dicom_voxels(path, voxels.values()); });
  ImageFrame image{{header.size, {}, header.origin, header.steps}, header.integer, {}};
  std::string_view rest = warnings;
  for (std::string_view line; take_line(rest, line);) image.warnings.emplace_back(line);
  begin(image);
  for (std::size_t k = 0; k < header.size[2]; ++k) visit(k, voxels.values().subspan(k * area, area));
}

}  // namespace vmesh::image
