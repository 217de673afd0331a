#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"

#include "../image/image_files.h"
#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class References : public CommandTest {
 protected:
  References() { write_y("y.swc"); }

  Centerline centerline(const std::string& name) const { return load_centerline(path(name)).cleaned.centerline; }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(read(name)); }

  /// A ball of radius 6 mm as label 2, lying obliquely.
  void write_ball(const std::string& name) const {
    SampleImage image;
    image.size = {24, 20, 12};
    image.spacing = Vec3(0.75, 1, 1.5);
    std::vector<double> values;
    const Vec3 middle = image.position(12, 10, 6);
    for (int k = 0; k < image.size[2]; ++k)
      for (int j = 0; j < image.size[1]; ++j)
        for (int i = 0; i < image.size[0]; ++i)
          values.push_back((image.position(i, j, k) - middle).norm() < 6 ? 2 : i == 0 ? 1 : 0);
    write(name, packed(nifti_file<std::uint8_t>(image, values), true));
  }
};

TEST_F(References, ConesHaveTheStatedCountsAndTellThem) {
  const Outcome run = vmesh({"cones", "@y.swc", "-o", "@cones.ply", "--json", "@cones.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const LoadedSurface cones = read_surface(path("cones.ply"));
  EXPECT_EQ(cones.mesh.vertices.size(), 3u * 37);
  EXPECT_EQ(cones.attributes.vertex.at(1).name, "segment");
  EXPECT_EQ(json("cones.json")["cones"], 3);
  ASSERT_EQ(vmesh({"cones", "@y.swc", "-o", "@six.off", "--sides", "6"}).exit_code, 0);
  EXPECT_EQ(read_surface(path("six.off")).mesh.vertices.size(), 3u * 13);
}

TEST_F(References, ACenterlineComesBackFromItsSurface) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const Outcome run = vmesh({"centerline", "@y.ply", "-o", "@back.json", "--json", "@summary.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const Centerline back = centerline("back.json");
  EXPECT_EQ(back.component_count(), 1u);
  EXPECT_EQ(back.cycle_rank(), 0u);
  EXPECT_EQ(json("summary.json")["extraction"]["components"], 1);
  EXPECT_EQ(vmesh({"generate", "@back.json", "-o", "@again.ply", "--check"}).exit_code, 0);
}

TEST_F(References, ASheetHasNoCenterline) {
  write("sheet.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
  const Outcome run = vmesh({"centerline", "@sheet.off", "-o", "@sheet.json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("sheet.off: the surface encloses no volume"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("sheet.json"));
}

TEST_F(References, AnImageIsContouredWhereItLies) {
  write_ball("ball.nii.gz");
  const Outcome run = vmesh({"reference", "@ball.nii.gz", "--label", "2", "-o", "@ball.ply", "--json", "@ball.json",
                             "--spacing", "0.5", "--smooth", "0.5"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const TriMesh mesh = read_surface(path("ball.ply")).mesh;
  const Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
  SampleImage image;
  image.spacing = Vec3(0.75, 1, 1.5);
  for (const Vec3& v : mesh.vertices) EXPECT_NEAR((v - image.position(12, 10, 6)).norm(), 6, 1);
  EXPECT_EQ(json("ball.json")["contour_of"], "grey");
}

TEST_F(References, AnImageOfSeveralLabelsAsksWhich) {
  write_ball("ball.nii.gz");
  const Outcome run = vmesh({"reference", "@ball.nii.gz", "-o", "@ball.ply"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("it holds 1, 2"), std::string::npos) << run.err;
  EXPECT_FALSE(exists("ball.ply"));
  EXPECT_EQ(vmesh({"reference", "@ball.nii.gz", "--label", "2", "--space", "RAS", "-o", "@ball.ply"}).exit_code, 2);
}

TEST_F(References, ATreeIsSampledAndContoured) {
  const Outcome run = vmesh({"reference", "@y.swc", "--voxel", "0.5", "-o", "@y.ply", "--binary"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("marching cubes of a binary volume"), std::string::npos) << run.err;
  const Topology topology = measure_topology(read_surface(path("y.ply")).mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(vmesh({"reference", "@y.swc", "--voxel", "1e-5", "-o", "@z.ply"}).exit_code, 3);
}

TEST_F(References, ACenterlineComesFromAnImageToo) {
  write_ball("ball.nii.gz");
  const Outcome run = vmesh({"centerline", "@ball.nii.gz", "--label", "2", "-o", "@ball.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(centerline("ball.json").component_count(), 1u);
}

}  // namespace
}  // namespace vmesh::testing
