// Inputs are never changed, outputs appear complete or not at all, and what cannot be written is refused at once.
#include <csignal>
#include <fstream>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>

#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

namespace fs = std::filesystem;

class Outputs : public CommandTest {
 protected:
  Outputs() { write_y("y.swc"); }

  /// Runs, and expects the exit code, a message with `text`, and the folder as it was.
  void expect_refused(const std::vector<std::string>& arguments, int exit_code, const std::string& text) const {
    const auto before = files();
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(files(), before);
  }
};

TEST_F(Outputs, MissingInputIsBadInput) { expect_refused({"generate", "@none.swc", "-o", "@y.ply"}, 3, "none.swc"); }

TEST_F(Outputs, BrokenInputIsBadInputAndNamesTheLine) {
  write("bad.swc", "1 0 0 0 0 3.0 -1\n2 0 0 x 20 2.8 1\n");
  expect_refused({"generate", "@bad.swc", "-o", "@y.ply"}, 3, "line 2");
}

TEST_F(Outputs, UnknownFormatsAreUnsupported) {
  expect_refused({"generate", "@y.swc", "-o", "@y.xyz"}, 4, "y.xyz");
  expect_refused({"generate", "@y.swc", "-o", "@y"}, 4, ".ply");
  write("y.doc", "");
  expect_refused({"generate", "@y.doc", "-o", "@y.ply"}, 4, "y.doc");
  expect_refused({"convert", "@y.swc", "-o", "@y.xyz"}, 4, "y.xyz");
}

TEST_F(Outputs, FoldersThatCannotTakeTheFileAreRefused) {
  fs::create_directory(path("folder.ply"));
  expect_refused({"generate", "@y.swc", "-o", "@none/y.ply"}, 5, "none");
  expect_refused({"generate", "@y.swc", "-o", "@folder.ply"}, 5, "folder");
  expect_refused({"generate", "@y.swc", "-o", "@y.ply", "--json", "@none/y.json"}, 5, "none");
}

TEST_F(Outputs, AFullDiskIsReported) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Outcome run = vmesh({"info", "@y.swc", "--json", "/dev/full"});
  EXPECT_EQ(run.exit_code, 5) << run.err;
}

TEST_F(Outputs, TheInputIsNeverOverwritten) {
  const std::string before = read("y.swc");
  fs::create_symlink(path("y.swc"), path("symbolic.swc"));
  fs::create_hard_link(path("y.swc"), path("hard.swc"));
  fs::create_directory(path("folder"));
  for (const char* output : {"@y.swc", "@symbolic.swc", "@hard.swc", "@folder/../y.swc"})
    expect_refused({"convert", "@y.swc", "-o", output}, 2, "is an input");
  expect_refused({"generate", "@y.swc", "-o", "@y.ply", "--json", "@hard.swc"}, 2, "is an input");
  expect_refused({"info", "@y.swc", "--json", "@symbolic.swc"}, 2, "is an input");
  EXPECT_EQ(read("y.swc"), before);
}

TEST_F(Outputs, TheSecondFileOfACsvPairIsAnInputToo) {
  ASSERT_EQ(vmesh({"convert", "@y.swc", "-o", "@y.csv"}).exit_code, 0);
  ASSERT_TRUE(exists("y.segments.csv"));
  expect_refused({"convert", "@y.csv", "-o", "@y.nodes.csv"}, 2, "is an input");
}

TEST_F(Outputs, SurfaceAndSummaryMayNotShareAFile) {
  expect_refused({"generate", "@y.swc", "-o", "@y.ply", "--json", "@y.ply"}, 2, "given both for");
}

TEST_F(Outputs, LinksInACircleAndNamesTooLongCannotBeWritten) {
  fs::create_symlink("b.ply", path("a.ply"));
  fs::create_symlink("a.ply", path("b.ply"));
  expect_refused({"generate", "@y.swc", "-o", "@a.ply"}, 5, "a.ply");
  expect_refused({"generate", "@y.swc", "-o", "@y.ply", "--json", "@a.ply"}, 5, "a.ply");
  const std::string longest = std::string(251, 'a') + ".ply";
  expect_refused({"generate", "@y.swc", "-o", "@a" + longest}, 5, "too long");
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@" + longest});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(exists(longest));
}

TEST_F(Outputs, AFileBeyondTheLimitOfSizesCannotBeWritten) {
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit = {4096, before.rlim_max};  // enough for what is said
  setrlimit(RLIMIT_FSIZE, &limit);
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply"});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("y.ply"), std::string::npos) << run.err;
  EXPECT_EQ(files(), std::vector<std::string>{"y.swc"});
}

