#include <map>
#include <tuple>

#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/solid/volume_check.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class DeformVolume : public CommandTest {
 protected:
  static bool has_lumen() { return VMESH_TEST_WITH_TETGEN; }

  /// A straight vessel of radius 2 with a node every 2 mm, and what is bound to it.
  void make_tube() const {
    std::string rows = "# SPACE=LPS\n# UNIT=mm\n";
    for (int i = 0; i <= 20; ++i)
      rows +=
          std::to_string(i + 1) + " 0 0 0 " + std::to_string(2 * i) + " 2 " + std::to_string(i == 0 ? -1 : i) + "\n";
    write("tree.swc", rows);
    make_meshes();
  }
  void make_y() const {
    write_y("tree.swc");
    make_meshes();
  }
  void make_meshes() const {
    ASSERT_EQ(vmesh({"generate", "@tree.swc", "-o", "@tree.vtp", "--ends", "flat", "--deformable"}).exit_code, 0);
    std::vector<std::string> options = {"volume", "@tree.vtp", "-o", "@tree.vtu", "--wall-thickness", "0.2"};
    if (!has_lumen()) options.emplace_back("--wall-only");
    ASSERT_EQ(vmesh(options).exit_code, 0);
  }

  /// Drags a node by x and z mm.
  Outcome deform(int node, double x, double z, const std::vector<std::string>& more = {},
                 const std::string& volume = "@tree.vtu") const {
    const json scene = {{"schema", "vmesh.scene/1"},
                        {"clamp", {0}},
                        {"duration_s", 0.4},
                        {"frame_every", 5},
                        {"drag", {{{"node", node}, {"path", {{0, 0, 0, 0}, {0.3, x, 0, z}}}}}}};
    write("scene.json", scene.dump());
    std::vector<std::string> words = {"deform", "@tree.swc", "@tree.vtp", "--script", "@scene.json",
                                      "-o",     "@frames",   "--volume",  volume,     "--volume-output",
                                      "@cells", "--json",    "-"};
    words.insert(words.end(), more.begin(), more.end());
    return vmesh(words);
  }

  VolumeMesh cells(int frame) const {
    return read_volume(path("cells/frame_00000" + std::to_string(frame) + ".vtu")).mesh;
  }
  TriMesh surface(int frame) const {
    return read_surface(path("frames/frame_00000" + std::to_string(frame) + ".vtp")).mesh;
  }
};

std::tuple<double, double, double> key(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// The points that are vertices, by vertex.
std::map<Index, Index> points_of_vertices(const std::vector<Vec3>& vertices, const std::vector<Vec3>& points) {
  std::map<std::tuple<double, double, double>, Index> at;
  for (Index v = 0; v < points.size(); ++v) at[key(points[v])] = v;
  std::map<Index, Index> found;
  for (Index v = 0; v < vertices.size(); ++v) {
    const auto point = at.find(key(vertices[v]));
    if (point != at.end()) found[v] = point->second;
  }
  return found;
}

double volume_of_region(const VolumeMesh& mesh, const std::string& name) {
  const VolumeMeasures measures = measure_volume(mesh);
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r) {
    if (mesh.region_names[r] == name) return measures.region_volume_mm3[r];
  }
  return 0;
}

TEST_F(DeformVolume, InABentTubeStaysSoundAndOnItsSurface) {
  make_tube();
  const Outcome run = deform(20, 15, -5);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json summary = json::parse(run.out), told = summary["volume"];
  const VolumeMesh rest = read_volume(path("tree.vtu")).mesh;
  const std::map<Index, Index> shared = points_of_vertices(read_surface(path("tree.vtp")).mesh.vertices, rest.points);
  // Vertices within caps are made anew; those of the wall, all around at 21 nodes, are the volume's.
  ASSERT_GE(shared.size(), 6u * 21u);
  // The middles of the two caps come out nearly where those of the surface are.
  EXPECT_GE(told["points_of_surface"], shared.size());
  EXPECT_LE(told["points_of_surface"], shared.size() + 2);
  ASSERT_EQ(told["frames"].size(), 5u);
  ASSERT_EQ(summary["frames"], 5);
  for (int i = 0; i < 5; ++i) {
    const VolumeMesh mesh = cells(i);
    const TriMesh wall = surface(i);
    for (const VolumeDefect& defect : find_volume_defects(mesh)) ADD_FAILURE() << i << ": " << defect.message;
    // The same arithmetic on the same numbers, written with all digits.
    for (const auto& [vertex, point] : shared)
      ASSERT_LE((mesh.points[point] - wall.vertices[vertex]).norm(), 1e-12) << i << " " << vertex;
    EXPECT_EQ(mesh.wedges, rest.wedges);
    const json& frame = told["frames"][i];
    EXPECT_NEAR(frame["time_s"], 0.1 * i, 1e-12);
    EXPECT_EQ(frame["inverted_cells"], 0);
    EXPECT_GT(frame["least_relative_jacobian"], 0.5);
    EXPECT_LT(frame["least_relative_jacobian"], i == 0 ? 1.0001 : 1);
    if (!has_lumen()) continue;
    // Caps stay flat, so that both enclose the same, but for the rounding of positions to single precision.
    EXPECT_NEAR(volume_of_region(mesh, "lumen"), enclosed_volume(wall), 1e-5 * enclosed_volume(wall));
  }
  // It has been bent: the last ring by what the node was dragged.
  const Vec3 moved = cells(4).points[shared.rbegin()->second] - rest.points[shared.rbegin()->second];
  EXPECT_NEAR(moved.x(), 15, 2.5);
}

