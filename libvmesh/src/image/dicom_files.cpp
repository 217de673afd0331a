#include "dicom_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "vmesh/core/error.h"

namespace vmesh::image {
namespace {

/// Bytes up to and including the letters "DICM".
constexpr std::size_t kPreamble = 132;

bool is_dicom_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || path.filename() == "DICOMDIR") return false;
  std::array<char, kPreamble> begin;
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) && std::string_view(begin.data() + begin.size() - 4, 4) == "DICM";
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return is_dicom_file(path);
  for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    if (is_dicom_file(entry->path())) return true;
  return false;
}

std::vector<std::filesystem::path> dicom_files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_dicom_file(entry->path())) files.push_back(entry->path());
  if (error) throw ReadError(folder.string() + ": the folder cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace vmesh::image
