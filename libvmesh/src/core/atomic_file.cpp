#include "vmesh/core/atomic_file.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vmesh/core/error.h"

#include "replacing.h"

namespace vmesh {

namespace fs = std::filesystem;

/// Buffers output to a file descriptor, which it closes, and remembers the first error.
class AtomicFile::Buffer : public std::streambuf {
 public:
  Buffer(int descriptor, bool may_wait) : descriptor_(descriptor), may_wait_(may_wait) { clear(); }
  ~Buffer() override { close(); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  int error() const { return error_; }
  int descriptor() const { return descriptor_; }

  bool close() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
    descriptor_ = -1;
    return error_ == 0;
  }

 protected:
  int_type overflow(int_type next) override {
    if (sync() != 0) return traits_type::eof();
    return traits_type::eq_int_type(next, traits_type::eof()) ? traits_type::not_eof(next)
                                                              : sputc(traits_type::to_char_type(next));
  }

  int sync() override {
    const char* at = pbase();
    while (at < pptr() && error_ == 0) {
      const ssize_t written = ::write(descriptor_, at, static_cast<std::size_t>(pptr() - at));
      if (written >= 0) {
        at += written;
      } else if (errno != EINTR || may_wait_) {
        error_ = errno;
      }
    }
    clear();
    return error_ == 0 ? 0 : -1;
  }

 private:
  void clear() { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

  int descriptor_;
  bool may_wait_;  ///< for a reader; a signal ends the wait
  int error_ = 0;
  std::array<char, 1 << 16> bytes_;
};

namespace {

/// Passes on the permissions of the replaced file, and its owner and group as far as allowed. Bits that would give away
/// another owner's rights are left out.
void hand_on(const struct stat& replaced, int descriptor) {
  mode_t mode = replaced.st_mode & 07777;
  if (::fchown(descriptor, replaced.st_uid, replaced.st_gid) != 0) {
    mode &= ~static_cast<mode_t>(S_ISUID | S_ISGID);
    if (::fchown(descriptor, static_cast<uid_t>(-1), replaced.st_gid) !=
        0)  // the group's rights are for that group only
      mode &= ~static_cast<mode_t>(S_IRWXG) | ((mode & S_IRWXO) << 3);
  }
  ::fchmod(descriptor, mode);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), stream_(nullptr) {
  struct stat found;
  const bool exists = ::stat(path_.c_str(), &found) == 0;
  if (!exists && errno != ENOENT) fail("cannot be created", errno);
  if (exists && S_ISDIR(found.st_mode)) throw WriteError(path.string() + ": this is a folder; give the name of a file");
  const bool directly = exists && !S_ISREG(found.st_mode);
  if (!directly) path_ = behind_links(path_);
  int descriptor = -1;
  if (directly) {
    descriptor = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0 && errno == EINTR) throw Cancelled();
  } else {
    temporary_ = temporary_name(path_);
    // Users who cannot read the old file must not be able to read the new one while it is written.
    descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, exists ? 0600 : 0666);
  }
  if (descriptor < 0) {
    const int reason = errno;
    temporary_.clear();
    fail("cannot be created", reason);
  }
  if (exists && !directly) hand_on(found, descriptor);
  buffer_ = std::make_unique<Buffer>(descriptor, directly);
  stream_.rdbuf(buffer_.get());
}

AtomicFile::~AtomicFile() {
  if (committed_ || temporary_.empty()) return;
  buffer_->close();
  ::unlink(temporary_.c_str());
}

void AtomicFile::fail(const char* what, int error) const {
  if (error == EINTR) throw Cancelled();
  std::string text = path_.string() + ": " + what;
  if (error != 0) text += std::string(": ") + std::strerror(error);
  throw WriteError(text + "; check the name, the folder, its permissions and the free space");
}

void AtomicFile::commit() {
  if (committed_) return;
  if (!stream_.flush()) fail("cannot be written completely", buffer_->error());
  if (!temporary_.empty() && ::fsync(buffer_->descriptor()) != 0) fail("cannot be written completely", errno);
  if (!buffer_->close()) fail("cannot be written completely", buffer_->error());
  if (!temporary_.empty()) {
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be put in place", errno);
    sync_folder(path_.parent_path());
  }
  committed_ = true;
}

void check_can_be_written(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) return;  // a device or a pipe
  const AtomicFile probe(path);  // removed, as it is not committed
}

}  // namespace vmesh
