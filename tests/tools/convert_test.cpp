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

void expect_near(const Centerline& a, const Centerline& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  for (Index n = 0; n < a.nodes().size(); ++n) {
    EXPECT_LT((a.node(n).position - b.node(n).position).norm(), 1e-9) << n;
    EXPECT_NEAR(a.node(n).radius, b.node(n).radius, 1e-9) << n;
  }
}

TEST_F(Convert, CenterlinesGoThroughEveryFormatUnchanged) {
  std::vector<std::string> names = {"a.vtp", "a.json", "a.csv", "a.swc"};
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

TEST_F(Convert, FlatEndsAreKeptInJsonAndVtp) {
  write("cut.json", R"({"schema": "vmesh.centerline/1", "unit": "mm", "space": "LPS",
    "nodes": [[0, 0, 0, 2], [5, 0, 0, 2], [9, 0, 0, 2]], "segments": [[0, 1], [1, 2]],
    "end_sections": [{"node": 2, "center": [9, 0, 0], "normal": [1, 0, 0], "area": 12, "open": true,
                      "ring": [[9, 2, 0], [9, -1, 2], [9, -1, -2]]}]})");
  std::string from = "cut.json";
  for (const std::string name : {"a.vtp", "b.json"}) {
    const Outcome run = vmesh({"convert", "@" + from, "@" + name, "--output-unit", "cm", "--output-space", "RAS"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("flat end"), std::string::npos) << run.err;
    const RawCenterline raw = read_centerline(path(name));
    ASSERT_EQ(raw.end_sections.size(), 1u);
    EXPECT_LT((raw.end_sections[0].center - Vec3(-0.9, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(raw.end_sections[0].area, 0.12, 1e-12);
    EXPECT_LT((raw.end_sections[0].ring.at(1) - Vec3(-0.9, 0.1, 0.2)).norm(), 1e-12);
    const Outcome info = vmesh({"info", "@" + name});
    EXPECT_NE(info.out.find("\ncenterline.end_sections: 1\n"), std::string::npos) << info.out;
    from = name;
  }
  const Outcome run = vmesh({"convert", "@cut.json", "@a.swc"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.err.find("1 flat end is lost, being kept only in .vtp and .json"), std::string::npos) << run.err;
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

TEST_F(Convert, WritesTheUnitAndFrameAskedFor) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply"}).exit_code, 0);
  std::vector<std::string> names = {"c.ply", "c.obj", "c.off", "c.stl", "c.vtp"};
  const LoadedSurface before = read_surface(path("y.ply"));
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const Outcome run = vmesh({"convert", "@y.ply", "@" + name, "--output-unit", "cm", "--output-space", "RAS"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const LoadedSurface after = read_surface(path(name));
    EXPECT_EQ(after.unit, LengthUnit::cm);
    EXPECT_EQ(after.space, Space::ras);
    const Vec3& p = before.mesh.vertices[before.mesh.faces[5][1]];
    EXPECT_LT((10 * after.mesh.vertices[after.mesh.faces[5][1]] - Vec3(-p.x(), -p.y(), p.z())).norm(), 1e-5);  // float
    for (const MeshAttribute& a : after.attributes.vertex) {
      if (a.name != "radius") continue;
      EXPECT_NEAR(a.values[5], before.attributes.vertex[0].values[5] / 10, 1e-12);
    }
  }
  ASSERT_EQ(vmesh({"convert", "@y.swc", "@um.json", "--output-unit", "um", "--output-space", "RAS"}).exit_code, 0);
  EXPECT_NE(read("um.json").find("\"unit\": \"um\""), std::string::npos);
  expect_near(centerline("um.json"), centerline("y.swc"));
}

TEST_F(Convert, LeavesAttributesOut) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@y.ply", "@vertex.ply", "--attributes", "vertex"}).exit_code, 0);
  ASSERT_EQ(vmesh({"convert", "@y.ply", "@none.ply", "--attributes", "none"}).exit_code, 0);
  const MeshAttributes vertex = read_surface(path("vertex.ply")).attributes;
  EXPECT_TRUE(vertex.face.empty());
  EXPECT_EQ(vertex.vertex.size(), read_surface(path("y.ply")).attributes.vertex.size());
  const MeshAttributes none = read_surface(path("none.ply")).attributes;
  EXPECT_TRUE(none.face.empty() && none.vertex.empty());
}

TEST_F(Convert, WritesTextWhereTheFormatHasTheChoice) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply", "--ascii"}).exit_code, 0);
  EXPECT_TRUE(read("y.ply").starts_with("ply\nformat ascii 1.0\n"));
  ASSERT_EQ(vmesh({"convert", "@y.ply", "@y.stl", "--ascii"}).exit_code, 0);
  EXPECT_TRUE(read("y.stl").starts_with("solid "));
  ASSERT_EQ(vmesh({"convert", "@y.stl", "@back.ply"}).exit_code, 0);
  const TriMesh before = read_surface(path("y.ply")).mesh, after = read_surface(path("back.ply")).mesh;
  ASSERT_EQ(after.faces.size(), before.faces.size());
  for (std::size_t f = 0; f < before.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_EQ(after.vertices[after.faces[f][i]], before.vertices[before.faces[f][i]]);
  }
  for (const std::string name : {"z.vtp", "z.obj", "z.glb", "z.json"}) {
    const Outcome run = vmesh({"convert", name == "z.json" ? "@y.swc" : "@y.ply", "@" + name, "--ascii"});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--ascii"), std::string::npos) << run.err;
    EXPECT_FALSE(exists(name));
  }
}

TEST_F(Convert, CompressesGlbOnly) {
  ASSERT_EQ(vmesh({"generate", "@y.swc", "@y.ply"}).exit_code, 0);
  for (const char* name : {"z.ply", "z.obj", "z.swc"}) {
    const Outcome run = vmesh({"convert", "@y.ply", std::string("@") + name, "--compress"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find(std::string(name)), std::string::npos) << run.err;
    EXPECT_FALSE(exists(name));
  }
  const Outcome both = vmesh({"convert", "@y.ply", "@z.glb", "--compress", "--ascii"});
  EXPECT_EQ(both.exit_code, 2) << both.err;
  const Outcome run = vmesh({"convert", "@y.ply", "@z.glb", "--compress"});
  if (run.exit_code == 4) {
    EXPECT_NE(run.err.find("VMESH_WITH_MESHOPTIMIZER"), std::string::npos) << run.err;
    EXPECT_FALSE(exists("z.glb"));
    return;
  }
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(vmesh({"convert", "@y.ply", "@plain.glb"}).exit_code, 0);
  EXPECT_LT(read("z.glb").size(), read("plain.glb").size());
}

TEST_F(Convert, NeedsAnOutput) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"convert", "@y.swc"}, {"render", "@y.swc"}, {"synth"}})
    EXPECT_EQ(vmesh(arguments).exit_code, 2);
  EXPECT_EQ(vmesh({"synth", "@s.swc", "--vertices", "9"}).exit_code, 0);
  EXPECT_EQ(vmesh({"cones", "@s.swc", "@s.ply"}).exit_code, 0);
  EXPECT_EQ(vmesh({"render", "@s.ply", "@s.png", "--width", "32", "--height", "32"}).exit_code, 0);
}

TEST_F(Convert, TheOutputMayComeLastForEveryVerb) {
  write("scene.json", R"({"schema": "vmesh.scene/1", "duration_s": 0.02})");
  const std::vector<std::vector<std::string>> runs = {
      {"synth", "@s.json", "--vertices", "9"},
      {"convert", "@y.swc", "@y.json"},
      {"generate", "@y.swc", "@y.ply"},
      {"cones", "@y.swc", "@cones.ply"},
      {"centerline", "@y.ply", "@again.json"},
      {"fit", "@y.ply", "@y.ply", "@fitted.ply", "--centerline", "@y.swc", "--fit-rounds", "1"},
      {"render", "@y.ply", "@y.png", "--width", "32", "--height", "32"},
      {"deform", "@y.swc", "@y.ply", "@frames", "--script", "@scene.json", "--format", "ply"},
  };
  for (const std::vector<std::string>& arguments : runs) {
    const Outcome run = vmesh(arguments);
    EXPECT_EQ(run.exit_code, 0) << arguments[0] << run.err;
  }
  for (const char* name : {"s.json", "y.json", "y.ply", "cones.ply", "again.json", "fitted.ply", "y.png", "frames"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_EQ(vmesh({"reference", "@y.swc", "@reference.ply", "--voxel", "1"}).exit_code, 0);
  EXPECT_TRUE(exists("reference.ply"));
}

TEST_F(Convert, AVtpIsTakenForWhatItHolds) {
  ASSERT_EQ(vmesh({"convert", "@y.swc", "-o", "@lines.vtp"}).exit_code, 0);
  ASSERT_EQ(vmesh({"generate", "@y.swc", "-o", "@faces.vtp"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@lines.vtp", "-o", "@back.swc"}).exit_code, 0);
  EXPECT_EQ(vmesh({"convert", "@faces.vtp", "-o", "@back.ply"}).exit_code, 0);
  const Outcome lines = vmesh({"convert", "@lines.vtp", "-o", "@wrong.ply"});
  EXPECT_EQ(lines.exit_code, 2);
  EXPECT_NE(lines.err.find("lines.vtp: holds lines, no faces: a centerline"), std::string::npos) << lines.err;
  EXPECT_EQ(vmesh({"convert", "@faces.vtp", "-o", "@wrong.swc"}).exit_code, 2);
  EXPECT_FALSE(exists("wrong.ply") || exists("wrong.swc"));
}

}  // namespace
}  // namespace vmesh::testing
