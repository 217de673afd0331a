// Centerlines of walls and masks, with the command.
#include <cmath>

#include <nlohmann/json.hpp>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class Extraction : public CommandTest {
 protected:
  /// A mask of two bars along x, of labels 1 and 2, 24 mm long and 5 mm thick, `gap` mm apart.
  void write_bars(const std::string& name, int gap, const std::string& more = "") const {
    constexpr int kLong = 30, kWide = 30, kHigh = 11;
    std::string voxels(kLong * kWide * kHigh, '\0');
    for (int k = 3; k < 8; ++k)
      for (int j = 3; j < 8; ++j)
        for (int i = 3; i < 27; ++i) {
          voxels[static_cast<std::size_t>((k * kWide + j) * kLong + i)] = 1;
          voxels[static_cast<std::size_t>((k * kWide + j + 5 + gap) * kLong + i)] = 2;
        }
    write(name,
          "NRRD0004\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: 30 30 11\nspace directions: "
          "(1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n" +
              more + "\n" + voxels);
  }

  nlohmann::json summary() const { return nlohmann::json::parse(read("out.json")); }
};

TEST_F(Extraction, LabelsTogetherOrEachOnItsOwn) {
  write_bars("bars.nrrd", 0);
  Outcome run = vmesh({"centerline", "@bars.nrrd", "-o", "@c.json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--label"), std::string::npos) << run.err;
  run = vmesh({"centerline", "@bars.nrrd", "--label", "1,2", "-o", "@c.json", "--json", "@out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(summary().at("centerline").at("components"), 1);  // side by side, one vessel
  EXPECT_FALSE(nlohmann::json::parse(read("c.json")).contains("segment_labels"));
  run = vmesh({"centerline", "@bars.nrrd", "--each-label", "-o", "@c.json", "--json", "@out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(summary().at("centerline").at("components"), 2);
  ASSERT_EQ(summary().at("extraction").size(), 2u);
  EXPECT_EQ(summary().at("extraction").at(1).at("label"), 2);
  const auto written = nlohmann::json::parse(read("c.json"));
  ASSERT_EQ(written.at("segment_labels").size(), written.at("segments").size());
  for (std::size_t s = 0; s < written.at("segments").size(); ++s) {
    const double y = written.at("nodes").at(written.at("segments").at(s).at(0).get<std::size_t>()).at(1);
    EXPECT_EQ(written.at("segment_labels").at(s), y < 7.5 ? 1 : 2);
  }
}

TEST_F(Extraction, SegmentsHaveNames) {
  write_bars("bars.seg.nrrd", 6,
             "Segment0_Name:=left\nSegment0_LabelValue:=1\nSegment1_Name:=right\nSegment1_LabelValue:=2\n");
  const auto extracted = [this](const std::string& label) {
    const Outcome run = vmesh({"centerline", "@bars.seg.nrrd", "--label", label, "-o", "@c.swc"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string content = read("c.swc");
    return content.substr(content.find("\n1 "));  // without the comments, which tell the options
  };
  EXPECT_EQ(extracted("Right"), extracted("2"));
  EXPECT_EQ(extracted("left,right"), extracted("1,2"));
  EXPECT_EQ(vmesh({"reference", "@bars.seg.nrrd", "--label", "left", "-o", "@left.stl"}).exit_code, 0);
  const std::string told = vmesh({"info", "@bars.seg.nrrd"}).out;
  EXPECT_NE(told.find("segments: {\"name\":\"right\",\"label\":2}"), std::string::npos) << told;
  const Outcome run = vmesh({"generate", "@bars.seg.nrrd", "--label", "middle", "-o", "@c.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("no segment \"middle\"; the segments are \"left\" (1) and \"right\" (2)"), std::string::npos)
      << run.err;
}

TEST_F(Extraction, WhatIsLeftOutCanBeRefused) {
  write_bars("bars.nrrd", 6);
  const std::vector<std::string> all = {"centerline", "@bars.nrrd", "--label",   "1,2",
                                        "-o",         "@c.json",    "--require", "coverage=.98"};
  EXPECT_EQ(vmesh(all).exit_code, 0);
  std::vector<std::string> largest = all;
  largest.insert(largest.end(), {"--largest", "--json", "@out.json"});
  const Outcome run = vmesh(largest);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("coverage is"), std::string::npos) << run.err;
  const auto extraction = summary().at("extraction");
  EXPECT_EQ(extraction.at("left_out"), 1);
  EXPECT_NEAR(extraction.at("coverage"), 0.5, 0.02);
  EXPECT_NEAR(extraction.at("length_coverage"), 0.5, 0.02);
  ASSERT_EQ(extraction.at("missed").size(), 1u);
  EXPECT_NE(extraction.at("missed").at(0).at("reason").get<std::string>().find("left out"), std::string::npos);
}

TEST_F(Extraction, OptionsForImagesAreRefusedForWalls) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--label", "1"}, {"--threshold", "3"}, {"--each-label"}, {"--smooth", "1"}}) {
    std::vector<std::string> arguments = {"centerline", "@y.ply", "-o", "@c.json"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    EXPECT_EQ(vmesh(arguments).exit_code, 2) << option[0];
  }
  EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@z.ply", "--largest"}).exit_code, 2);
  EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@z.ply", "--require", "coverage=.9"}).exit_code, 2);
  EXPECT_EQ(vmesh({"centerline", "@y.ply", "-o", "@c.json", "--require", "coverage=2"}).exit_code, 2);
  EXPECT_EQ(vmesh({"centerline", "@y.ply", "-o", "@c.json", "--require", "beauty=1"}).exit_code, 2);
}

TEST_F(Extraction, CenterlinesAreWrittenInTheUnitAndFrameOfTheSurface) {
  write_bars("bars.nrrd", 6);
  const auto generated = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"generate", "@bars.nrrd",          "--label", "2", "-o",
                                          "@bar.ply", "--centerline-output", "@c.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read("c.json"));
  };
  const auto usual = generated({});
  const auto other = generated({"--output-space", "RAS", "--output-unit", "cm"});
  EXPECT_EQ(other.at("space"), "RAS");
  EXPECT_EQ(other.at("unit"), "cm");
  EXPECT_EQ(usual.at("segments"), other.at("segments"));
  ASSERT_EQ(usual.at("nodes").size(), other.at("nodes").size());
  const double factors[] = {-0.1, -0.1, 0.1, 0.1};  // x, y, z and the radius
  for (std::size_t n = 0; n < usual.at("nodes").size(); ++n)
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(other.at("nodes").at(n).at(i).get<double>(), factors[i] * usual.at("nodes").at(n).at(i).get<double>(),
                  1e-12);  // of numbers below 3, rounded twice
}

TEST_F(Extraction, AWallIsEnoughForASurface) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@open.ply", "--ends", "open", "--around", "12"}).exit_code, 0);
  const Outcome run = vmesh({"generate", "@open.ply", "-o", "@again.ply", "--ends", "flat", "--centerline-output",
                             "@c.json", "--json", "@out.json", "--check"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = summary();
  EXPECT_EQ(report.at("extraction").at("components"), 1);
  EXPECT_GT(report.at("extraction").at("coverage"), 0.99);
  EXPECT_EQ(report.at("caps").size(), 3u);
  for (const char* stage : {"read", "wall", "skeleton", "cones", "coverage", "contour", "fit"})
    EXPECT_TRUE(report.at("seconds").contains(stage)) << stage;
  EXPECT_EQ(nlohmann::json::parse(read("c.json")).at("end_sections").size(), 3u);
}

}  // namespace
}  // namespace vmesh::testing
