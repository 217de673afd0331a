#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace vmesh::testing
