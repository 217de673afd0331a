#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vmesh {

/// A regular file, open for reading. Pipes and devices are refused and never waited for: what is read is read twice,
/// once for its content and once for its SHA-256.
class InputFile {
 public:
  /// Throws ReadError when it is missing, a folder, a pipe or a device, or cannot be opened.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uint64_t size() const { return size_; }  ///< when it was opened; 0 for what the system makes up as it is read

  /// The next bytes, as many as there is room for or left; 0 at the end. Throws ReadError.
  std::size_t read(std::span<char> bytes);

 private:
  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The whole file. Throws as InputFile does, InvalidInput when it is empty, and Unsupported when it is larger than the
/// memory that is free.
std::string read_file(const std::filesystem::path& path);

}  // namespace vmesh
