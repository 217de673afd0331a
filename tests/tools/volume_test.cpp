#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/topology.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class VolumeCommand : public CommandTest {
 protected:
  VolumeCommand() { write_y("y.swc"); }

  static bool can_mesh_lumens() { return VMESH_TEST_WITH_TETGEN; }

  json summary() const { return json::parse(read("volume.json")); }
  /// Areas by the numbers of faces in the surface.
  std::map<int, double> areas_of_surface(const std::string& name) const {
    const LoadedSurface surface = read_surface(path(name));
    const MeshAttribute* label = find_attribute(surface.attributes.face, "ModelFaceID");
    std::map<int, double> areas;
    for (Index f = 0; f < surface.mesh.faces.size(); ++f)
      areas[static_cast<int>(label->values[f])] += area_normal(surface.mesh, f).norm() / 2;
    return areas;
  }
};

TEST_F(VolumeCommand, OfASurfaceHasItsVolumeAndItsCaps) {
  if (!can_mesh_lumens()) GTEST_SKIP() << "built without TetGen";
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.vtp", "--ends", "flat"}).exit_code, 0);
  const Outcome run = vmesh({"volume", "@y.vtp", "-o", "@y.vtu", "--json", "@volume.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("layers have at least 90 % of their thickness"), std::string::npos) << run.err;
  EXPECT_TRUE(exists("y.vtu"));
  const json report = summary();
  EXPECT_EQ(report["schema"], "vmesh.volume/1");
  EXPECT_GT(report["tetrahedra"], 0);
  EXPECT_GT(report["wedges"], 0);
  const double volume = enclosed_volume(read_surface(path("y.vtp")).mesh);
  ASSERT_EQ(report["regions"].size(), 1u);
  EXPECT_EQ(report["regions"][0]["name"], "lumen");
  // A sum over thousands of cells.
  EXPECT_NEAR(report["regions"][0]["volume_mm3"], volume, 1e-9 * volume);
  const std::map<int, double> areas = areas_of_surface("y.vtp");
  ASSERT_EQ(report["patches"].size(), areas.size());
  int number = 0;
  for (const auto& [label, area] : areas) {
    const json& patch = report["patches"][number];
    EXPECT_EQ(patch["name"], number == 0 ? "wall" : "cap_" + std::to_string(number));
    EXPECT_NEAR(patch["area_mm2"], area, 1e-9 * area);
    ++number;
  }
}

TEST_F(VolumeCommand, OfACenterlineIsThatOfItsSurface) {
  if (!can_mesh_lumens()) GTEST_SKIP() << "built without TetGen";
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--ends", "flat", "--around", "8"}).exit_code, 0);
  ASSERT_EQ(vmesh({"volume", "@y.ply", "@two.vtu", "--json", "@volume.json"}).exit_code, 0);
  const json two = summary();
  const Outcome run = vmesh({"volume", "@y.swc", "@one.vtu", "--around", "8", "--json", "@volume.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json one = summary();
  for (const char* key : {"points", "tetrahedra", "wedges", "pyramids", "regions", "patches", "layers", "quality"})
    EXPECT_EQ(one[key], two[key]) << key;
  EXPECT_NE(one["options"].get<std::string>().find("--around 8"), std::string::npos);
}

TEST_F(VolumeCommand, OutsidesOfWallsAreClosedSurfacesToPrint) {
  ASSERT_EQ(
      vmesh({"volume", "@y.swc", "-o", "@wall.stl", "--wall-thickness", "0.3", "--wall-only", "--json", "@volume.json"})
          .exit_code,
      0);
  const TriMesh wall = read_surface(path("wall.stl")).mesh;
  const Topology topology = measure_topology(wall);
  EXPECT_TRUE(topology.closed && topology.oriented);
  EXPECT_EQ(topology.crowded_edges, 0u);
  const double volume = summary()["regions"][0]["volume_mm3"];
  // STL has floats, with 7 digits.
  EXPECT_NEAR(enclosed_volume(wall), volume, 1e-5 * volume);
  ASSERT_EQ(vmesh({"volume", "@y.swc", "-o", "@wall.3mf", "--wall-thickness", "0.3", "--wall-only"}).exit_code, 0);
  EXPECT_EQ(read("wall.3mf").substr(0, 4), "PK\3\4");
}

TEST_F(VolumeCommand, MergesWallsOnRequest) {
  EXPECT_NE(vmesh({"volume", "@y.swc", "-o", "@y.vtu", "--merge-walls"}).err.find("--wall-thickness"),
            std::string::npos);
  if (!can_mesh_lumens()) GTEST_SKIP() << "built without TetGen";
  write("close.swc", "1 2 -12 0 0 2 -1\n2 2 12 0 0 2 1\n3 2 -12 4.2 0 2 -1\n4 2 12 4.2 0 2 3\n");
  const Outcome run = vmesh({"volume", "@close.swc", "-o", "@close.vtu", "--around", "12", "--wall-thickness", "0.3",
                             "--merge-walls", "--json", "@volume.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("walls are one at 1 place"), std::string::npos) << run.err;
  ASSERT_EQ(summary()["merged_walls"].size(), 1u);
  EXPECT_NEAR(summary()["merged_walls"][0]["position"][1], 2.1, 0.05);
}

TEST_F(VolumeCommand, TheSameBytesWhateverTheThreads) {
  if (!can_mesh_lumens()) GTEST_SKIP() << "built without TetGen";
  ASSERT_EQ(vmesh({"volume", "@y.swc", "@a.vtu", "--threads", "1", "--wall-thickness", "0.2"}).exit_code, 0);
  const std::string one = read("a.vtu");
  ASSERT_EQ(vmesh({"volume", "@y.swc", "@a.vtu", "--threads", "3", "--wall-thickness", "0.2"}).exit_code, 0);
  EXPECT_EQ(one, read("a.vtu"));
}

TEST_F(VolumeCommand, OfTheVesselsWall) {
  const Outcome run = vmesh({"volume", "@y.swc", "@wall.vtu", "--wall-thickness", "0.3mm", "--wall-layers", "3",
                             "--wall-only", "--json", "@volume.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = summary();
  EXPECT_EQ(report["tetrahedra"], 0);
  ASSERT_EQ(report["regions"].size(), 1u);
  EXPECT_EQ(report["regions"][0]["name"], "wall");
  EXPECT_EQ(report["wall_layers"]["thickness_mm"], 0.3);
  std::map<std::string, double> area;
  for (const json& patch : report["patches"]) area[patch["name"]] = patch["area_mm2"];
  EXPECT_GT(area["wall"], area["lumen_wall"]);
  EXPECT_EQ(area["cap_1"], 0);
  EXPECT_GT(area["cap_1_wall"], 0);
  // About the mean of both areas by the thickness.
  EXPECT_NEAR(report["regions"][0]["volume_mm3"], 0.3 * (area["wall"] + area["lumen_wall"]) / 2,
              0.05 * 0.3 * area["wall"]);
}

TEST_F(VolumeCommand, RefusesSurfacesThatAreOpen) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@open.vtp", "--ends", "open"}).exit_code, 0);
  const Outcome run = vmesh({"volume", "@open.vtp", "-o", "@y.vtu", "--wall-thickness", "0.2", "--wall-only"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("open.vtp"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--ends flat"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("y.vtu"));
}

TEST_F(VolumeCommand, RefusesOptionsThatMakeNoSense) {
  const auto code = [&](std::vector<std::string> options) {
    std::vector<std::string> words = {"volume", "@y.swc", "@y.vtu"};
    words.insert(words.end(), options.begin(), options.end());
    return vmesh(words).exit_code;
  };
  EXPECT_EQ(code({"--wall-only"}), 2);
  EXPECT_EQ(code({"--wall-layers", "2"}), 2);
  EXPECT_EQ(code({"--layer-thickness", "much"}), 2);
  EXPECT_EQ(code({"--first-layer", "0.1"}), 2);
  EXPECT_EQ(code({"--first-layer", "0.1mm", "--layer-thickness", "0.2"}), 2);
  EXPECT_EQ(code({"--ends", "open"}), 2);
  EXPECT_EQ(code({"--layers", "-1"}), 2);
  EXPECT_EQ(vmesh({"volume", "@y.swc", "@y.dae"}).exit_code, 4);
  EXPECT_FALSE(exists("y.vtu"));
}

TEST_F(VolumeCommand, WithoutTetGenTellsWhatIsMissing) {
  if (can_mesh_lumens()) GTEST_SKIP() << "built with TetGen";
  const Outcome run = vmesh({"volume", "@y.swc", "@y.vtu"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("VMESH_WITH_TETGEN"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vmesh::testing
