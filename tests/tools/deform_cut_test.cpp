#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/components.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/topology.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class DeformCut : public CommandTest {
 protected:
  DeformCut() {
    write_y("y.swc");
    EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.vtp", "--around", "12"}).exit_code, 0);
  }

  Outcome deform(const std::string& members, const std::vector<std::string>& more = {}) const {
    write("scene.json",
          R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.4, "frame_every": 10, )" + members + "}");
    std::vector<std::string> command = {"deform", "@y.swc",  "@y.vtp", "--script", "@scene.json",
                                        "-o",     "@frames", "--json", "-"};
    command.insert(command.end(), more.begin(), more.end());
    return vmesh(command);
  }
  LoadedSurface frame(int number, const std::string& extension = ".vtp") const {
    return read_surface(path("frames/frame_00000" + std::to_string(number) + extension));
  }
};

constexpr const char* kCut = R"("cut": [{"time_s": 0.2, "segment": 0, "parameter": 0.5}])";

TEST_F(DeformCut, FramesAfterItHaveTwoParts) {
  const Outcome run = deform(kCut);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface rest = read_surface(path("y.vtp")), before = frame(0), after = frame(1), last = frame(2);
  EXPECT_EQ(before.mesh.faces, rest.mesh.faces);
  EXPECT_GT(after.mesh.faces.size(), rest.mesh.faces.size());
  EXPECT_EQ(after.mesh.faces, last.mesh.faces);
  const Topology topology = measure_topology(last.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
  EXPECT_EQ(topology.components, 2);
  // Nothing pulls: nothing moves, and either part alone is sound.
  const json summary = json::parse(run.out), cut = summary["cuts"][0];
  EXPECT_LT(summary["largest_displacement_mm"].get<double>(), 1e-4);
  const std::vector<TriMesh> parts = split_components(last.mesh);
  const double volume = enclosed_volume(rest.mesh);
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(self_intersections(parts[i]).empty());
    sum += cut["volumes_mm3"][i].get<double>();
  }
  EXPECT_NEAR(sum, volume, 1e-6 * volume);
  EXPECT_NEAR(enclosed_volume(parts[0]) + enclosed_volume(parts[1]), volume, 1e-5 * volume);  // single precision
  EXPECT_EQ(cut["element"], "cut[0]");
  EXPECT_EQ(cut["segment"], 0);
}

TEST_F(DeformCut, CapsArePatchesWithNames) {
  const Outcome run = deform(kCut);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface last = frame(2);
  const std::vector<std::string>& names = last.attributes.patch_names;
  ASSERT_EQ(names, (std::vector<std::string>{"wall", "cut_1a", "cut_1b"}));
  const MeshAttribute* patch = find_attribute(last.attributes.face, "ModelFaceID");
  ASSERT_NE(patch, nullptr);
  const double area = json::parse(run.out)["cuts"][0]["cap_area_mm2"];
  for (const double number : {2.0, 3.0}) {
    Vec3 sum = Vec3::Zero();
    double of_faces = 0;
    for (Index f = 0; f < last.mesh.faces.size(); ++f) {
      if (patch->values[f] != number) continue;
      sum += area_normal(last.mesh, f) / 2;
      of_faces += area_normal(last.mesh, f).norm() / 2;
    }
    EXPECT_NEAR(of_faces, area, 1e-4 * area);
    EXPECT_NEAR(sum.norm(), area, 1e-4 * area);  // flat
  }
  EXPECT_TRUE(exists("frames/frames.pvd"));
}

TEST_F(DeformCut, WhatIsCutOffFallsAndTheRestStays) {
  const Outcome run =
      deform(std::string(R"("gravity_m_s2": [0, 0, -9.81], "drag_per_s": 1, )") + kCut, {"--format", "ply"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(exists("frames/frames.pvd"));
  const std::vector<TriMesh> parts = split_components(frame(2, ".ply").mesh);
  ASSERT_EQ(parts.size(), 2);
  const std::vector<TriMesh> rest = split_components(frame(1, ".ply").mesh);
  // Free fall for .2 s from rest, slowed by drag.
  const double fall = 0.5 * 9810 * 0.2 * 0.2;
  double least[2];
  for (std::size_t i = 0; i < 2; ++i) {
    double moved = 0;
    for (std::size_t v = 0; v < parts[i].vertices.size(); ++v)
      moved += (rest[i].vertices[v].z() - parts[i].vertices[v].z()) / static_cast<double>(parts[i].vertices.size());
    least[i] = moved;
  }
  EXPECT_LT(std::min(least[0], least[1]), 5);
  EXPECT_NEAR(std::max(least[0], least[1]), fall, 0.2 * fall);
}

TEST_F(DeformCut, AClipClosesTheLumen) {
  const Outcome run = deform(R"("clip": [{"time_s": 0, "closing_s": 0.1, "segment": 0, "parameter": 0.5}])");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json clip = json::parse(run.out)["clips"][0];
  const LoadedSurface rest = frame(0), last = frame(2);
  EXPECT_EQ(last.mesh.faces, rest.mesh.faces);
  // The vessel runs along z from 0 to 20 and is not moved.
  EXPECT_NEAR(clip["position_mm"][2], 10, 1e-9);
  const double half = clip["width_mm"].get<double>() / 2;
  int within = 0;
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    const Vec3 &from = rest.mesh.vertices[v], &to = last.mesh.vertices[v];
    if (std::abs(from.z() - 10) > 0.7 * half) continue;
    ++within;
    EXPECT_NEAR(to.head<2>().norm(), 0.05 * from.head<2>().norm(), 0.01 * from.head<2>().norm());
  }
  EXPECT_GE(within, 12);
  EXPECT_LT(enclosed_volume(last.mesh), enclosed_volume(rest.mesh));
}

TEST_F(DeformCut, BetweenTwoClipsAndAtAPosition) {
  const Outcome run =
      deform(R"("clip": [{"time_s": 0, "closing_s": 0.1, "segment": 0, "parameter": 0.25, "width_mm": 1},
               {"time_s": 0, "closing_s": 0.1, "segment": 0, "parameter": 0.75, "width_mm": 1}],
      "cut": [{"time_s": 0.3, "segment": 1, "parameter": 0.7}, {"time_s": 0.2, "position_mm": [5, 0, 10]}])");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json cuts = json::parse(run.out)["cuts"];
  ASSERT_EQ(cuts.size(), 2);
  EXPECT_EQ(cuts[0]["element"], "cut[1]");  // the first one made
  EXPECT_EQ(cuts[0]["segment"], 0);
  EXPECT_NEAR(cuts[0]["parameter"], 0.5, 1e-9);
  EXPECT_EQ(cuts[1]["segment"], 1);
  EXPECT_EQ(measure_topology(frame(1).mesh).components, 2);
  EXPECT_EQ(measure_topology(frame(2).mesh).components, 3);
  EXPECT_EQ(frame(2).attributes.patch_names.size(), 5);
}

