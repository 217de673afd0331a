#include <nlohmann/json.hpp>

#include "../image/image_files.h"
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class Info : public CommandTest {
 protected:
  Info() { write_y("y.swc"); }

  json info(const std::string& name) const {
    const Outcome run = vmesh({"info", "@" + name, "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  }
};

TEST_F(Info, DescribesACenterline) {
  const json report = info("y.swc");
  EXPECT_EQ(report.at("kind"), "centerline");
  const json& centerline = report.at("centerline");
  EXPECT_EQ(centerline.at("nodes"), 4);
  EXPECT_EQ(centerline.at("segments"), 3);
  EXPECT_EQ(centerline.at("components"), 1);
  EXPECT_EQ(centerline.at("loops"), 0);
  EXPECT_EQ(centerline.at("ends"), 3);
  EXPECT_EQ(centerline.at("branches"), 3);
  EXPECT_EQ(centerline.at("branch_nodes"), 1);
  EXPECT_EQ(centerline.at("radius_min_mm"), 2.1);
  EXPECT_EQ(centerline.at("radius_max_mm"), 3.0);
  EXPECT_NEAR(centerline.at("length_mm"), 20 + 15 + std::sqrt(64 + 9 + 169.0), 1e-9);
  EXPECT_TRUE(report.at("problems").empty());
}

TEST_F(Info, TextHasOneValuePerLine) {
  const Outcome run = vmesh({"info", "@y.swc"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.out.find("\ncenterline.nodes: 4\n"), std::string::npos) << run.out;
}

TEST_F(Info, DescribesASurface) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const json report = info("y.ply");
  EXPECT_EQ(report.at("kind"), "surface");
  EXPECT_EQ(report.at("topology").at("genus"), 0);
  EXPECT_EQ(report.at("self_intersections"), 0);
  EXPECT_GT(report.at("enclosed_volume_mm3"), 500.0);
  EXPECT_TRUE(report.at("problems").empty());
}

TEST_F(Info, CheckFailsForACenterlineWithProblems) {
  write("messy.swc", "1 0 0 0 0 3 -1\n2 0 0 0 9 3 1\n3 0 0 0 9 3 2\n4 0 0 5 15 3 3\n");
  EXPECT_EQ(vmesh({"info", "@messy.swc"}).exit_code, 0);
  EXPECT_EQ(vmesh({"info", "@messy.swc", "--check"}).exit_code, 1);
  EXPECT_EQ(vmesh({"info", "@y.swc", "--check"}).exit_code, 0);
}

TEST_F(Info, CheckFailsForAnOpenSurface) {
  write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Outcome run = vmesh({"info", "@open.off", "--check"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.out.find("problems: not closed"), std::string::npos) << run.out;
}

TEST_F(Info, WhatCannotBeCleanedIsBadInput) {
  write("hopeless.swc", "1 0 0 0 0 nan -1\n2 0 0 0 9 3 1\n");
  const Outcome run = vmesh({"info", "@hopeless.swc"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("hopeless.swc"), std::string::npos) << run.err;
}

/// A mask or a scan: a box of value 2, a voxel of value 5, and whatever is given elsewhere.
std::vector<double> boxes(const SampleImage& image, double elsewhere = 0) {
  std::vector<double> values(static_cast<std::size_t>(image.count()), elsewhere);
  for (int k = 1; k < 4; ++k)
    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 4; ++i) values[static_cast<std::size_t>(i + image.size[0] * (j + image.size[1] * k))] = 2;
  values.back() = 5;
  return values;
}

TEST_F(Info, DescribesALabelImage) {
  SampleImage image;
  image.direction = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  write("liver.nii.gz", packed(nifti_file<std::uint8_t>(image, boxes(image)), true));
  const json report = info("liver.nii.gz");
  EXPECT_EQ(report.at("schema"), "vmesh.info/1");
  EXPECT_EQ(report.at("kind"), "image");
  EXPECT_EQ(report.at("sha256").get<std::string>().size(), 64u);
  EXPECT_EQ(report.at("size_voxels"), json({7, 6, 5}));
  EXPECT_EQ(report.at("spacing_mm"), json({0.75, 1.25, 2.5}));
  EXPECT_EQ(report.at("extent_mm"), json({5.25, 7.5, 12.5}));
  EXPECT_EQ(report.at("frame").at("space"), "LPS");
  EXPECT_EQ(report.at("frame").at("origin_mm"), json({10.0, -20.0, 30.0}));
  EXPECT_EQ(report.at("frame").at("axes"), json::parse("[[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]"));
  EXPECT_EQ(report.at("whole_numbers"), true);
  EXPECT_EQ(report.at("voxels"), 210);
  EXPECT_EQ(report.at("zeros"), 182);
  ASSERT_EQ(report.at("labels").size(), 2u);
  const double voxel = 0.75 * 1.25 * 2.5;
  EXPECT_EQ(report.at("labels")[0],
            json({{"value", 2}, {"voxels", 27}, {"components", 1}, {"volume_mm3", 27 * voxel}}));
  EXPECT_EQ(report.at("labels")[1].at("value"), 5);
  EXPECT_FALSE(report.contains("values"));
  const std::string next = report.at("next")[1];
  EXPECT_EQ(next, "vmesh centerline " + path("liver.nii.gz").string() + " --label N -o liver.centerline.json");
  EXPECT_TRUE(report.at("problems").empty());
  EXPECT_EQ(vmesh({"info", "@liver.nii.gz", "--check"}).exit_code, 0);
}

TEST_F(Info, DescribesAGreyImage) {
  const SampleImage image;
  write("ct.nrrd", nrrd_header(image, "short") + voxel_bytes<std::int16_t>(image.values()));
  const json report = info("ct.nrrd");
  EXPECT_FALSE(report.contains("labels"));
  EXPECT_EQ(report.at("values").at("least"), -3);
  EXPECT_EQ(report.at("values").at("greatest"), 453);
  EXPECT_EQ(report.at("values").at("mean"), 225);
  for (const char* percent : {"1", "50", "90", "99", "99.9"})
    EXPECT_TRUE(report.at("values").at("percentiles").contains(percent)) << percent;
  EXPECT_EQ(report.at("values").at("percentiles").at("99.9"), 453);
  EXPECT_EQ(report.at("next")[0], "vmesh generate " + path("ct.nrrd").string() + " --threshold T -o ct.ply");
  EXPECT_TRUE(report.at("problems").empty());
}

TEST_F(Info, TextOfAnImageHasOneValuePerLine) {
  SampleImage image;
  std::vector<double> values = boxes(image);
  values.back() = 0;
  write("a.mha", mha_header(image, "MET_UCHAR") + voxel_bytes<std::uint8_t>(values));
  const Outcome run = vmesh({"info", "@a.mha"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* line :
       {"\nkind: image\n", "\nspacing_mm: 1.25\n", "\nwhole_numbers: true\n",
        "\nlabels: {\"value\":2,\"voxels\":27,\"components\":1,\"volume_mm3\":63.28125}\n", " --label 2 -o a.ply\n"})
    EXPECT_NE(run.out.find(line), std::string::npos) << line << run.out;
}

TEST_F(Info, CheckFailsForAnImageWithoutVessels) {
  SampleImage image;
  image.size = {4, 4, 1};
  write("empty.mha", mha_header(image, "MET_UCHAR") + std::string(16, '\0'));
  write("full.mha", mha_header(image, "MET_UCHAR") + std::string(16, '\1'));
  EXPECT_EQ(vmesh({"info", "@empty.mha"}).exit_code, 0);
  const Outcome empty = vmesh({"info", "@empty.mha", "--check"});
  EXPECT_EQ(empty.exit_code, 1) << empty.err;
  EXPECT_NE(empty.out.find("problems: all its voxels are 0"), std::string::npos) << empty.out;
  EXPECT_NE(empty.out.find("problems: there is only one voxel along axis 2"), std::string::npos) << empty.out;
  EXPECT_EQ(empty.out.find("next: "), std::string::npos) << empty.out;
  const Outcome full = vmesh({"info", "@full.mha", "--check"});
  EXPECT_EQ(full.exit_code, 1) << full.err;
  EXPECT_NE(full.out.find("problems: all its voxels have the same value"), std::string::npos) << full.out;
}

TEST_F(Info, AnImageThatCannotBeReadIsRefused) {
  SampleImage image;
  write("cut.nii", nifti_file<std::uint8_t>(image, boxes(image)).substr(0, 400));
  EXPECT_EQ(vmesh({"info", "@cut.nii"}).exit_code, 3);
  EXPECT_EQ(vmesh({"info", "@missing.nii"}).exit_code, 3);
  write("a.nii", nifti_file<std::uint8_t>(image, boxes(image)));
  EXPECT_EQ(vmesh({"info", "@a.nii", "--unit", "cm"}).exit_code, 2);
  EXPECT_EQ(vmesh({"info", "@a.nii", "@a.nii"}).exit_code, 2);
}

}  // namespace
}  // namespace vmesh::testing
