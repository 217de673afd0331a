#include <cmath>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/solid/volume_check.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class Edit : public CommandTest {
 protected:
  Edit() { write("line.swc", "1 0 0 0 0 2 -1\n2 0 0 0 10 2 1\n3 0 0 0 20 2 2\n4 0 0 0 30 2 3\n5 0 0 0 40 2 4\n"); }

  void grow(const std::string& name) const {
    ASSERT_EQ(vmesh({"generate", "@line.swc", "-o", "@" + name, "--around", "12"}).exit_code, 0);
  }
  Centerline centerline(const std::string& name) const { return load_centerline(path(name)).cleaned.centerline; }
};

TEST_F(Edit, NarrowsAVesselAndItsSurfaceFollows) {
  grow("line.ply");
  const Outcome run = vmesh({"edit", "@line.swc", "-o", "@narrow.json", "--stenosis", "2,16,0.5", "--follow",
                             "@line.ply", "--follow-output", "@narrow.ply"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  double least = 9;
  const Centerline narrow = centerline("narrow.json");
  for (const CenterlineNode& node : narrow.nodes()) least = std::min(least, node.radius);
  EXPECT_NEAR(least, 1, 1e-6);
  const LoadedSurface before = read_surface(path("line.ply")), after = read_surface(path("narrow.ply"));
  EXPECT_EQ(after.mesh.faces, before.mesh.faces);
  const MeshAttribute* radius = find_attribute(after.attributes.vertex, "radius");
  ASSERT_NE(radius, nullptr);
  for (Index v = 0; v < after.mesh.vertices.size(); ++v) {
    const Vec3 &p = before.mesh.vertices[v], q = after.mesh.vertices[v];
    if (p.z() < 0 || p.z() > 40) continue;
    const double d = std::abs(p.z() - 20), factor = d < 8 ? 1 - 0.5 * (1 + std::cos(M_PI * d / 8)) / 2 : 1;
    EXPECT_NEAR(q.head<2>().norm(), factor * p.head<2>().norm(), 1e-5);  // a PLY file's digits
    EXPECT_NEAR(radius->values[v], factor * 2, 1e-5);
    EXPECT_NEAR(q.z(), p.z(), 1e-5);
  }
  // The other way round: what grows around the edited centerline is near to what followed.
  ASSERT_EQ(vmesh({"generate", "@narrow.json", "-o", "@grown.ply", "--around", "24"}).exit_code, 0);
  const double volume = enclosed_volume(read_surface(path("grown.ply")).mesh);
  EXPECT_NEAR(enclosed_volume(after.mesh), volume, 0.02 * volume);  // what twelve around cut off: 4.5 %, and balance
}

TEST_F(Edit, AVolumeFollows) {
  ASSERT_EQ(vmesh({"volume", "@line.swc", "-o", "@line.vtu", "--wall-thickness", "0.2", "--wall-only"}).exit_code, 0);
  const Outcome run = vmesh({"edit", "@line.swc", "-o", "@narrow.json", "--stenosis", "2,16,0.5", "--follow",
                             "@line.vtu", "--follow-output", "@narrow.vtu"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const VolumeMesh before = read_volume(path("line.vtu")).mesh, after = read_volume(path("narrow.vtu")).mesh;
  EXPECT_EQ(after.wedges, before.wedges);
  EXPECT_TRUE(find_volume_defects(after).empty());
  ASSERT_EQ(after.points.size(), before.points.size());
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    const double d = std::abs(before.points[i].z() - 20),
                 factor = d < 8 ? 1 - 0.5 * (1 + std::cos(M_PI * d / 8)) / 2 : 1;
    EXPECT_NEAR(after.points[i].head<2>().norm(), factor * before.points[i].head<2>().norm(), 1e-9);
  }
  // Around a corner, the insides of two wide vessels are in each other's way.
  write("bent.swc", "1 0 0 0 0 2 -1\n2 0 0 0 10 2 1\n3 0 10 0 10 2 2\n");
  ASSERT_EQ(vmesh({"volume", "@bent.swc", "-o", "@bent.vtu", "--wall-thickness", "0.2", "--wall-only"}).exit_code, 0);
  const std::vector<std::string> files = this->files();
  const Outcome refused = vmesh({"edit", "@bent.swc", "-o", "@out.json", "--dilate", "1,16,3", "--follow", "@bent.vtu",
                                 "--follow-output", "@out.vtu"});
  EXPECT_EQ(refused.exit_code, 7);
  EXPECT_NE(refused.err.find("cells that are flat or turned over somewhere, the first at ("), std::string::npos)
      << refused.err;
  EXPECT_EQ(this->files(), files);
}

TEST_F(Edit, RemovesBranchesAndScales) {
  write_y("y.swc");
  ASSERT_EQ(vmesh({"edit", "@y.swc", "@less.swc", "--remove", "1", "--scale", "2"}).exit_code, 0);
  const Centerline before = centerline("y.swc"), after = centerline("less.swc");
  EXPECT_LT(after.segments().size(), before.segments().size());
  EXPECT_NEAR(after.node(0).radius, 2 * before.node(0).radius, 1e-6);
}

TEST_F(Edit, OptionsMayBeRepeated) {
  ASSERT_EQ(vmesh({"edit", "@line.swc", "-o", "@two.json", "--dilate", "1,4,0.5", "--dilate", "3,4,1", "--stenosis",
                   "2,4,0.25"})
                .exit_code,
            0);
  std::vector<double> radius;
  const Centerline two = centerline("two.json");
  for (const CenterlineNode& node : two.nodes()) {
    if (std::fmod(node.position.z() + 5, 10) == 5) radius.push_back(node.radius);
  }
  std::sort(radius.begin(), radius.end());
  EXPECT_EQ(radius, (std::vector<double>{1.5, 2, 2, 3, 4}));
}

TEST_F(Edit, SaysWhyASurfaceCannotFollow) {
  grow("line.ply");
  const std::vector<std::string> files = this->files();
  const auto expect_refused = [&](std::vector<std::string> arguments, int exit_code, const std::string& message) {
    arguments.insert(arguments.begin(), {"edit", "@line.swc", "-o", "@out.json"});
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    EXPECT_EQ(this->files(), files);
  };
  expect_refused({"--follow", "@line.ply"}, 2, "give both, or none");
  expect_refused({"--stenosis", "2,16,1.5"}, 2, "between 0 and 1");
  expect_refused({"--stenosis", "2,16"}, 2, "--stenosis");
  expect_refused({"--stenosis", "9,16,0.5"}, 3, "line.swc: the change of the radius at node 9");
  expect_refused({"--remove", "0"}, 3, "nothing is left");
  expect_refused({"--remove", "0", "--scale", "nan"}, 2, "--scale");
  // Wider by ten radii over half of one: what is beside it folds over.
  expect_refused({"--dilate", "2,1,10", "--dilate", "1,1,10", "--follow", "@line.ply", "--follow-output", "@out.ply"},
                 7, "cannot follow");
}

}  // namespace
}  // namespace vmesh::testing
