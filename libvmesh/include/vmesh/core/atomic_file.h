#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string_view>

namespace vmesh {

/// A file that appears under its name either complete or not at all: written in the same folder under a temporary name
/// that cannot be guessed or planted, then synced to disk and renamed by commit(). Without commit() the temporary file
/// is removed and an existing file of that name stays as it was; a replaced file passes on its permissions. A symbolic
/// link stays a link, and its target is replaced. Anything but a regular file (/dev/stdout, a pipe) is written
/// directly.
class AtomicFile {
 public:
  /// Throws WriteError when the folder does not exist or cannot be written, and when `path` is a folder, is too long or
  /// is a cycle of links. Waits for the reader of a pipe; a signal whose handler does not restart system calls ends
  /// this wait, and every later one, with Cancelled.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  void write(std::string_view bytes) { stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); }

  /// Finishes the file. Throws WriteError when any byte could not be written (disk full ...).
  void commit();

 private:
  class Buffer;

  [[noreturn]] void fail(const char* what, int error) const;

  std::filesystem::path path_, temporary_;  // temporary_ is empty when written directly
  std::unique_ptr<Buffer> buffer_;
  std::ostream stream_;
  bool committed_ = false;
};

/// Throws the WriteError that AtomicFile would; leaves nothing behind, and opens regular files only.
void check_can_be_written(const std::filesystem::path& path);

}  // namespace vmesh
