#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include <zlib.h>

#include "vmesh/io/surface_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;
using testing::shared_data;
using testing::TemporaryFolder;

LoadedSurface parse(const std::string& name, const std::string& text) {
  return parse_surface(text, surface_format(name), "t");
}
std::string error(const std::string& name, const std::string& text) {
  return message_of<InvalidInput>([&] { parse(name, text); });
}

const std::string kPlyText =
    "ply\nformat ascii 1.0\ncomment SPACE=RAS\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar label\nelement face 2\nproperty list uchar int vertex_indices\nproperty float "
    "quality\nend_header\n";

TEST(ReadPly, SplitsPolygonsAndKeepsAttributes) {
  const auto surface = parse("t.ply", kPlyText + "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0.5 4\n4 0 1 2 3 0.25\n3 0 1 3 0.5\n");
  EXPECT_EQ(surface.mesh.vertices[3], Vec3(0, 1, 0.5));
  EXPECT_EQ(surface.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}}));
  ASSERT_EQ(surface.attributes.vertex.size(), 1u);
  EXPECT_EQ(surface.attributes.vertex[0].values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_TRUE(surface.attributes.vertex[0].integer);
  ASSERT_EQ(surface.attributes.face.size(), 1u);
  EXPECT_EQ(surface.attributes.face[0].values, (std::vector<double>{0.25, 0.25, 0.5}));
  EXPECT_EQ(surface.space, Space::ras);
  EXPECT_EQ(surface.warnings.size(), 1u) << "the polygon";
}

TEST(ReadPly, ReadsBigEndian) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty uchar y\nproperty char z\n"
      "element face 1\nproperty list uchar ushort vertex_index\nend_header\n";
  const std::vector<std::vector<int>> records = {
      {1, 2, 3, 0xff}, {0xff, 0xfe, 200, 0xff}, {1, 0, 7, 0}, {3, 0, 0, 0, 1, 0, 2}};
  for (const auto& record : records) {
    for (const int byte : record) bytes += static_cast<char>(byte);
  }
  const auto surface = parse("t.ply", bytes);
  EXPECT_EQ(surface.mesh.vertices[0], Vec3(258, 3, -1));
  EXPECT_EQ(surface.mesh.vertices[1], Vec3(-2, 200, -1));
  EXPECT_EQ(surface.mesh.vertices[2], Vec3(256, 7, 0));
}

