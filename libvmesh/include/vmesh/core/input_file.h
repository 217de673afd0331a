#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vmesh {

/// A regular file, open for reading. Pipes and devices are refused without waiting for them: every input is read twice,
/// once for its content and once for its SHA-256.
class InputFile {
 public:
  /// Throws ReadError when it is missing, a folder, a pipe or a device, or cannot be opened.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uint64_t size() const {
    return size_;
  }  ///< when it was opened; 0 for files the system generates as they are read

  /// Reads the next bytes, as many as fit or remain; returns their number, 0 at the end. Throws ReadError.
  std::size_t read(std::span<char> bytes);

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The whole file. Throws like InputFile, InvalidInput when it is empty, and Unsupported when it is larger than the
/// free memory.
std::string read_file(const std::filesystem::path& path);

}  // namespace vmesh
