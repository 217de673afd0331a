// The system calls of AtomicFile, in order: the file must be new and not a link, and on disk before it is renamed. Not
// under sanitizers, which intercept these calls themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#include <cstdarg>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "vmesh/core/atomic_file.h"

#include "io_support.h"

namespace {

struct Call {
  std::string name, path;
  int flags = 0;
};

bool watching = false;
std::vector<Call> calls;

void note(Call call) {
  if (watching) calls.push_back(std::move(call));
}

}  // namespace

// Replaces the C library's function in this program.
extern "C" {
int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if (flags & O_CREAT) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  note({"open", path, flags});
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
int fsync(int descriptor) {
  note({"fsync", std::to_string(descriptor)});
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}
int rename(const char* from, const char* to) {
  note({"rename", from});
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}
}

namespace vmesh {
namespace {

std::vector<Call> calls_of_writing(const std::filesystem::path& path) {
  calls.clear();
  watching = true;
  {
    AtomicFile file(path);
    file.write("new");
    file.commit();
  }
  watching = false;
  return calls;
}

TEST(AtomicFileCalls, TheTemporaryFileIsNewAndNoLink) {
  const testing::TemporaryFolder folder;
  folder.write("old.txt", "old");
  for (const char* name : {"new.txt", "old.txt"}) {
    const std::vector<Call> made = calls_of_writing(folder / name);
    ASSERT_FALSE(made.empty());
    EXPECT_EQ(made[0].name, "open");
    EXPECT_NE(made[0].path, (folder / name).string());
    for (const int flag : {O_CREAT, O_EXCL, O_NOFOLLOW, O_CLOEXEC}) EXPECT_TRUE(made[0].flags & flag) << flag;
    for (std::size_t i = 1; i < made.size(); ++i) EXPECT_FALSE(made[i].flags & (O_CREAT | O_TRUNC)) << made[i].path;
  }
}

TEST(AtomicFileCalls, ItIsOnTheDiskBeforeItIsRenamedAndSoIsTheFolderAfterwards) {
  const testing::TemporaryFolder folder;
  std::vector<std::string> names;
  for (const Call& call : calls_of_writing(folder / "a.txt")) names.push_back(call.name);
  EXPECT_EQ(names, (std::vector<std::string>{"open", "fsync", "rename", "open", "fsync"}));
}

}  // namespace
}  // namespace vmesh
#endif
