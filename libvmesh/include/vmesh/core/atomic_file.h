#pragma once

#include <filesystem>
#include <memory>
#include <ostream>
#include <string_view>

namespace vmesh {

/// A file that appears under its name complete or not at all: written under a temporary name that nobody can guess or
/// plant, in the same folder; synced to the disk and renamed by commit(). Without commit() the temporary is removed and
/// an older file of that name stays as it was; one that is replaced hands its permissions on. A link stays a link, what
/// it leads to is replaced. What is no regular file (/dev/stdout, a pipe) is written directly.
class AtomicFile {
 public:
  /// Throws WriteError when the folder does not exist or cannot be written, and when `path` is a folder, is too long or
  /// leads in a circle. Waits for the reader of a pipe; a signal whose handler does not restart calls ends that, and
  /// every later wait for it, with Cancelled.
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

/// Throws the WriteError that AtomicFile would; leaves nothing behind, and does not open what is no regular file.
void check_can_be_written(const std::filesystem::path& path);

}  // namespace vmesh