TEST_F(Outputs, ThePermissionsOfAReplacedFileAreKept) {
  write("y.ply", "old");
  fs::permissions(path("y.ply"), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  EXPECT_EQ(fs::status(path("y.ply")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Outputs, ASignalEndsTheWaitForThePipesReader) {
  ASSERT_EQ(::mkfifo(path("y.ply").c_str(), 0600), 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    Process process = start({"generate", "@y.swc", "-o", "@y.ply"});
    // It waits once the last log line before writing is out and nothing follows.
    for (int i = 0; i < 3000 && process.err().find("segments") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    process.send(signal);
    const Outcome run = process.finish();
    EXPECT_EQ(run.exit_code, 130) << run.err;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"y.ply", "y.swc"}));
}

TEST_F(Outputs, APipeTakesASurface) {
  ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
  std::string content;
  std::thread reader([&] { content = read_file(path("pipe.ply")); });
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@pipe.ply"});
  reader.join();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  EXPECT_FALSE(content.empty());
  EXPECT_EQ(content, read("y.ply"));
}

TEST_F(Outputs, PipesAndDevicesAreNoInput) {
  ASSERT_EQ(::mkfifo(path("pipe.swc").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(path("pipe.ply").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", path("endless.swc"));
  expect_refused({"generate", "@pipe.swc", "-o", "@y.ply"}, 3, "pipe");
  expect_refused({"info", "@pipe.ply"}, 3, "pipe");
  expect_refused({"generate", "@endless.swc", "-o", "@y.ply"}, 3, "device");
}

TEST_F(Outputs, ControlCharactersInNamesAreNotPrinted) {
  const std::string name = "a\x1b[31m\nvmesh: all is well\x7f\xc2\x9b.swc";
  const Outcome missing = vmesh({"generate", "@" + name, "-o", "@y.ply"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("a?[31m?vmesh: all is well??.swc"), std::string::npos) << missing.err;
  EXPECT_EQ(std::count(missing.err.begin(), missing.err.end(), '\n'), 1) << missing.err;

  write_y(name);
  const Outcome told = vmesh({"info", "@" + name});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  const Outcome misspelt = vmesh({"generate", "--\x1b[31m"});
  EXPECT_EQ(misspelt.exit_code, 2);
  for (const std::string& text : {missing.err, told.out, told.err, misspelt.err})
    EXPECT_EQ(text.find_first_of("\x1b\x7f"), std::string::npos) << text;
}

#ifndef __SANITIZE_ADDRESS__  // which takes more of the address space than any limit would leave
TEST_F(Outputs, WhatTheMemoryDoesNotHoldIsRefusedBeforeItStarts) {
  rlimit before = {};
  getrlimit(RLIMIT_AS, &before);
  const rlimit limit = {300'000'000'000, before.rlim_max};  // less than the twig below needs
  setrlimit(RLIMIT_AS, &limit);
  write("twig.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 0 0 0 0.001 -1\n2 0 0 0 2800 0.001 1\n");
  expect_refused({"generate", "@twig.swc", "-o", "@y.ply", "--around", "40", "--max-vertices", "1000000000"}, 4,
                 "of memory");
  write("image.nrrd",
        "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 10000 10000 3999\nspace "
        "directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n");
  std::filesystem::resize_file(path("image.nrrd"), 400'000'000'000);  // takes no space
  expect_refused({"reference", "@image.nrrd", "-o", "@y.ply"}, 4, "of memory");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@grown.ply"}).exit_code, 0);
  expect_refused(
      {"fit", "@grown.ply", "@grown.ply", "--centerline", "@y.swc", "-o", "@y.ply", "--max-vertices", "1000000000"}, 4,
      "of memory");
  setrlimit(RLIMIT_AS, &before);
}

TEST_F(Outputs, ImagesThatTheMemoryDoesNotHoldAreRefusedBeforeTheyAreMade) {
  // A box of 6 x 6 x 6 mm in an image of 10 x 10 x 10.
  std::string voxels(1000, '\0');
  for (std::size_t k = 2; k < 8; ++k)
    for (std::size_t j = 2; j < 8; ++j) voxels.replace((k * 10 + j) * 10 + 2, 6, 6, '\1');
  write("box.nrrd",
        "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 10 10 10\nspace directions: "
        "(1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n\n" +
            voxels);
  rlimit before = {};
  getrlimit(RLIMIT_AS, &before);
  const rlimit limit = {8'000'000'000, before.rlim_max};
  setrlimit(RLIMIT_AS, &limit);
  // 2.0e9 voxels of 8 bytes; 2^31 would be too many whatever the memory.
  for (const std::vector<std::string>& verb : {std::vector<std::string>{"generate"}, {"centerline"}, {"reference"}}) {
    std::vector<std::string> arguments = verb;
    arguments.insert(arguments.end(), {"@box.nrrd", "--spacing", "0.0079"});
    arguments.insert(arguments.end(), {"-o", verb.front() == "centerline" ? "@new.json" : "@new.ply"});
    expect_refused(arguments, 4, "of memory");
  }
  setrlimit(RLIMIT_AS, &before);
}
#endif

TEST_F(Outputs, AnOlderFileIsReplacedOnSuccessOnly) {
  write("y.ply", "old");
  write("bad.swc", "no numbers\n");
  ASSERT_EQ(vmesh({"generate", "@bad.swc", "-o", "@y.ply"}).exit_code, 3);
  EXPECT_EQ(read("y.ply"), "old");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  EXPECT_GT(read_surface(path("y.ply")).mesh.faces.size(), 0u);
}

}  // namespace
}  // namespace vmesh::testing
