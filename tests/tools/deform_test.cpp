#include <algorithm>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class Deform : public CommandTest {
 protected:
  Deform() {
    write_y("y.swc");
    EXPECT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  }

  Outcome deform(const std::string& scene, const std::string& surface = "@y.ply") const {
    write("scene.json", scene);
    return vmesh(
        {"deform", "@y.swc", surface, "--script", "@scene.json", "-o", "@frames", "--format", "ply", "--json", "-"});
  }
};

constexpr const char* kPull = R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.4, "frame_every": 10,
  "drag": [{"node": 3, "path": [[0, 0, 0, 0], [0.2, 0, 5, 0]]}]})";

TEST_F(Deform, PullsABranch) {
  const Outcome run = deform(kPull);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json summary = json::parse(run.out);
  EXPECT_EQ(summary["frames"], 3);
  EXPECT_GT(summary["work_J"], 0);
  const LoadedSurface rest = read_surface(path("y.ply")), first = read_surface(path("frames/frame_000000.ply")),
                      last = read_surface(path("frames/frame_000002.ply"));
  double farthest_first = 0, farthest = 0;
  for (std::size_t v = 0; v < rest.mesh.vertices.size(); ++v) {
    farthest_first = std::max(farthest_first, (first.mesh.vertices[v] - rest.mesh.vertices[v]).norm());
    farthest = std::max(farthest, (last.mesh.vertices[v] - rest.mesh.vertices[v]).norm());
  }
  EXPECT_LT(farthest_first, 1e-5);
  // The cap beyond the dragged node turns with it.
  EXPECT_NEAR(farthest, 5, 2.5);
  EXPECT_NE(find_attribute(last.attributes.vertex, "displacement"), nullptr);
}

TEST_F(Deform, BindsASurfaceThatKnowsNoPlaces) {
  ASSERT_EQ(vmesh({"convert", "@y.ply", "-o", "@y.stl"}).exit_code, 0);
  const Outcome run = deform(kPull, "@y.stl");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("nearest segment"), std::string::npos) << run.err;
}

