#include "vmesh/core/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <unistd.h>

#include "vmesh/core/error.h"

namespace vmesh {

namespace fs = std::filesystem;

AtomicFile::AtomicFile(const fs::path& path) : path_(path) {
  std::error_code error;
  // A link stays a link: its target is replaced.
  if (fs::is_symlink(path_, error)) {
    const fs::path target = fs::weakly_canonical(path_, error);
    if (!error) path_ = target;
  }
  const auto status = fs::status(path_, error);
  if (fs::is_directory(status)) throw WriteError(path.string() + ": this is a folder; give the name of a file");
  fs::path opened = path_;
  if (!fs::exists(status) || fs::is_regular_file(status)) {
    static std::atomic<unsigned> counter = 0;
    temporary_ = path_;
    temporary_.replace_filename("." + path_.filename().string() + "." + std::to_string(::getpid()) + "-" +
                                std::to_string(counter++) + ".tmp");
    opened = temporary_;
  }
  errno = 0;
  stream_.open(opened, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    temporary_.clear();
    fail("cannot be created");
  }
}

AtomicFile::~AtomicFile() {
  if (committed_ || temporary_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::fail(const char* what) {
  const int number = errno;
  std::string text = path_.string() + ": " + what;
  if (number != 0) text += std::string(": ") + std::strerror(number);
  throw WriteError(text + "; check the folder, its permissions and the free space");
}

void AtomicFile::commit() {
  if (committed_) return;
  errno = 0;
  if (!stream_.flush()) fail("cannot be written completely");
  stream_.close();
  if (!stream_) fail("cannot be written completely");
  if (!temporary_.empty()) {
    std::error_code error;
    fs::rename(temporary_, path_, error);
    if (error) {
      errno = error.value();
      fail("cannot be put in place");
    }
  }
  committed_ = true;
}

}  // namespace vmesh
