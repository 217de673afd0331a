#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class Convert : public CommandTest {
 protected:
  Convert() { write_y("y.swc"); }

  Centerline centerline(const std::string& name) const {
    CenterlineLoadOptions options;
    options.cleaning.canonical_order = false;
    return load_centerline(path(name), options).cleaned.centerline;
  }
};

TEST_F(Convert, CenterlinesGoThroughEveryFormatUnchanged) {
  std::vector<std::string> names = {"a.json", "a.csv", "a.swc"};
  if (VMESH_TEST_WITH_VTK) names.insert(names.begin(), "a.vtp");
  std::string from = "y.swc";
  for (const std::string& name : names) {
    const Outcome run = vmesh({"convert", "@" + from, "-o", "@" + name});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
    from = name;
  }
  const Centerline before = centerline("y.swc"), after = centerline("a.swc");
  ASSERT_EQ(after.nodes().size(), before.nodes().size());
  ASSERT_EQ(after.segments().size(), before.segments().size());
  for (Index n = 0; n < before.nodes().size(); ++n) {
    EXPECT_EQ(after.node(n).position, before.node(n).position);
    EXPECT_EQ(after.node(n).radius, before.node(n).radius);
  }
}

TEST_F(Convert, VmvIsReadAndNotWritten) {
  write("y.vmv",
        "$VERT_LIST_BEGIN\n1 0 0 0 3000\n2 0 0 9000 2500\n3 0 5000 15000 2000\n4 0 -5000 15000 2000\n$VERT_LIST_END\n"
        "$STRANDS_LIST_BEGIN\n1 1 2\n2 2 3 4 2\n$STRANDS_LIST_END\n");
  const Outcome assumed = vmesh({"convert", "@y.vmv", "-o", "@mm.json"});
  ASSERT_EQ(assumed.exit_code, 0) << assumed.err;
  EXPECT_NE(assumed.err.find("does not say its unit; taken as mm"), std::string::npos) << assumed.err;
  ASSERT_EQ(vmesh({"convert", "@y.vmv", "-o", "@um.json", "--unit", "um"}).exit_code, 0);
  const Centerline um = centerline("um.json");
  EXPECT_EQ(um.node(0).radius, 3);
  EXPECT_EQ(um.cycle_rank(), 1u);
  EXPECT_EQ(centerline("mm.json").node(0).radius, 3000);
  EXPECT_EQ(vmesh({"generate", "@y.vmv", "-o", "@y.ply", "--unit", "um"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@y.swc", "-o", "@z.vmv"}).exit_code, 4);
  EXPECT_EQ(vmesh({"convert", "@y.vmv", "-o", "@y.stl"}).exit_code, 2);
}

TEST_F(Convert, CenterlineUnitsAndFrameBecomeMillimetresAndLps) {
  ASSERT_EQ(vmesh({"convert", "@y.swc", "-o", "@cm.json", "--unit", "cm", "--space", "RAS"}).exit_code, 0);
  const Centerline before = centerline("y.swc"), after = centerline("cm.json");
  EXPECT_NEAR((after.node(3).position - Vec3(-80, -30, 330)).norm(), 0, 1e-9);
  EXPECT_NEAR(after.node(3).radius, 10 * before.node(3).radius, 1e-9);
}

TEST_F(Convert, SurfacesGoThroughEveryFormat) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  const TriMesh before = read_surface(path("y.ply")).mesh;
  for (const char* name : {"b.obj", "b.off", "b.stl"}) {
    const Outcome run = vmesh({"convert", "@y.ply", "-o", "@" + std::string(name)});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const TriMesh after = read_surface(path(name)).mesh;
    EXPECT_EQ(after.vertices.size(), before.vertices.size()) << name;
    EXPECT_EQ(after.faces.size(), before.faces.size()) << name;
  }
}

TEST_F(Convert, SurfaceUnitsScaleLengthsToo) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@y.ply"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@y.ply", "-o", "@cm.ply", "--unit", "cm"}).exit_code, 0);
  const LoadedSurface before = read_surface(path("y.ply")), after = read_surface(path("cm.ply"));
  ASSERT_EQ(after.mesh.vertices.size(), before.mesh.vertices.size());
  EXPECT_NEAR((after.mesh.vertices[5] - 10 * before.mesh.vertices[5]).norm(), 0, 1e-9);
  EXPECT_EQ(after.attributes.vertex[0].name, "radius");
  EXPECT_NEAR(after.attributes.vertex[0].values[5], 10 * before.attributes.vertex[0].values[5], 1e-9);
}

#if VMESH_TEST_WITH_VTK
TEST_F(Convert, AVtpIsTakenForWhatItHolds) {
  ASSERT_EQ(vmesh({"convert", "@y.swc", "-o", "@lines.vtp"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@faces.vtp"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@lines.vtp", "-o", "@back.swc"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@faces.vtp", "-o", "@back.ply"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@lines.vtp", "-o", "@wrong.ply"}).exit_code, 2);
  EXPECT_EQ(vmesh({"convert", "@faces.vtp", "-o", "@wrong.swc"}).exit_code, 2);
  EXPECT_FALSE(exists("wrong.ply") || exists("wrong.swc"));
}
#endif

}  // namespace
}  // namespace vmesh::testing