TEST_F(Deform, ErrorsNameTheElementAndLeaveNothing) {
  const std::pair<const char*, const char*> wrong[] = {
      {"{", "JSON"},
      {R"({"schema": "vmesh.scene/2"})", "schema"},
      {R"({"schema": "vmesh.scene/1", "gravitation": 1})", "\"gravitation\" is not known"},
      {R"({"schema": "vmesh.scene/1", "fix": [0, 99]})", "fix[1]"},
      {R"({"schema": "vmesh.scene/1", "drag": [{"node": 1, "path": [[0, 1, 2]]}]})", "drag[0].path[0]"},
      {R"({"schema": "vmesh.scene/1", "drag": [{"node": 1, "path": [[1, 0, 0, 0], [1, 0, 0, 0]]}]})", "ascend"},
      {R"({"schema": "vmesh.scene/1", "force": [{"node": 1, "force_N": []}]})", "force[0].force_N"},
      {R"({"schema": "vmesh.scene/1", "material": {"young_Pa": "soft"}})", "material.young_Pa"},
      {R"({"schema": "vmesh.scene/1", "duration_s": 1e6, "step_s": 1e-6})", "ten million"},
      {R"({"schema": "vmesh.scene/1", "material": {"wall_mm": 1, "wall_ratio": 0.5}})", "material.wall_ratio"},
      {R"({"schema": "vmesh.scene/1", "fix": [3], "drag": [{"node": 3, "path": [[0, 0, 0, 0]]}]})", "drag[0].node"},
      {R"({"schema": "vmesh.scene/1", "drag": [{"node": 3, "path": [[0, 0, 0, 0]]}, {"node": 3, "path": [[0, 1, 0, 0]]}]})",
       "drag[1].node"},
      {R"({"schema": "vmesh.scene/1", "clamp": [0], "material": {"young_Pa": 1e-3},
           "force": [{"node": 3, "force_N": [[0, 1e9, 0, 0]]}]})",
       "physical range at 0.02 s"},
      {R"({"schema": "vmesh.scene/1", "contact": {"self": 1}})", "contact.self"},
      {R"({"schema": "vmesh.scene/1", "instruments": [{"points_mm": [[0, 0, 0]], "radius_mm": [1, 2],
           "path": [[0, 0, 0, 0]]}]})",
       "instruments[0].radius_mm"},
      {R"({"schema": "vmesh.scene/1", "instruments": [{"points_mm": [[0, 0, 0]], "radius_mm": 1,
           "path": [[0, 0, 0, 90], [1, 0, 0, 0, 2, 0, 0, 0]]}]})",
       "instruments[0].path[1]"},
      {R"({"schema": "vmesh.scene/1", "instruments": [{"name": "probe", "points_mm": [[0, 0, 0]], "radius_mm": 1e3,
           "path": [[0, 0, 0, 0]]}]})",
       "instruments[0] (probe)"},
      {R"({"schema": "vmesh.scene/1", "instruments": [{"name": "late", "points_mm": [[0, 0, 0]], "radius_mm": 1e3,
           "enter_s": 0.5, "path": [[0, 0, 0, 0]]}]})",
       "instruments[0] (late)"},
      {R"({"schema": "vmesh.scene/1", "instruments": [{"points_mm": [[0, 0, 0]], "radius_mm": 1, "enter_s": 2,
           "leave_s": 1, "path": [[0, 0, 0, 500]]}]})",
       "instruments[0].leave_s"},
      {R"({"schema": "vmesh.scene/1", "grasp": [{"segment": 99, "path": [[0, 0, 0, 0]]}]})", "grasp[0].segment"},
      {R"({"schema": "vmesh.scene/1", "grasp": [{"segment": 1, "release_s": 0, "path": [[0, 0, 0, 0]]}]})",
       "grasp[0].release_s"},
      {R"({"schema": "vmesh.scene/1", "tissue": [{"stiffness_N_mm2": 1, "segments": [0], "branches": [0]}]})",
       "tissue[0]"},
      {R"({"schema": "vmesh.scene/1", "integrator": "paper", "contact": {}})", "implicit"},
  };
  for (const auto& [scene, named] : wrong) {
    const Outcome run = deform(scene);
    EXPECT_EQ(run.exit_code, 3) << scene << run.err;
    EXPECT_NE(run.err.find("scene.json"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
    EXPECT_FALSE(exists("frames")) << scene;
  }
}

TEST_F(Deform, ForcesOnHandsAreWritten) {
  write("scene.json", R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.2, "frame_every": 10,
    "instruments": [{"name": "far, away", "points_mm": [[0, 0, 0]], "radius_mm": 1, "path": [[0, 0, 0, 500]]}],
    "grasp": [{"segment": 1, "parameter": 1, "path": [[0, 0, 0, 0], [0.2, 0, 2, 0]]}],
    "tissue": [{"stiffness_N_mm2": 1e-6}]})");
  const Outcome run = vmesh({"deform", "@y.swc", "@y.ply", "--script", "@scene.json", "-o", "@frames", "--format",
                             "ply", "--json", "-", "--forces", "@forces.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json hands = json::parse(run.out)["hands"];
  ASSERT_EQ(hands.size(), 2);
  EXPECT_EQ(hands[0]["hand"], "grasp 0");
  // The vessel pulls back.
  EXPECT_LT(hands[0]["last_force_N"][1], 0);
  EXPECT_EQ(hands[1]["hand"], "far, away");
  EXPECT_EQ(hands[1]["largest_force_N"], 0);
  std::istringstream csv(read("forces.csv"));
  std::string line, last;
  std::getline(csv, line);
  EXPECT_EQ(line.find("time_s,hand,force_x_N,"), 0);
  int lines = 0;
  for (; std::getline(csv, line); ++lines) last = line;
  EXPECT_EQ(lines, 20);  // ten steps of 20 ms, two hands
  EXPECT_EQ(last.find("0.2,\"far, away\",0,0,0,"), 0) << last;
}

TEST_F(Deform, KeepsWhatIsInTheFolder) {
  ASSERT_EQ(deform(kPull).exit_code, 0);
  const Outcome again = deform(kPull);
  EXPECT_EQ(again.exit_code, 2) << again.err;
  EXPECT_TRUE(exists("frames/frame_000000.ply"));
}

/// Displacements in the last frame, of the vertex that moved farthest.
double farthest_in(const std::filesystem::path& frame) {
  const LoadedSurface surface = read_surface(frame);
  const MeshAttribute* displacement = find_attribute(surface.attributes.vertex, "displacement");
  return *std::max_element(displacement->values.begin(), displacement->values.end());
}

TEST_F(Deform, ADragStartsWhenItIsTold) {
  const Outcome run = deform(R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.4, "frame_every": 10,
    "drag": [{"node": 3, "path": [[0, 0, 5, 0]], "start_s": 0.21}]})");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(farthest_in(path("frames/frame_000001.ply")), 1e-5) << "not before";
  EXPECT_GT(farthest_in(path("frames/frame_000002.ply")), 2.5);
}

TEST_F(Deform, ANodeIsDraggedAgainAfterItWasReleased) {
  const std::string again = R"({"schema": "vmesh.scene/1", "clamp": [0], "duration_s": 0.4, "frame_every": 20, "drag": [
    {"node": 3, "path": [[0, 0, 5, 0]], "release_s": 0.1},
    {"node": 3, "path": [[0, 0, 0, 0]], "start_s": START}]})";
  const auto starting = [&](const std::string& start) {
    std::string scene = again;
    return deform(scene.replace(scene.find("START"), 5, start));
  };
  const Outcome early = starting("0.09");
  EXPECT_EQ(early.exit_code, 3);
  for (const char* word : {"drag[1].node", "dragged already", "start_s"})
    EXPECT_NE(early.err.find(word), std::string::npos) << early.err;
  const Outcome run = starting("0.1");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // The second drag brings the node back; what bends beyond it is within a radius.
  EXPECT_LT(farthest_in(path("frames/frame_000001.ply")), 2.5);
}

