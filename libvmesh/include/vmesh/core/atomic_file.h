#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace vmesh {

/// A file that appears under its name complete or not at all: written under a temporary name in the same folder,
/// renamed by commit(). Without commit() the temporary is removed and an older file of that name stays as it was. What
/// is no regular file (/dev/stdout, a pipe) is written directly.
class AtomicFile {
 public:
  /// Throws WriteError when the folder does not exist or cannot be written, or when `path` is a folder.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  void write(std::string_view bytes) { stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); }

  /// Finishes the file. Throws WriteError when any byte could not be written (disk full ...).
  void commit();

 private:
  [[noreturn]] void fail(const char* what);

  std::filesystem::path path_, temporary_;  // temporary_ is empty when written directly
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace vmesh
