#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "../image/image_files.h"
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

using nlohmann::json;

class Table2 : public CommandTest {
 protected:
  Table2() { write_y("y.swc"); }

  json table(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "table2");
    arguments.insert(arguments.end(), {"--json", "-", "-q"});
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  }

  void expect_failure(std::vector<std::string> arguments, int exit_code, const std::string& message) const {
    arguments.insert(arguments.begin(), "table2");
    arguments.insert(arguments.end(), {"--report", "@report.md"});
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << message;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(exists("report.md"));
  }

  /// A forked vessel as label 2 beside a voxel of label 1, lying obliquely.
  void write_fork(const std::string& name) const {
    SampleImage image;
    image.size = {34, 16, 34};
    image.spacing = Vec3(1, 1, 1.2);
    const auto inside = [](const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
      const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      return (a + t * (b - a) - p).norm() < radius;
    };
    const Vec3 root(17, 8, 4), fork(17, 8, 18), left(6, 8, 34), right(28, 8, 34);
    std::vector<double> values;
    for (int k = 0; k < image.size[2]; ++k)
      for (int j = 0; j < image.size[1]; ++j)
        for (int i = 0; i < image.size[0]; ++i) {
          const Vec3 p(i, j, 1.2 * k);
          const bool vessel = inside(p, root, fork, 3.4) || inside(p, fork, left, 2.5) || inside(p, fork, right, 2.5);
          values.push_back(vessel ? 2 : i + j + k == 0 ? 1 : 0);
        }
    write(name, packed(nifti_file<std::uint8_t>(image, values), true));
  }
};

// `others`: the rows after those of the paper, before the growth as published.
void expect_rows(const json& report, const std::vector<std::string>& others) {
  std::vector<std::string> names = {"marching cubes", "truncated cones", "low resolution", "high resolution"};
  names.insert(names.end(), others.begin(), others.end());
  names.push_back("growth as published");
  ASSERT_EQ(report.at("rows").size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const json& row = report["rows"][i];
    EXPECT_EQ(row.at("surface"), names[i]);
    EXPECT_GT(row.at("vertices"), 20);
    EXPECT_GT(row.at("faces"), 40);
    EXPECT_EQ(row.at("around").is_null(), i < 2);
    EXPECT_GT(row.at("skewness").at("max").get<double>(), row.at("skewness").at("mean").get<double>());
    EXPECT_EQ(row.at("distance").is_null(), i == 0);
    EXPECT_EQ(row.at("paper").is_null(), i > 3);
    EXPECT_EQ(row.at("soundness").is_null(), i < 2);
    EXPECT_TRUE(i < 2 || row["soundness"].at("closed") == true);
    if (i == 0) continue;
    const json& bounds = row["distance"].at("hausdorff_mm");
    EXPECT_GT(bounds.at("lower"), 0);
    EXPECT_LE(bounds.at("upper").get<double>() - bounds.at("lower").get<double>(), 1e-4);
    for (const char* side : {"from_surface", "from_reference"})
      EXPECT_LE(row["distance"].at(side).at("sampled_mm").at("p95"), bounds["upper"]);
  }
}

TEST_F(Table2, ComesFromASurfaceAlone) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--around", "24"}).exit_code, 0);
  const json report = table({"--reference", "@y.ply"});
  EXPECT_EQ(report.at("schema"), "vmesh.table2/1");
  expect_rows(report, {"low, fitted", "high, fitted", "low, fitted, long triangles"});
  EXPECT_EQ(report["rows"][0]["vertices"], read_surface(path("y.ply")).mesh.vertices.size());
  EXPECT_EQ(report["rows"][0]["paper"]["vertices"], 89'406);
  EXPECT_EQ(report.at("centerline").at("components"), 1);
  EXPECT_EQ(report.at("source").at("extraction").at("components"), 1);
  EXPECT_EQ(report["source"]["contour_of"], nullptr);
  EXPECT_EQ(report.at("demands").size(), 6u);
  EXPECT_EQ(report.at("against_paper").size(), 15u);
}

TEST_F(Table2, IsWrittenInEveryFormat) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--around", "24"}).exit_code, 0);
  const Outcome run = vmesh({"table2", "--reference", "@y.ply", "--centerline", "@y.swc", "--report", "@y.md"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("low resolution"), std::string::npos);
  EXPECT_NE(run.out.find("11571"), std::string::npos) << run.out;
  EXPECT_NE(read("y.md").find("| low resolution"), std::string::npos);
  const Outcome csv = vmesh({"table2", "--reference", "@y.ply", "--centerline", "@y.swc", "--format", "csv"});
  EXPECT_NE(csv.out.find("\ntable2,truncated cones,vertices,111\n"), std::string::npos) << csv.out;
  EXPECT_NE(csv.out.find("\ntable2,\"low resolution, paper\",vertices,11571\n"), std::string::npos) << csv.out;
}