TEST_F(DeformVolume, TheSummaryTellsTheJacobiansOfTheFrames) {
  make_tube();
  const Outcome run = deform(20, 15, -5);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json frame = json::parse(run.out)["volume"]["frames"][4];
  const VolumeMesh rest = read_volume(path("tree.vtu")).mesh;
  const LoadedVolume loaded = read_volume(path("cells/frame_000004.vtu"));
  const VolumeMesh& mesh = loaded.mesh;
  const std::vector<double> now = least_jacobians_mm3(mesh), before = least_jacobians_mm3(rest);
  double least = 1e9;
  for (std::size_t c = 0; c < now.size(); ++c) least = std::min(least, now[c] / before[c]);
  EXPECT_NEAR(frame["least_relative_jacobian"], least, 1e-12);
  EXPECT_NEAR(frame["least_scaled_jacobian"], measure_volume(mesh).least_scaled_jacobian, 1e-12);
  const std::size_t cell = frame["least_cell"];
  EXPECT_NEAR(now[cell] / before[cell], least, 1e-12);
  const MeshAttribute* relative = find_attribute(loaded.attributes.cell, "relative_jacobian");
  ASSERT_NE(relative, nullptr);
  EXPECT_EQ(relative->values[cell], frame["least_relative_jacobian"]);
  const MeshAttribute* displacement = find_attribute(loaded.attributes.point, "displacement");
  ASSERT_NE(displacement, nullptr);
  for (Index v = 0; v < mesh.points.size(); ++v)
    ASSERT_NEAR(displacement->values[v], (mesh.points[v] - rest.points[v]).norm(), 1e-12);
}

TEST_F(DeformVolume, HasACollectionOfItsFrames) {
  make_tube();
  ASSERT_EQ(deform(20, 3, 0).exit_code, 0);
  const std::string collection = read("cells/frames.pvd");
  for (const char* row :
       {"timestep=\"0\" part=\"0\" file=\"frame_000000.vtu\"", "timestep=\"0.1\" part=\"0\" file=\"frame_000001.vtu\"",
        "timestep=\"0.4\" part=\"0\" file=\"frame_000004.vtu\""})
    EXPECT_NE(collection.find(row), std::string::npos) << collection;
  EXPECT_FALSE(exists("frames/frames.pvd"));
}

TEST_F(DeformVolume, TheSameBytesAgainAndTheSurfaceIsAsWithoutAVolume) {
  make_tube();
  ASSERT_EQ(deform(20, 15, -5).exit_code, 0);
  const std::string cells = read("cells/frame_000003.vtu"), wall = read("frames/frame_000003.vtp");
  std::filesystem::rename(path("cells"), path("cells_before"));
  std::filesystem::rename(path("frames"), path("frames_before"));
  ASSERT_EQ(deform(20, 15, -5).exit_code, 0);
  EXPECT_EQ(read("cells/frame_000003.vtu"), cells);
  ASSERT_EQ(vmesh({"deform", "@tree.swc", "@tree.vtp", "--script", "@scene.json", "-o", "@alone"}).exit_code, 0);
  EXPECT_EQ(read("alone/frame_000003.vtp"), wall);
}