TEST(ReadPly, BelievesNoHeaderThatTheFileCannotKeep) {
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  expect_contains(
      error("t.ply", head + "353535235358\nproperty float x\nproperty float y\nproperty float z\nend_header\n"),
      "353535235358");
  expect_contains(error("t.ply", head + "1\nproperty list uint float x\nend_header\n\xff\xff\xff\xff"), "x, y and z");
  expect_contains(error("t.ply", head + "0\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                                        "property list uint int vertex_indices\nend_header\n\xff\xff\xff\x7f"),
                  "length");
  expect_contains(error("t.ply", head + "-1\nend_header\n"), "line 3");
  expect_contains(error("t.ply", head + "99999999999999999\nend_header\n"), "line 3");
  expect_contains(error("t.ply", head + "4000000000\nend_header\n"), "no triangle");
}

TEST(ReadPly, NamesWhatIsWrong) {
  expect_contains(error("t.ply", "plx\n"), "line 1");
  expect_contains(error("t.ply", "ply\nformat ascii 1.0\n"), "end_header");
  expect_contains(error("t.ply", "ply\nend_header\n"), "format");
  expect_contains(error("t.ply", "ply\nformat zip 1.0\n"), "zip");
  expect_contains(error("t.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"), "quad");
  expect_contains(error("t.ply", kPlyText + "0 0 0 1\n1 0 0 2\n"), "promises");
  expect_contains(error("t.ply", kPlyText + "0 0 0 1 1 0 0 2 1 1 0 3 0 1 x 4 3 0 1 2 0 3 0 1 2 0"), "vertex 3");
  expect_contains(error("t.ply", kPlyText + "0 0 0 1 1 0 0 2 1 1 0 3 0 1 nan 4 3 0 1 2 0 3 0 1 2 0"), "vertex 3");
  expect_contains(error("t.ply", kPlyText + "0 0 0 1 1 0 0 2 1 1 0 3 0 1 0 4 3 0 1 2 0 3 0 1 4 0"), "face 1");
  expect_contains(error("t.ply", kPlyText + "0 0 0 1 1 0 0 2 1 1 0 3 0 1 0 4 3 0 1 2 0 3 0 1 -1 0"), "face 1");
}

TEST(ReadStl, JoinsEqualCornersOfTextAndBinary) {
  const std::string facet = " facet normal 0 0 1\n  outer loop\n";
  const auto surface =
      parse("t.stl", "solid SPACE=LPS\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n" +
                         facet + "vertex -0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid\n");
  EXPECT_EQ(surface.mesh.vertices.size(), 4u);
  EXPECT_EQ(surface.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(surface.space, Space::lps);
}

TEST(ReadStl, NamesWhatIsWrong) {
  expect_contains(error("t.stl", "hello"), "not an STL");
  expect_contains(error("t.stl", std::string(80, ' ') + "\xff\xff\xff\xff" + std::string(50, '\0')), "promises");
  expect_contains(error("t.stl", "solid\nvertex 0 0\n"), "line 2");
  expect_contains(error("t.stl", "solid\nvertex 0 0 nan\n"), "line 2");
}

TEST(ReadObj, TakesAllKindsOfCorners) {
  const auto surface =
      parse("t.obj",
            "# SPACE=LPS UNIT=cm\nf 1 2/5 3//7\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0\nv 0 1 0\nvt 0 0\nv 0 0 1\n"
            "f -4/1/1 -1 \\\n -2\nl 1 2\nf 1 1 2\n");
  EXPECT_EQ(surface.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}}));
  EXPECT_EQ(surface.unit, LengthUnit::cm);
  EXPECT_EQ(surface.warnings.size(), 1u) << "the face with a repeated corner";
}

std::string obj_polygon(const std::vector<Vec3>& corners) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : corners) text << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  text << "f";
  for (std::size_t i = 1; i <= corners.size(); ++i) text << " " << i;
  text << "\n";
  return text.str();
}

// A fan of it would cover four times its area.
TEST(ReadObj, TriangulatesAConcavePolygonWithinIt) {
  const Vec3 u = Vec3(1, 2, -1).normalized(), v = u.unitOrthogonal(), normal = u.cross(v);
  for (const double sense : {1.0, -1.0}) {
    std::vector<Vec3> star;
    Vec3 area = Vec3::Zero();
    for (int i = 0; i < 14; ++i) {
      const double angle = sense * std::numbers::pi * i / 7, r = i % 2 == 0 ? 0.2 : 3;
      star.push_back(Vec3(5, 6, 7) + r * (std::cos(angle) * u + std::sin(angle) * v));
    }
    for (int i = 0; i < 14; ++i) area += star[i].cross(star[(i + 1) % 14]) / 2;
    const TriMesh mesh = parse("t.obj", obj_polygon(star)).mesh;
    ASSERT_EQ(mesh.faces.size(), 12u);
    double sum = 0;
    for (Index f = 0; f < 12; ++f) {
      EXPECT_GT(sense * area_normal(mesh, f).dot(normal), 0) << f;
      sum += area_normal(mesh, f).norm() / 2;
    }
    EXPECT_NEAR(sum, area.norm(), 1e-12);  // rounding of coordinates of about 10
  }
}

TEST(ReadObj, MakesAFanOfAPolygonThatIsNotSimple) {
  const std::vector<Triangle> fan = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(parse("t.obj", obj_polygon({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}})).mesh.faces, fan);
  EXPECT_EQ(parse("t.obj", obj_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}})).mesh.faces, fan);
}

