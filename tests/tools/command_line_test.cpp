#include "vmesh/core/version.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

const char* const kVerbs[] = {"generate", "info", "synth", "convert", "render", "reference", "cones", "centerline"};

using CommandLine = CommandTest;

TEST_F(CommandLine, VersionGoesToStdout) {
  const Outcome run = vmesh({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "vmesh " + std::string(version()) + "\n");
  EXPECT_EQ(run.err, "");
}

TEST_F(CommandLine, HelpNamesEveryVerbAndTheExitCodes) {
  const Outcome run = vmesh({"--help"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* verb : kVerbs) EXPECT_NE(run.out.find(verb), std::string::npos) << verb;
  EXPECT_NE(run.out.find("130 interrupted"), std::string::npos);
  EXPECT_EQ(run.err, "");
}

TEST_F(CommandLine, HelpOfEveryVerbShowsExamples) {
  for (const char* verb : kVerbs) {
    const Outcome run = vmesh({verb, "--help"});
    EXPECT_EQ(run.exit_code, 0) << verb;
    EXPECT_NE(run.out.find("Examples:\n  vmesh " + std::string(verb)), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "") << verb;
  }
}

TEST_F(CommandLine, UsageErrorsExitWithTwoAndKeepStdoutClean) {
  write_y("y.swc");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"grow"},
      {"generate"},
      {"generate", "@y.swc"},
      {"generate", "@y.swc", "-o", "@y.ply", "--no-such-option"},
      {"generate", "@y.swc", "-o", "@y.ply", "--beta", "2"},
      {"generate", "@y.swc", "-o", "@y.ply", "--beta", "nan"},
      {"generate", "@y.swc", "-o", "@y.ply", "--around", "six"},
      {"generate", "@y.swc", "-o", "@y.ply", "--unit", "parsec"},
      {"synth", "-o", "@t.swc", "--vertices", "1"},
      {"convert", "@y.swc", "-o", "@y.ply"},
      {"reference", "@y.swc", "-o", "@y.ply"},
      {"reference", "@y.swc", "-o", "@y.ply", "--voxel", "1", "--label", "2"},
      {"reference", "@y.swc", "-o", "@y.ply", "--voxel", "nan"},
      {"reference", "@y.nii", "-o", "@y.ply", "--voxel", "1"},
      {"reference", "@y.nii", "-o", "@y.ply", "--label", "1", "--threshold", "1"},
      {"cones", "@y.swc", "-o", "@y.ply", "--sides", "2"},
      {"centerline", "@y.ply", "-o", "@y.json", "--label", "2"},
      {"centerline", "@y.ply", "-o", "@y.json", "--step", "0"},
  };
  for (const auto& arguments : wrong) {
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 2) << (arguments.empty() ? "no verb" : arguments.back());
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err, "");
  }
  EXPECT_EQ(files(), std::vector<std::string>{"y.swc"});
}

}  // namespace
}  // namespace vmesh::testing
