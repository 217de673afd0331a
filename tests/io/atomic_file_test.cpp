#include "vmesh/core/atomic_file.h"

#include "vmesh/io/sha256.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::message_of;
using testing::TemporaryFolder;

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
  const TemporaryFolder folder;
  const std::string large(200000, 'a');
  EXPECT_EQ(sha256_of_file(folder.write("a", large)), sha256_of(large));
  EXPECT_THROW(sha256_of_file(folder / "none"), ReadError);
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THROW(sha256_of_file(folder / "sub"), ReadError);
}

}  // namespace
}  // namespace vmesh