TEST_F(DeformCut, JawsThatCloseLaterHoldTheirPart) {
  // At three quarters of the segment that was cut, beyond the cut.
  const Outcome run = deform(
      R"("tissue": [{"stiffness_N_mm2": 1e-4, "segments": [0]}],
      "clip": [{"time_s": 0, "closing_s": 0.1, "segment": 0, "parameter": 0.25, "width_mm": 1}],
      "cut": [{"time_s": 0.1, "segment": 0, "parameter": 0.5}],
      "grasp": [{"segment": 0, "parameter": 0.75, "close_s": 0.2, "path": [[0.2, 0, 0, 0], [0.3, 0, 0, 10]]}])");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json summary = json::parse(run.out);
  EXPECT_TRUE(summary["hands"][0]["holds"].get<bool>());
  const auto middles = [](const TriMesh& mesh) {
    std::vector<double> z;
    for (const TriMesh& part : split_components(mesh)) {
      double sum = 0;
      for (const Vec3& p : part.vertices) sum += p.z() / static_cast<double>(part.vertices.size());
      z.push_back(sum);
    }
    std::sort(z.begin(), z.end());
    return z;
  };
  const std::vector<double> before = middles(frame(1).mesh), after = middles(frame(2).mesh);
  ASSERT_EQ(after.size(), 2);
  EXPECT_NEAR(after[0], before[0], 0.2);
  EXPECT_GT(after[1], before[1] + 5);
}

TEST_F(DeformCut, ErrorsNameTheElementAndLeaveNothing) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"("cut": [{"time_s": 0.1}])", "cut[0]: give one place"},
      {R"("cut": [{"time_s": 0.1, "segment": 0}])", "parameter"},
      {R"("cut": [{"time_s": 0.1, "node": 1, "position_mm": [0, 0, 0]}])", "cut[0]: give one place"},
      {R"("cut": [{"time_s": 9, "node": 1}])", "cut[0].time_s"},
      {R"("cut": [{"time_s": 0.1, "node": 99}])", "cut[0].node"},
      {R"("cut": [{"time_s": 0.1, "segment": 99, "parameter": 0.5}])", "cut[0]: there is no segment 99"},
      {R"("cut": [{"time_s": 0.1, "node": 0}])", "cut[0]: the vessel ends at node 0"},
      {R"("cut": [{"time_s": 0.1, "node": 1}])", "cut[0]: vessels branch at node 1"},
      {R"("cut": [{"time_s": 0.1, "segment": 0, "parameter": 0.97}])", "meets another one, segment"},
      {R"("cut": [{"time_s": 0.1, "segment": 0, "parameter": 0.5}, {"time_s": 0.2, "segment": 0, "parameter": 0.5}])",
       "cut[1]: the vessel is cut there already, by cut[0]"},
      {R"("clip": [{"time_s": 0.1, "segment": 0, "parameter": 0.99}])", "clip[0]: there is no room for the clip"},
      {R"("clip": [{"time_s": 0, "segment": 0, "parameter": 0.5}, {"time_s": 0, "segment": 0, "parameter": 0.5}])",
       "clip[1]: the profile"},
      {R"("clip": [{"time_s": 0, "segment": 0, "parameter": 0.5, "scale": 0}])", "clip[0].scale"},
  };
  for (const auto& [members, named] : wrong) {
    const Outcome run = deform(members);
    EXPECT_EQ(run.exit_code, 3) << members << run.err;
    EXPECT_NE(run.err.find("scene.json"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
    EXPECT_FALSE(exists("frames")) << members;
  }
}

TEST_F(DeformCut, CellsOfAVolumeAreNotCut) {
  ASSERT_EQ(vmesh({"volume", "@y.vtp", "-o", "@y.vtu"}).exit_code, 0);
  const Outcome run = deform(kCut, {"--volume", "@y.vtu", "--volume-output", "@cells"});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("cut[0]: the cells of a --volume cannot be cut"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("frames"));
}

}  // namespace
}  // namespace vmesh::testing
