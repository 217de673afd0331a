#include "replacing.h"

#include <array>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include "vmesh/core/error.h"

namespace vmesh {

namespace fs = std::filesystem;

fs::path behind_links(fs::path path) {
  constexpr int kMostLinks = 40;  // like the kernel, which has found no cycle
  for (int i = 0; i < kMostLinks; ++i) {
    std::error_code no_link;
    const fs::path target = fs::read_symlink(path, no_link);
    if (no_link) break;
    path = path.parent_path() / target;  // just the target if that is absolute
  }
  return path;
}

fs::path temporary_name(const fs::path& path) {
  std::array<unsigned char, 16> random;
  if (::getentropy(random.data(), random.size()) != 0)
    throw WriteError(path.string() + ": the system provides no random numbers for the name of a temporary file");
  std::string name = ".vmesh-";
  for (const unsigned char byte : random) {
    constexpr const char* kDigits = "0123456789abcdef";
    name += kDigits[byte >> 4];
    name += kDigits[byte & 15];
  }
  return fs::path(path).replace_filename(name + ".tmp");
}

void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace vmesh