TEST(ReadObj, NamesTheLineThatIsWrong) {
  expect_contains(error("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), "line 4");
  expect_contains(error("t.obj", "v 0 0 0\nf 1 0 1\n"), "line 2");
  expect_contains(error("t.obj", "v 0 0\n"), "line 1");
  expect_contains(error("t.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n"), "vertex 2");
  expect_contains(error("t.obj", "v 0 0 0\nf -2 1 1\n"), "line 2");
}

TEST(ReadOff, NamesTheLineThatIsWrong) {
  EXPECT_EQ(parse("t.off", "OFF 3 1 0\n0 0 0\n# c\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n").mesh.faces.size(), 1u);
  expect_contains(error("t.off", "OFG\n"), "line 1");
  expect_contains(error("t.off", "OFF\n999999999999 1 0\n0 0 0\n"), "999999999999");
  expect_contains(error("t.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"), "ends");
  expect_contains(error("t.off", "OFF\n1 1 0\n0 0 0\n9 0 0 0\n"), "line 4");
}

TEST(ReadSurface, SaysWhenThereIsNothingToRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_surface(folder / "none.ply"), ReadError);
  std::filesystem::create_directory(folder / "sub.ply");
  EXPECT_THROW(read_surface(folder / "sub.ply"), ReadError);
  EXPECT_THROW(read_surface(folder.write("a.docx", "x")), Unsupported);
  for (const std::string name : {"e.ply", "e.stl", "e.obj", "e.off", "e.vtp"}) {
    expect_contains(message_of<InvalidInput>([&] { read_surface(folder.write(name, "")); }), name);
  }
}

TEST(ReadSurface, EveryCutFileIsRefusedOrRead) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  for (const char* name : {"t.ply", "t.stl", "t.off", "t.obj"}) {
    write_surface(folder / name, mesh, {{{"radius", {1, 2, 3, 4}, false}}, {}});
    const std::string whole = testing::content_of(folder / name);
    std::size_t refused = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      try {
        parse(name, whole.substr(0, size));
      } catch (const InvalidInput&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, whole.size() / 3) << name;
    EXPECT_NO_THROW(parse(name, whole)) << name;
  }
}

#if VMESH_WITH_ASSIMP
constexpr const char* kCollada =
    "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit name=\"cm\" "
    "meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
    "<float_array id=\"a\" count=\"12\">0 0 0 4 0 0 4 4 0 0 4 2</float_array><technique_common><accessor source=\"#a\" "
    "count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
    "type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
    "source=\"#p\"/></vertices><triangles count=\"2\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
    "<p>0 1 2 0 2 3</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene "
    "id=\"s\">"
    "<node id=\"n\"><translate>1 0 0</translate><instance_geometry url=\"#g\"/></node></visual_scene>"
    "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
constexpr const char* kX3d =
    "<X3D version=\"3.2\"><Scene><Shape><IndexedFaceSet coordIndex=\"0 1 2 -1 0 2 3 -1\"><Coordinate point=\"0 0 0 1 0 "
    "0 1 "
    "1 0 0 1 1\"/></IndexedFaceSet></Shape></Scene></X3D>";

TEST(ReadScene, TakesNodesAndUnitsInGlbAndCollada) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{10, 20, 30}, {11, 20, 30}, {10, 22, 30}, {10, 20, 33}},
                        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  write_surface(folder / "t.glb", mesh);
  const LoadedSurface glb = read_surface(folder / "t.glb");
  // A name other than ours for the frame makes it a scene like others.
  std::string foreign = testing::content_of(folder / "t.glb");
  foreign[foreign.find("metres; x")] = 'M';
  const LoadedSurface scene = read_surface(folder.write("f.glb", foreign));
  EXPECT_EQ(glb.unit, LengthUnit::mm);
  EXPECT_EQ(scene.unit, LengthUnit::m);
  for (const LoadedSurface* read : {&glb, &scene}) {
    EXPECT_EQ(read->mesh.faces, mesh.faces);
    ASSERT_EQ(read->mesh.vertices.size(), 4u);
    for (std::size_t v = 0; v < 4; ++v)
      EXPECT_LT((millimetres_per(read->unit) * read->mesh.vertices[v] - mesh.vertices[v]).norm(), 1e-5);  // float
  }
  const LoadedSurface collada = read_surface(folder.write("t.dae", kCollada));
  EXPECT_EQ(collada.unit, LengthUnit::m);
  ASSERT_EQ(collada.mesh.vertices.size(), 4u);
  EXPECT_EQ(collada.mesh.faces.size(), 2u);
  EXPECT_LT((collada.mesh.vertices[collada.mesh.faces[1][2]] - Vec3(0.01, 0.04, 0.02)).norm(), 1e-7);
}