TEST_F(Deform, ScenesPagesAndFoldersGoTogether) {
  write("scene.json", kPull);
  const std::vector<std::pair<std::vector<std::string>, const char*>> wrong = {
      {{"-o", "@frames"}, "--live"},
      {{"--live", "@live.html", "-o", "@frames"}, "--script"},
      {{"--live", "@live.html", "--json", "-"}, "-o"},
      {{"--live", "@live.html", "--script", "@scene.json", "--html", "@page.html"}, "-o"}};
  const auto before = files();
  for (const auto& [more, named] : wrong) {
    std::vector<std::string> command = {"deform", "@y.swc", "@y.ply"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome run = vmesh(command);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  }
  EXPECT_EQ(files(), before);
}

#if VMESH_HAS_LIVE
TEST_F(Deform, APageThatMovesTakesMaterialAndHeldNodesOfAScene) {
  write("scene.json", kPull);
  const Outcome run = vmesh({"deform", "@y.swc", "@y.ply", "--live", "@live.html", "--script", "@scene.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("to your hands"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("frames"));
  const std::string page = read("live.html");
  EXPECT_NE(page.find(R"("clamp":[0])"), std::string::npos);
  for (const char* address : {"src=\"", "<link", "@import", "url("})
    EXPECT_EQ(page.find(address), std::string::npos) << address;

  write("paper.json", R"({"schema": "vmesh.scene/1", "integrator": "paper"})");
  const Outcome paper = vmesh({"deform", "@y.swc", "@y.ply", "--live", "@other.html", "--script", "@paper.json"});
  EXPECT_EQ(paper.exit_code, 3);
  EXPECT_NE(paper.err.find("paper.json: integrator"), std::string::npos) << paper.err;
  for (const char* member : {R"("clip": [{"segment": 1, "parameter": 0.5, "time_s": 0.1}])",
                             R"("tissue": [{"stiffness_N_mm2": 1, "segments": [1]}])"}) {
    write("other.json", std::string(R"({"schema": "vmesh.scene/1", )") + member + "}");
    const Outcome other = vmesh({"deform", "@y.swc", "@y.ply", "--live", "@other.html", "--script", "@other.json"});
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_NE(other.err.find("other.json: " + std::string(member).substr(1, 4)), std::string::npos) << other.err;
    EXPECT_NE(other.err.find("pages that move"), std::string::npos) << other.err;
    EXPECT_FALSE(exists("other.html"));
  }
  write("tissue.json", R"({"schema": "vmesh.scene/1", "contact": {"self": true, "friction": 0.5},
    "tissue": [{"stiffness_N_mm2": 0.25}], "cut": [{"segment": 1, "parameter": 0.5, "time_s": 0.1}]})");
  const Outcome tissue = vmesh({"deform", "@y.swc", "@y.ply", "--live", "@other.html", "--script", "@tissue.json"});
  ASSERT_EQ(tissue.exit_code, 0) << tissue.err;
  EXPECT_NE(tissue.err.find("cut to your hands"), std::string::npos) << tissue.err;
  const std::string soft = read("other.html");
  EXPECT_NE(soft.find(R"("tissue":{"stiffness_N_mm2":0.25,"tear_N_mm":null})"), std::string::npos);
  EXPECT_NE(soft.find(R"("friction":0.5)"), std::string::npos);
}
#else
TEST_F(Deform, WithoutEmscriptenPagesThatMoveAreRefused) {
  const Outcome run = vmesh({"deform", "@y.swc", "@y.ply", "--live", "@live.html"});
  EXPECT_EQ(run.exit_code, 4);
  for (const char* word : {"--live", "--with-wasm", "VMESH_WITH_LIVE"})
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  EXPECT_FALSE(exists("live.html"));
}
#endif

}  // namespace
}  // namespace vmesh::testing