TEST_F(Table2, WritesItsSurfacesWithDistances) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply", "--around", "24"}).exit_code, 0);
  std::filesystem::create_directory(path("out"));
  const json report = table({"--reference", "@y.ply", "--centerline", "@y.swc", "--surfaces", "@out"});
  const std::vector<std::string> names = {"reference.ply", "cones.ply", "low.ply", "high.ply"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const LoadedSurface surface = read_surface(path("out/" + names[i]));
    EXPECT_EQ(surface.mesh.vertices.size(), report["rows"][i]["vertices"]);
    ASSERT_FALSE(surface.attributes.vertex.empty());
    EXPECT_EQ(surface.attributes.vertex[0].name, "distance");
    // The reference's distances are those to the low resolution.
    const json& distance = report["rows"][i == 0 ? 2 : i]["distance"];
    const double limit = distance.at(i == 0 ? "from_reference" : "from_surface").at("hausdorff_mm").at("upper");
    const std::vector<double>& values = surface.attributes.vertex[0].values;
    const double largest = *std::max_element(values.begin(), values.end());
    EXPECT_LE(largest, limit * (1 + 1e-6));  // PLY keeps floats
    EXPECT_GT(largest, 0.2 * limit);
  }
  EXPECT_EQ(load_centerline(path("out/centerline.json")).cleaned.centerline.nodes().size(), 4u);
}

TEST_F(Table2, RefusesBadCommandLines) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  expect_failure({"--reference", "@y.ply", "--label", "2"}, 2, "--label, --threshold and --spacing are for");
  expect_failure({"--label", "2"}, 2, "--label, --threshold and --spacing are for");
  expect_failure({"--reference", "@y.ply", "--voxel", "1"}, 2, "--voxel is for the volume of a centerline");
  expect_failure({"--reference", "@y.ply", "--binary"}, 2, "--smooth and --binary do not apply to a surface");
  expect_failure({"--centerline", "@y.swc", "--tree"}, 2, "--step, --join and --tree are for");
  expect_failure({"--all-components"}, 2, "--all-components is for --reference");
  expect_failure({"--tree"}, 2, "--step, --join and --tree are for");
  expect_failure({"--reference", "@y.ply", "--surfaces", "@nowhere"}, 5, "nowhere");
  expect_failure({"--reference", "@missing.ply"}, 3, "missing.ply");
  expect_failure({"--reference", "@y.ply", "--centerline", "@missing.swc"}, 3, "missing.swc");
}

TEST_F(Table2, RefusesASheetWithoutCenterlineAndNeverOverwritesAnInput) {
  write("sheet.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  expect_failure({"--reference", "@sheet.off"}, 3, "sheet.off: the surface encloses no volume");
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@low.ply"}).exit_code, 0);
  const std::string before = read("low.ply");
  expect_failure({"--reference", "@low.ply", "--surfaces", path("").string()}, 2, "low.ply: is an input");
  EXPECT_EQ(read("low.ply"), before);
}

TEST_F(Table2, ComesFromACenterlineAlone) {
  const json report = table({"--centerline", "@y.swc", "--voxel", "0.6"});
  expect_rows(report, {"preset low", "preset high"});
  EXPECT_EQ(report["rows"][1]["vertices"], 3 * 37);
  EXPECT_EQ(report["source"]["contour_of"], "grey");
  EXPECT_TRUE(report["source"]["extraction"].is_null());
  EXPECT_TRUE(report["source"]["reference"].is_null());
  EXPECT_EQ(report["source"]["spacing_mm"][2], 0.6);
}

TEST_F(Table2, IsTheSameEveryTime) {
  const std::vector<std::string> arguments = {"table2", "--centerline", "@y.swc", "--voxel", "0.6", "--format", "csv"};
  const std::string first = vmesh(arguments).out;
  EXPECT_GT(first.size(), 1000u);
  EXPECT_EQ(vmesh(arguments).out, first);
}

TEST_F(Table2, ChecksWhatIsDemanded) {
  // Voxels as large as the vessels' radius give marching cubes few vertices.
  const Outcome run = vmesh({"table2", "--centerline", "@y.swc", "--voxel", "2", "--check"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("not met: vertices / those of marching cubes at most 0.13; found"), std::string::npos)
      << run.err;
  EXPECT_NE(run.out.find("Worse than the paper's: "), std::string::npos) << run.out;
}

TEST_F(Table2, GoesFromAMaskToTheTable) {
  write_fork("fork.nii.gz");
  const json report = table({"--reference", "@fork.nii.gz", "--label", "2", "--spacing", "0.8", "--smooth", "0.8"});
  expect_rows(report, {"low, fitted", "high, fitted", "low, fitted, long triangles"});
  EXPECT_EQ(report["centerline"]["components"], 1);
  EXPECT_EQ(report["centerline"]["loops"], 0);
  EXPECT_EQ(report["source"]["contour_of"], "grey");
  EXPECT_EQ(report["source"]["reference"]["sha256"].get<std::string>().size(), 64u);
  // Within a voxel on average, whichever way.
  for (std::size_t i : {2, 3})
    EXPECT_LT(report["rows"][i]["distance"]["from_reference"]["sampled_mm"]["mean"].get<double>(), 1);
}

TEST_F(Table2, TellsWhatIsWrongWithAMask) {
  write_fork("fork.nii.gz");
  expect_failure({"--reference", "@fork.nii.gz"}, 3, "it holds 1, 2");
  expect_failure({"--reference", "@fork.nii.gz", "--label", "7"}, 3, "no voxel is inside");
  write("empty.nii", nifti_file<std::uint8_t>(SampleImage(), std::vector<double>(7 * 6 * 5, 0)));
  expect_failure({"--reference", "@empty.nii"}, 3, "all its voxels are 0");
  write("broken.nii.gz", read("fork.nii.gz").substr(0, 200));
  expect_failure({"--reference", "@broken.nii.gz", "--label", "2"}, 3, "broken.nii.gz");
}

}  // namespace
}  // namespace vmesh::testing