/// A ZIP archive of uncompressed files.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto number = [](std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
    return text;
  };
  std::string all, directory;
  for (const auto& [name, content] : files) {
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    const std::string about = number(20, 2) + number(0, 8) + number(checksum, 4) + number(content.size(), 4) +
                              number(content.size(), 4) + number(name.size(), 2) + number(0, 2);
    directory += "PK\1\2" + number(20, 2) + about + number(0, 10) + number(all.size(), 4) + name;
    all += "PK\3\4" + about + name + content;
  }
  return all + directory + "PK\5\6" + number(0, 4) + number(files.size(), 2) + number(files.size(), 2) +
         number(directory.size(), 4) + number(all.size(), 4) + number(0, 2);
}

std::string model_3mf(const std::string& attributes) {
  const std::string relations =
      R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
      R"(<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/)"
      R"(3dmodel"/></Relationships>)";
  const std::string model =
      R"(<?xml version="1.0"?><model )" + attributes +
      R"( xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources><object id="1" type="model">)"
      R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="2" y="0" z="0"/><vertex x="0" y="3" z="0"/></vertices>)"
      R"(<triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>)"
      R"(<build><item objectid="1"/></build></model>)";
  return zip({{"_rels/.rels", relations}, {"3D/3dmodel.model", model}});
}

TEST(ReadScene, TheUnitOfA3mfIsRead) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& attributes) {
    return read_surface(folder.write("t.3mf", model_3mf(attributes)));
  };
  EXPECT_EQ(read(R"(unit="micron")").unit, LengthUnit::um);
  EXPECT_EQ(read(R"(unit="millimeter")").unit, LengthUnit::mm);
  EXPECT_EQ(read(R"(unit="centimeter")").unit, LengthUnit::cm);
  EXPECT_EQ(read(R"(unit="meter")").unit, LengthUnit::m);
  EXPECT_EQ(read("").unit, LengthUnit::mm) << "what the specification takes for granted";
  EXPECT_EQ(read(R"(unit="ell")").unit, LengthUnit::unknown);
  const LoadedSurface inches = read(R"(unit="inch")");
  EXPECT_EQ(inches.unit, LengthUnit::mm);
  EXPECT_NEAR(inches.mesh.vertices.at(1).x(), 50.8, 1e-5) << "float";
}

TEST(ReadScene, A3mfThatWasWrittenComesBack) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{0, 0, 0}, {1.5, 0, 0}, {0, 2.25, 0}, {0, 0, -3}},
                        {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  SurfaceMetadata metadata;
  metadata.generator = "a <generator> & more";
  metadata.unit = LengthUnit::um;
  write_surface(folder / "t.3mf", mesh, {}, metadata);
  const LoadedSurface read = read_surface(folder / "t.3mf");
  EXPECT_EQ(read.unit, LengthUnit::um);
  const std::vector<Vec3> in_um = {{0, 0, 0}, {1500, 0, 0}, {0, 2250, 0}, {0, 0, -3000}};
  EXPECT_EQ(read.mesh.vertices, in_um) << "numbers that floats have";
  EXPECT_EQ(read.mesh.faces, mesh.faces);
  const std::string bytes = testing::content_of(folder / "t.3mf");
  write_surface(folder / "t.3mf", mesh, {}, metadata);
  EXPECT_EQ(testing::content_of(folder / "t.3mf"), bytes);
  metadata.unit = LengthUnit::nm;
  EXPECT_THROW(write_surface(folder / "u.3mf", mesh, {}, metadata), Unsupported);
}

