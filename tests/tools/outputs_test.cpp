// Inputs are never touched, outputs appear complete or not at all, and what cannot be written is refused at once.
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

#if !VMESH_TEST_WITH_VTK
TEST_F(Outputs, WithoutVtkItsFormatIsUnsupported) {
  expect_refused({"generate", "@y.swc", "-o", "@y.vtp"}, 4, "VTK");
  expect_refused({"convert", "@y.swc", "-o", "@y.vtp"}, 4, "VTK");
}
#endif

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
  expect_refused({"generate", "@y.swc", "-o", "@y.ply", "--json", "@y.ply"}, 2, "named for");
}

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
