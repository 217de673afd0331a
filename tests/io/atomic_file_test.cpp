#include "vmesh/core/atomic_file.h"

#include <csignal>
#include <regex>
#include <set>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>

#include "vmesh/core/input_file.h"
#include "vmesh/io/sha256.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::message_of;
using testing::TemporaryFolder;

namespace fs = std::filesystem;

unsigned mode_of(const fs::path& path) { return static_cast<unsigned>(fs::status(path).permissions()); }

/// The names of all files in the folder.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// During its lifetime, a signal that only interrupts waiting calls arrives every 20 ms.
class Alarms {
 public:
  Alarms() {
    struct sigaction action = {};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, &before_);
    const itimerval often = {{0, 20'000}, {0, 20'000}};
    setitimer(ITIMER_REAL, &often, nullptr);
  }
  ~Alarms() {
    const itimerval never = {};
    setitimer(ITIMER_REAL, &never, nullptr);
    sigaction(SIGALRM, &before_, nullptr);
  }
  Alarms(const Alarms&) = delete;
  Alarms& operator=(const Alarms&) = delete;

 private:
  struct sigaction before_ = {};
};

/// During its lifetime, files may not be larger than `bytes`; exceeding that is a write error.
class LargestFile {
 public:
  explicit LargestFile(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~LargestFile() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LargestFile(const LargestFile&) = delete;
  LargestFile& operator=(const LargestFile&) = delete;

 private:
  rlimit before_ = {};
  void (*handler_)(int);
};

TEST(AtomicFile, AppearsOnlyWhenComplete) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("half");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
    file.write(" and half");
    file.commit();
    EXPECT_EQ(content_of(folder / "a.txt"), "half and half");
  }
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, LeavesTheOldFileWhenWritingIsGivenUp) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  try {
    AtomicFile file(folder / "a.txt");
    file.write("new");
    throw 1;
  } catch (int) {
  }
  EXPECT_EQ(content_of(folder / "a.txt"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, ReplacesWhatALinkPointsTo) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink(folder.write("target.txt", "old"), folder / "link.txt");
  AtomicFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(content_of(folder / "target.txt"), "new");
}

TEST(AtomicFile, MakesWhatADanglingLinkPointsTo) {
  const TemporaryFolder folder;
  fs::create_symlink("second", folder / "first");
  fs::create_symlink("target.txt", folder / "second");
  AtomicFile file(folder / "first");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_EQ(content_of(folder / "target.txt"), "new");
}

TEST(AtomicFile, NobodyCanGuessTheTemporaryName) {
  const TemporaryFolder folder;
  std::set<std::string> seen;
  for (int i = 0; i < 20; ++i) {
    const AtomicFile one(folder / "a.txt"), other(folder / "a.txt");
    const std::set<std::string> names = names_in(folder / "");
    EXPECT_EQ(names.size(), 2u);
    for (const std::string& name : names) {
      EXPECT_TRUE(std::regex_match(name, std::regex("\\.vmesh-[0-9a-f]{32}\\.tmp"))) << name;
      EXPECT_TRUE(seen.insert(name).second) << name;
    }
  }
}

TEST(AtomicFile, KeepsThePermissionsOfTheFileItReplaces) {
  const TemporaryFolder folder;
  for (const unsigned mode : {0600u, 0640u, 0664u, 0755u}) {
    const fs::path path = folder.write("a.txt", "old");
    fs::permissions(path, static_cast<fs::perms>(mode));
    AtomicFile file(path);
    file.write("new");
    for (const std::string& name : names_in(folder / "")) EXPECT_EQ(mode_of(folder / name), mode) << name;
    file.commit();
    EXPECT_EQ(mode_of(path), mode);
    EXPECT_EQ(content_of(path), "new");
  }
}

TEST(AtomicFile, GivesNewFilesThePermissionsThatAllNewFilesGet) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  {
    AtomicFile file(folder / "a.txt");
    file.commit();
  }
  ::umask(before);
  EXPECT_EQ(mode_of(folder / "a.txt"), 0640u);
}

TEST(AtomicFile, WritesUnderTheLongestNameThereIs) {
  const TemporaryFolder folder;
  const std::string longest(255, 'a');
  AtomicFile file(folder / longest);
  file.write("new");
  file.commit();
  EXPECT_EQ(content_of(folder / longest), "new");
  testing::expect_contains(message_of<WriteError>([&] { AtomicFile(folder / (longest + "a")); }), "too long");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, RefusesLinksInACircle) {
  const TemporaryFolder folder;
  fs::create_symlink("b", folder / "a");
  fs::create_symlink("a", folder / "b");
  testing::expect_contains(message_of<WriteError>([&] { AtomicFile(folder / "a"); }), "cannot be created");
  testing::expect_contains(message_of<WriteError>([&] { check_can_be_written(folder / "a"); }), "cannot be created");
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(AtomicFile, SaysWhenTheFileGrowsTooLarge) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  const LargestFile limit(100'000);
  AtomicFile file(folder / "a.txt");
  file.write(std::string(150'000, 'x'));
  testing::expect_contains(message_of<WriteError>([&] { file.commit(); }), "too large");
  EXPECT_EQ(content_of(folder / "a.txt"), "old");
}

TEST(AtomicFile, ASignalEndsTheWaitForAPipe) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const Alarms alarms;
  EXPECT_THROW(AtomicFile(folder / "pipe"), Cancelled);
  EXPECT_NO_THROW(check_can_be_written(folder / "pipe"));
}

TEST(InputFile, RefusesPipesAndDevicesWithoutWaiting) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  testing::expect_contains(message_of<ReadError>([&] { read_file(folder / "pipe"); }), "pipe");
  testing::expect_contains(message_of<ReadError>([&] { read_file("/dev/zero"); }), "device");
  testing::expect_contains(message_of<ReadError>([&] { sha256_of_file(folder / "pipe"); }), "pipe");
}

TEST(InputFile, ReadsWhatTheSystemMakesUp) {
  testing::expect_contains(read_file("/proc/self/status"), "Name:");  // its size is 0
}

TEST(AtomicFile, SaysWhenItCannotBeCreated) {
  const TemporaryFolder folder;
  testing::expect_contains(message_of<WriteError>([&] { AtomicFile(folder / "none/a.txt"); }), "none/a.txt");
  std::filesystem::create_directory(folder / "sub");
  testing::expect_contains(message_of<WriteError>([&] { AtomicFile(folder / "sub"); }), "folder");
}

TEST(AtomicFile, DetectsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  AtomicFile file("/dev/full");
  file.write("x");
  testing::expect_contains(message_of<WriteError>([&] { file.commit(); }), "/dev/full");
}

TEST(Sha256, MatchesThePublishedVectors) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(
      sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),  // 56 bytes: the length needs a block
      "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  const TemporaryFolder folder;
  const std::string large(200000, 'a');
  EXPECT_EQ(sha256_of_file(folder.write("a", large)), sha256_of(large));
  EXPECT_THROW(sha256_of_file(folder / "none"), ReadError);
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THROW(sha256_of_file(folder / "sub"), ReadError);
}

}  // namespace
}  // namespace vmesh
