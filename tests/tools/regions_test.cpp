// Branches as regions of volumes and patches of walls.
#include <map>
#include <set>
#include <sstream>

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

class Regions : public CommandTest {
 protected:
  Regions() { write_y("y.swc"); }

  /// A mesh of the y's wall, divided or not, in any format; of its lumen too where there is TetGen.
  Outcome volume(const std::string& output, const std::vector<std::string>& more = {},
                 const std::string& input = "@y.swc") const {
    std::vector<std::string> words = {"volume", input, "-o", output, "--wall-thickness", "0.2"};
    if (!VMESH_TEST_WITH_TETGEN) words.emplace_back("--wall-only");
    words.insert(words.end(), more.begin(), more.end());
    return vmesh(words);
  }
  static std::vector<std::string> expected() {
    std::vector<std::string> names;
    if (VMESH_TEST_WITH_TETGEN) names = {"lumen_0", "lumen_1", "lumen_2"};
    names.insert(names.end(), {"wall_0", "wall_1", "wall_2"});
    return names;
  }
};

const std::vector<std::string> kByBranch = {"--regions", "branches"};

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(Regions, OfAVolumeAreItsBranches) {
  ASSERT_EQ(volume("@whole.vtu", {"--json", "@whole.json"}).exit_code, 0);
  const Outcome run = volume("@y.vtu", {"--regions", "branches", "--json", "@y.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const VolumeMesh whole = read_volume(path("whole.vtu")).mesh, mesh = read_volume(path("y.vtu")).mesh;
  EXPECT_EQ(mesh.region_names, expected());
  EXPECT_EQ(mesh.wedges, whole.wedges);
  EXPECT_EQ(mesh.patch_names, whole.patch_names);
  // Parts are of the regions that they are called after, and of the right vessel: branch 0 ends at z = 20.
  const std::map<std::string, std::string> part_of = {{"l", "lumen"}, {"w", "wall"}};
  const std::size_t first = mesh.tetrahedra.size();
  for (Index c = 0; c < mesh.wedges.size(); ++c) {
    const std::string& name = mesh.region_names[mesh.cell_region[first + c]];
    EXPECT_EQ(part_of.at(name.substr(0, 1)), whole.region_names[whole.cell_region[first + c]]);
    const Vec3& p = mesh.points[mesh.wedges[c][0]];
    const char branch = name.back();
    if (p.z() < 15) {
      EXPECT_EQ(branch, '0') << p.transpose();
    } else if (p.z() > 27) {
      EXPECT_NE(branch, '0') << p.transpose();
    }
  }
  const json summary = json::parse(read("y.json")), before = json::parse(read("whole.json"));
  std::map<std::string, double> sum;
  for (const json& region : summary["regions"])
    sum[part_of.at(region["name"].get<std::string>().substr(0, 1))] += region["volume_mm3"].get<double>();
  for (const json& region : before["regions"])
    EXPECT_NEAR(sum[region["name"]], region["volume_mm3"], 1e-9 * region["volume_mm3"].get<double>());
  EXPECT_NE(summary["options"].get<std::string>().find("--regions branches"), std::string::npos);
}

TEST_F(Regions, AreInEveryFormat) {
  const std::size_t parts = expected().size();
  ASSERT_EQ(volume("@y.msh", kByBranch).exit_code, 0);
  ASSERT_EQ(volume("@y.msh4", kByBranch).exit_code, 0);
  for (const char* name : {"y.msh", "y.msh4"}) {
    const std::string text = read(name);
    for (const std::string& region : expected())
      EXPECT_EQ(times_in(text, " \"" + region + "\"\n"), 1u) << name << " " << region;
  }
  ASSERT_EQ(volume("@y.inp", {"--regions", "branches", "--tetrahedra"}).exit_code, 0);
  for (const std::string& region : expected())
    EXPECT_GE(times_in(read("y.inp"), "ELSET=" + region + "\n"), 1u) << region;
  ASSERT_EQ(volume("@polyMesh", kByBranch).exit_code, 0);
  EXPECT_EQ(times_in(read("polyMesh/cellZones"), "cellZone;"), parts);
  for (const std::string& region : expected())
    EXPECT_NE(read("polyMesh/cellZones").find("    " + region + "\n"), std::string::npos) << region;
  ASSERT_EQ(volume("@y.ele", {"--regions", "branches", "--tetrahedra"}).exit_code, 0);
  std::istringstream rows(read("y.ele"));
  std::set<std::string> numbers;
  std::size_t count = 0;
  std::string row;
  rows >> count;
  std::getline(rows, row);
  for (std::size_t i = 0; i < count; ++i) {
    std::getline(rows, row);
    numbers.insert(row.substr(row.rfind(' ') + 1));
  }
  EXPECT_EQ(numbers.size(), parts);
  ASSERT_EQ(volume("@mesh-complete", {"--regions", "branches", "--tetrahedra"}).exit_code, 0);
  EXPECT_EQ(read_volume(path("mesh-complete/mesh-complete.mesh.vtu")).mesh.region_names, expected());
}

TEST_F(Regions, OfASurfaceNeedItsCenterline) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.vtp", "--ends", "flat"}).exit_code, 0);
  const Outcome without = volume("@y.vtu", kByBranch, "@y.vtp");
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("--centerline FILE"), std::string::npos) << without.err;
  ASSERT_EQ(volume("@y.vtu", {"--regions", "branches", "--centerline", "@y.swc"}, "@y.vtp").exit_code, 0);
  EXPECT_EQ(read_volume(path("y.vtu")).mesh.region_names, expected());
  write("other.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 90 0 0 2 -1\n2 0 90 0 20 2 1\n");
  const Outcome other = volume("@other.vtu", {"--regions", "branches", "--centerline", "@other.swc"}, "@y.vtp");
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("not a mesh around this centerline"), std::string::npos) << other.err;
  EXPECT_FALSE(exists("other.vtu"));
  EXPECT_EQ(volume("@z.vtu", {"--centerline", "@y.swc"}, "@y.vtp").exit_code, 2);
  EXPECT_EQ(volume("@z.vtu", {"--regions", "branches", "--centerline", "@y.swc"}).exit_code, 2);
  EXPECT_EQ(volume("@z.vtu", {"--regions", "organs"}).exit_code, 2);
  EXPECT_FALSE(exists("z.vtu"));
}

