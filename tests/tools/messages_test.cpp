// Messages of the command: they say what to do next.
#include <chrono>
#include <csignal>
#include <thread>

#include <nlohmann/json.hpp>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class Messages : public CommandTest {
 protected:
  Messages() {
    write_y("y.swc");
    // A box without lid and bottom.
    write("tube.off",
          "OFF\n8 8 0\n0 0 0\n2 0 0\n2 3 0\n0 3 0\n0 0 5\n2 0 5\n2 3 5\n0 3 5\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n"
          "3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n");
  }

  void expect_says(const std::vector<std::string>& arguments, int exit_code, const std::string& text) const {
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(text), std::string::npos) << run.err;
  }
};

TEST_F(Messages, InfoTellsOpeningsAreaBoxAndUnitOfAnOpenSurface) {
  const Outcome run = vmesh({"info", "@tube.off", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(run.out);
  EXPECT_EQ(report.at("openings").at("count"), 2);
  EXPECT_EQ(report.at("topology").at("openings"), 2);
  for (const auto& opening : report.at("openings").at("largest")) {
    EXPECT_DOUBLE_EQ(opening.at("area_mm2").get<double>(), 6);
    EXPECT_EQ(opening.at("edges"), 4);
    EXPECT_DOUBLE_EQ(opening.at("center_mm")[0].get<double>(), 1);
    EXPECT_DOUBLE_EQ(opening.at("center_mm")[1].get<double>(), 1.5);
  }
  EXPECT_DOUBLE_EQ(report.at("area_mm2").get<double>(), 50);
  EXPECT_EQ(report.at("box_mm").at("to"), nlohmann::json({2.0, 3.0, 5.0}));
  EXPECT_EQ(report.at("unit_in_file"), "unknown");

  const auto in_cm = nlohmann::json::parse(vmesh({"info", "@tube.off", "--unit", "cm", "--json", "-"}).out);
  EXPECT_DOUBLE_EQ(in_cm.at("area_mm2").get<double>(), 5000);
}

TEST_F(Messages, AFileOfTheWrongKindIsAnsweredWithTheVerbThatTakesIt) {
  expect_says({"cones", "@tube.off", "-o", "@y.ply"}, 4, "vmesh centerline " + path("tube.off").string() + " -o ");
  expect_says({"cones", "@tube.off", "-o", "@y.ply"}, 4, "extract one first");
  expect_says({"cones", "@scan.nii.gz", "-o", "@y.ply"}, 4, "vmesh centerline " + path("scan.nii.gz").string());
  expect_says({"render", "@y.swc", "-o", "@y.png"}, 4, "vmesh generate " + path("y.swc").string() + " -o y.ply");
  expect_says({"evaluate", "@y.swc"}, 4, "vmesh generate");
  expect_says({"render", "@scan.nii.gz", "@y.png"}, 4,
              "vmesh reference " + path("scan.nii.gz").string() + " -o scan.ply");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"convert", "@scan.mha", "@y.ply"}, {"convert", "@scan.mha", "@y.swc"}}) {
    expect_says(arguments, 4, "vmesh reference " + path("scan.mha").string() + " -o scan.ply");
    expect_says(arguments, 4, "vmesh centerline " + path("scan.mha").string() + " -o scan.centerline.json");
  }
  expect_says({"convert", "@tube.off", "@y.swc"}, 2, "see vmesh centerline");
  expect_says({"convert", "@y.swc", "@y.ply"}, 2, "see vmesh generate");
  ASSERT_EQ(vmesh({"convert", "@y.swc", "-o", "@line.vtp"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@tube.off", "-o", "@wall.vtp"}).exit_code, 0);
  expect_says({"render", "@line.vtp", "-o", "@y.png"}, 3, "vmesh generate");
  expect_says({"cones", "@wall.vtp", "-o", "@y.ply"}, 3, "vmesh centerline");
}

TEST_F(Messages, AnUnknownVerbIsAnsweredWithTheNearestAndAll) {
  for (const auto& [typed, meant] : {std::pair{"genrate", "generate"}, {"inof", "info"}, {"eval", "evaluate"}}) {
    const Outcome run = vmesh({typed});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find("did you mean " + std::string(meant) + "?"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("convert, "), std::string::npos) << run.err;
  }
  const Outcome run = vmesh({"xyzzy"});
  EXPECT_EQ(run.err.find("did you mean"), std::string::npos) << run.err;
}

TEST_F(Messages, AWarningComesOnce) {
  const Outcome run = vmesh({"evaluate", "@tube.off"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(occurrences(run.err, "warning: "), 2u) << run.err;
  EXPECT_EQ(occurrences(run.err, "does not say its unit; taken as mm (set it with --unit "), 1u) << run.err;
  EXPECT_EQ(occurrences(run.err, "does not say its frame; taken as LPS (set it with --space "), 1u) << run.err;
}

TEST_F(Messages, AWarningNamesTheOptionOfItsFile) {
  write("bare.swc", "1 0 0 0 0 3.0 -1\n2 0 0 0 20 2.8 1\n");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply"}).exit_code, 0);
  const Outcome run = vmesh({"evaluate", "@y.ply", "--reference", "@tube.off", "--centerline", "@bare.swc"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* option : {"--reference-unit ", "--reference-space ", "--centerline-unit ", "--centerline-space "})
    EXPECT_EQ(occurrences(run.err, std::string("(set it with ") + option), 1u) << option << run.err;
}

TEST_F(Messages, PointsAndRangesAreWrittenAsTheHelpHasThem) {
  const Outcome help = vmesh({"render", "--help"});
  EXPECT_NE(help.out.find("--look-at X,Y,Z"), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("--range A,B"), std::string::npos) << help.out;
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const Outcome run = vmesh({"render", "@y.ply", "-o", "@y.png", "--look-at", "-1,0.5,20", "--view-height", "9",
                             "--color", "radius", "--range", "1,2.5", "--width", "64", "--height", "64"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  expect_says({"render", "@y.ply", "-o", "@y.png", "--look-at", "1,2"}, 2, "needs 3 numbers");
  expect_says({"render", "@y.ply", "-o", "@y.png", "--range", "1,nan"}, 2, "is not a number");
}

TEST_F(Messages, ALogGetsALineOfProgressEveryFewSeconds) {
  ASSERT_EQ(vmesh({"synth", "--vertices", "20000", "-o", "@large.json"}).exit_code, 0);
  Process process = start({"generate", "@large.json", "-o", "@large.ply", "--around", "12", "--threads", "1"});
  const auto has_progress = [&] { return process.err().find(" %") != std::string::npos; };
  for (int i = 0; i < 3000 && !has_progress(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(has_progress()) << process.err();
  process.send(SIGINT);
  process.finish();
}

TEST_F(Messages, HelpHasOptionsUnderHeadings) {
  const std::string help = vmesh({"generate", "--help"}).out;
  for (const char* heading :
       {"\nHow to read the input:", "\nResolution:", "\nShape:", "\nHow it is made:", "\nChecks:"}) {
    EXPECT_NE(help.find(heading), std::string::npos) << heading << help;
  }
}

TEST_F(Messages, QuietMeansNoProgress) {
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.ply", "--quiet"});
  EXPECT_EQ(run.err, "");
}

}  // namespace
}  // namespace vmesh::testing