TEST(ReadScene, DamagedFilesAreRefusedOrRead) {
  const TemporaryFolder folder;
  write_surface(folder / "t.glb", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  const std::string whole = testing::content_of(folder / "t.glb");
  for (const std::string name : {"d.glb", "d.dae", "d.fbx", "d.x3d", "d.3mf", "d.gltf"}) {
    const std::string base = name == "d.dae" ? kCollada : name == "d.x3d" ? kX3d : whole;
    for (std::size_t i = 0; i < 12; ++i) {
      SCOPED_TRACE(name + " " + std::to_string(i));
      std::string damaged = base;
      damaged[(i * 7919 + 13) % damaged.size()] = static_cast<char>(i * 31);
      if (i % 3 == 0) damaged.resize(damaged.size() * (i + 1) / 13);
      try {
        EXPECT_FALSE(read_surface(folder.write(name, damaged)).mesh.faces.empty());
      } catch (const InvalidInput& problem) {
        expect_contains(problem.what(), name);
      }
    }
  }
}

// assimp passes on what the file says.
TEST(ReadScene, FacesReferToVerticesThatAreThere) {
  const std::string path = VMESH_FOUND "/x3d/face_beyond_the_vertices.x3d";
  const std::string refused = message_of<InvalidInput>([&] { read_surface(path); });
  expect_contains(refused, path);
  expect_contains(refused, "vertex 3 of a mesh with 3");
}
#else
TEST(ReadScene, NeedsAssimp) {
  const TemporaryFolder folder;
  expect_contains(message_of<Unsupported>([&] { read_surface(folder.write("t.glb", "glTF")); }), "VMESH_WITH_ASSIMP");
}
#endif

/// A tetrahedron with two vertices at one place, and attributes.
TriMesh glb_mesh() {
  return {{{10, 20, 30}, {11, 20, 30}, {10, 22, 30}, {10, 20, 33}, {10, 20, 33}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 4}, {2, 0, 4}}};
}

TEST(ReadGlb, OurFilesComeBackWithFrameAndAttributes) {
  const TemporaryFolder folder;
  const TriMesh mesh = glb_mesh();
  MeshAttributes attributes;
  attributes.vertex = {{"red", {255, 1, 2, 3, 9}, true},
                       {"green", {0, 0, 4, 5, 77}, true},
                       {"blue", {254, 128, 6, 7, 8}, true},
                       {"radius", {1.5, 2, 2.5, 3, 3}, false},
                       {"segment", {0, 1, 2, 3, 70000}, true},
                       {"ModelFaceID", {1, 1, 2, 2, 3}, true},
                       {"volume distance", {-1, 0, .5, 1, 2}, false},
                       {"volume_distance", {0, 0, .25, 0, 0}, false}};
  write_surface(folder / "t.glb", mesh, attributes);
  LoadedSurface read = read_surface(folder / "t.glb");
  EXPECT_EQ(read.unit, LengthUnit::mm);
  EXPECT_EQ(read.space, Space::lps);
  EXPECT_EQ(read.mesh.faces, mesh.faces);
  ASSERT_EQ(read.mesh.vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_LT((read.mesh.vertices[v] - mesh.vertices[v]).norm(), 1e-6) << "float, from the middle of the surface";
  ASSERT_EQ(read.attributes.vertex.size(), attributes.vertex.size());
  for (std::size_t a = 0; a < attributes.vertex.size(); ++a) {
    EXPECT_EQ(read.attributes.vertex[a].name, attributes.vertex[a].name);
    EXPECT_EQ(read.attributes.vertex[a].values, attributes.vertex[a].values);
    EXPECT_EQ(read.attributes.vertex[a].integer, attributes.vertex[a].integer);
  }
  convert_to_internal(read, "t.glb", {}, {});
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.attributes.vertex[3].values[0], 1.5);
}

TEST(ReadGlb, EveryColourComesBack) {
  const TemporaryFolder folder;
  TriMesh mesh;
  MeshAttributes attributes;
  for (const char* channel : {"red", "green", "blue", "alpha"}) attributes.vertex.push_back({channel, {}, true});
  for (int i = 0; i < 256; ++i) {
    mesh.vertices.emplace_back(i, i % 2, 0);
    if (i > 1) mesh.faces.push_back({static_cast<Index>(i - 2), static_cast<Index>(i - 1), static_cast<Index>(i)});
    for (int c = 0; c < 4; ++c) attributes.vertex[static_cast<std::size_t>(c)].values.push_back((i + 64 * c) % 256);
  }
  write_surface(folder / "t.glb", mesh, attributes);
  const LoadedSurface read = read_surface(folder / "t.glb");
  ASSERT_EQ(read.attributes.vertex.size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(read.attributes.vertex[c].name, attributes.vertex[c].name);
    EXPECT_EQ(read.attributes.vertex[c].values, attributes.vertex[c].values);
  }
}