TEST_F(Regions, OfAWallArePatches) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@whole.vtp", "--ends", "flat", "--name", "0=inlet"}).exit_code, 0);
  const Outcome run = vmesh({"generate", "@y.swc", "-o", "@y.vtp", "--ends", "flat", "--name", "0=inlet", "--regions",
                             "branches", "--json", "@y.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface whole = read_surface(path("whole.vtp")), surface = read_surface(path("y.vtp"));
  EXPECT_EQ(surface.mesh.faces, whole.mesh.faces);
  EXPECT_EQ(surface.attributes.patch_names,
            (std::vector<std::string>{"wall_0", "wall_1", "wall_2", "inlet", "cap_2", "cap_3"}));
  const auto& number = find_attribute(surface.attributes.face, "ModelFaceID")->values;
  const auto& before = find_attribute(whole.attributes.face, "ModelFaceID")->values;
  const auto& branch = find_attribute(surface.attributes.face, "branch")->values;
  for (std::size_t f = 0; f < number.size(); ++f)
    ASSERT_EQ(number[f], before[f] == 1 ? branch[f] + 1 : before[f] + 2) << f;
  EXPECT_EQ(find_attribute(surface.attributes.face, "CapID")->values,
            find_attribute(whole.attributes.face, "CapID")->values);
  for (const json& cap : json::parse(read("y.json"))["caps"])
    EXPECT_EQ(cap["model_face_id"].get<int>(), cap["cap_id"].get<int>() + 3);
  // The patches go on into a volume, and stay through a fit.
  ASSERT_EQ(vmesh({"volume", "@y.vtp", "-o", "@y.vtu", "--wall-thickness", "0.2", "--wall-only"}).exit_code, 0);
  EXPECT_EQ(read_volume(path("y.vtu")).mesh.patch_names,
            (std::vector<std::string>{"wall_0", "wall_1", "wall_2", "inlet", "cap_2", "cap_3", "lumen_wall",
                                      "inlet_wall", "cap_2_wall", "cap_3_wall"}));
  ASSERT_EQ(vmesh({"convert", "@whole.vtp", "@scan.stl"}).exit_code, 0);
  const Outcome fit = vmesh({"fit", "@y.vtp", "@scan.stl", "--reference-unit", "mm", "--reference-space", "LPS",
                             "--centerline", "@y.swc", "-o", "@fitted.vtp"});
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const LoadedSurface fitted = read_surface(path("fitted.vtp"));
  EXPECT_EQ(fitted.attributes.patch_names, surface.attributes.patch_names);
  const auto& after = find_attribute(fitted.attributes.face, "ModelFaceID")->values;
  const auto& branch_after = find_attribute(fitted.attributes.face, "branch")->values;
  for (std::size_t f = 0; f < after.size(); ++f) {
    if (after[f] <= 3) {
      ASSERT_EQ(after[f], branch_after[f] + 1) << f;
    }
  }
  EXPECT_EQ(std::set<double>(after.begin(), after.end()), (std::set<double>{1, 2, 3, 4, 5, 6}));
}

TEST_F(Regions, OfARoundSurfaceAreTheWallAlone) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--regions", "branches"}).exit_code, 0);
  EXPECT_EQ(read_surface(path("y.ply")).attributes.patch_names,
            (std::vector<std::string>{"wall_0", "wall_1", "wall_2"}));
}

}  // namespace
}  // namespace vmesh::testing