TEST_F(DeformVolume, ABendThatIsTooSharpIsToldAndNothingWritten) {
  make_y();
  const std::vector<std::string> before = files();
  const Outcome run = deform(3, 20, -20);
  EXPECT_EQ(run.exit_code, 7) << run.err;
  EXPECT_NE(run.err.find("tree.vtu: cannot follow: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" flat or turned over somewhere at 0."), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
  std::vector<std::string> after = files();
  std::erase(after, "scene.json");
  EXPECT_EQ(after, before);
}

TEST_F(DeformVolume, WithDefectsAllowedTheSummaryCountsThem) {
  make_y();
  const Outcome run = deform(3, 20, -20, {"--allow-defects"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("turned over somewhere"), std::string::npos) << run.err;
  const json frames = json::parse(run.out)["volume"]["frames"];
  ASSERT_EQ(frames.size(), 5u);
  std::size_t most = 0;
  for (int i = 0; i < 5; ++i) {
    const std::vector<double> jacobians = least_jacobians_mm3(cells(i));
    const auto inverted =
        static_cast<std::size_t>(std::count_if(jacobians.begin(), jacobians.end(), [](double j) { return !(j > 0); }));
    // A reader turns tetrahedra and wedges with a negative volume over again.
    EXPECT_LE(inverted, frames[i]["inverted_cells"].get<std::size_t>()) << i;
    EXPECT_EQ(frames[i]["inverted_cells"] > 0, frames[i]["least_relative_jacobian"] <= 0) << i;
    EXPECT_EQ(frames[i].contains("first_inverted_at"), frames[i]["inverted_cells"] > 0) << i;
    most = std::max(most, frames[i]["inverted_cells"].get<std::size_t>());
  }
  EXPECT_EQ(frames[0]["inverted_cells"], 0);
  EXPECT_GT(most, 0u);
}

TEST_F(DeformVolume, ErrorsNameTheFileAndLeaveNothing) {
  make_y();
  write("other.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 90 0 0 2 -1\n2 0 90 0 20 2 1\n");
  const std::vector<std::string> shell = {"--wall-thickness", "0.2", "--wall-only"};
  const auto make = [&](std::vector<std::string> words) {
    words.insert(words.end(), shell.begin(), shell.end());
    ASSERT_EQ(vmesh(words).exit_code, 0);
  };
  make({"volume", "@other.swc", "-o", "@other.vtu"});
  make({"volume", "@tree.swc", "-o", "@metres.vtu", "--output-unit", "m"});
  make({"volume", "@tree.swc", "-o", "@ras.vtu", "--output-space", "RAS"});
  write("broken.vtu", read("tree.vtu").substr(0, 900));
  const auto expect = [&](int exit_code, const std::string& volume, const std::string& message,
                          const std::vector<std::string>& more = {}) {
    const Outcome run = deform(3, 1, 0, more, volume);
    EXPECT_EQ(run.exit_code, exit_code) << volume << ": " << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << volume << ": " << run.err;
    EXPECT_FALSE(exists("frames")) << volume;
    EXPECT_FALSE(exists("cells")) << volume;
  };
  expect(3, "@other.vtu", "other.vtu: point ");
  expect(3, "@other.vtu", "not a mesh around this centerline");
  expect(3, "@metres.vtu", "metres.vtu: volumes are followed in millimetres and LPS");
  expect(3, "@ras.vtu", "ras.vtu: volumes are followed in millimetres and LPS");
  expect(3, "@broken.vtu", "broken.vtu");
  expect(3, "@missing.vtu", "missing.vtu");
  expect(4, "@tree.vtp", "volume meshes are read from");
  expect(2, "@tree.vtu", "--volume-output", {"--volume-output", ""});
}

TEST_F(DeformVolume, OptionsThatMakeNoSenseAreRefused) {
  make_y();
  write("scene.json", R"({"schema": "vmesh.scene/1", "clamp": [0]})");
  const auto expect = [&](std::vector<std::string> more, const std::string& message) {
    more.insert(more.begin(), {"deform", "@tree.swc", "@tree.vtp", "--script", "@scene.json", "-o", "@frames"});
    const Outcome run = vmesh(more);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    EXPECT_FALSE(exists("frames"));
  };
  expect({"--volume", "@tree.vtu"}, "give both, or none");
  expect({"--volume-output", "@cells"}, "give both, or none");
  expect({"--volume", "@tree.vtu", "--volume-output", "@frames"}, "another one");
  expect({"--volume", "@tree.vtu", "--volume-output", "@frames/"}, "another one");
  expect({"--allow-defects"}, "--volume");
}

}  // namespace
}  // namespace vmesh::testing