TEST(ReadGlb, AColourChannelAloneIsAnAttribute) {
  const TemporaryFolder folder;
  MeshAttributes attributes;
  attributes.vertex = {{"red", {1, 2, 3, 4, 5}, true}};
  write_surface(folder / "t.glb", glb_mesh(), attributes);
  const LoadedSurface read = read_surface(folder / "t.glb");
  ASSERT_EQ(read.attributes.vertex.size(), 1u);
  EXPECT_EQ(read.attributes.vertex[0].name, "red");
  EXPECT_EQ(read.attributes.vertex[0].values, attributes.vertex[0].values);
}

TEST(ReadGlb, ABrokenFileIsRefused) {
  const TemporaryFolder folder;
  MeshAttributes attributes;
  attributes.vertex = {{"radius", {1, 1, 1, 1, 1}, false}};
  write_surface(folder / "t.glb", glb_mesh(), attributes);
  const std::string whole = testing::content_of(folder / "t.glb");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    EXPECT_EQ(from.size(), to.size());
    return message_of<InvalidInput>(
        [&] { parse_surface(text.replace(at, from.size(), to), surface_format("t.glb"), "t.glb"); });
  };
  expect_contains(with("\"count\":5", "\"count\":9"), "t.glb: accessor 0: its numbers are not there");
  expect_contains(with("\"count\":5", "\"count\":4"),
                  "t.glb: the attribute \"radius\" has not one number for every vertex");
  expect_contains(with("\"byteOffset\":120", "\"byteOffset\":-20"), "no number where one must be");
  expect_contains(with("POSITION", "POSITIVE"), "no \"POSITION\"");
  expect_contains(with("\"VEC3\"", "\"VEC4\""), "accessor 0: its numbers are not of the type");
}

TEST(SharedData, EveryAdversarialMeshIsReadOrRefusedWithItsName) {
  VMESH_NEED_SHARED_DATA("adversarial_mesh_trimesh");
  std::set<std::string> refused;
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shared_data("adversarial_mesh_trimesh"))) {
    const std::string name = entry.path().filename().string();
    if (name == "LICENSE.md") continue;
    SCOPED_TRACE(name);
    try {
      EXPECT_FALSE(read_surface(entry.path()).mesh.faces.empty());
      ++read;
    } catch (const InvalidInput& problem) {
      expect_contains(problem.what(), name);
      refused.insert(name);
    }
  }
  EXPECT_GE(read, 20u);
  for (const auto& name : refused) {
    EXPECT_TRUE(name.find("empty") != std::string::npos || name.find("points") != std::string::npos) << name;
  }
}

TEST(SharedData, KnownMeshesHaveTheirKnownSizes) {
  VMESH_NEED_SHARED_DATA("adversarial_mesh_trimesh");
  const auto sphere = read_surface(shared_data("adversarial_mesh_trimesh/unit_sphere.STL")).mesh;
  EXPECT_EQ(sphere.vertices.size() + sphere.faces.size(), 3 * sphere.faces.size() / 2 + 2) << "Euler: closed, genus 0";
  const auto torus = read_surface(shared_data("adversarial_mesh_trimesh/torus.STL")).mesh;
  EXPECT_EQ(torus.vertices.size() + torus.faces.size(), 3 * torus.faces.size() / 2) << "Euler: closed, genus 1";
  const auto knot = read_surface(shared_data("adversarial_mesh_trimesh/quadknot.obj")).mesh;
  EXPECT_EQ(knot.vertices.size() + knot.faces.size(), 3 * knot.faces.size() / 2);
}

}  // namespace
}  // namespace vmesh
