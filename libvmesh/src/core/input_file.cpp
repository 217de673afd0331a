#include "vmesh/core/input_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"

namespace vmesh {

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);  // does not wait for pipes
  if (descriptor_ < 0 && errno == ENOENT) throw ReadError(name_ + ": there is no such file; check the name");
  if (descriptor_ < 0) throw ReadError(name_ + ": cannot be opened: " + std::strerror(errno));
  struct stat found = {};
  const char* what = nullptr;
  if (::fstat(descriptor_, &found) != 0) {
    what = ": cannot be read; give a file";
  } else if (S_ISDIR(found.st_mode)) {
    what = ": this is a folder; give a file";
  } else if (!S_ISREG(found.st_mode)) {
    what = ": this is a pipe or a device, but files are read twice; save its output to a file first";
  }
  if (what != nullptr) {
    ::close(descriptor_);
    throw ReadError(name_ + what);
  }
  size_ = static_cast<std::uint64_t>(found.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(std::span<char> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count == 0) break;
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      throw ReadError(name_ + ": cannot be read: " + std::strerror(errno));
    }
  }
  return done;
}

std::string read_file(const std::filesystem::path& path) {
  InputFile file(path);
  require_memory(static_cast<double>(file.size()), path.string() + ": reading a file of this size",
                 "give a smaller one, or part of it");
  std::string content;
  content.reserve(file.size());
  char block[1 << 16];
  while (const std::size_t count = file.read(block)) content.append(block, count);
  if (content.empty()) throw InvalidInput(path.string() + ": the file is empty");
  return content;
}

}  // namespace vmesh
