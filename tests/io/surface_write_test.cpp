#include <algorithm>
#include <cmath>
#include <sstream>

#include "vmesh/io/surface_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::TemporaryFolder;

TriMesh tetrahedron() {
  const double s = std::sqrt(2.0), t = 1.0 / 3;
  return {{{s, 0, -t}, {-s / 2, s * t, -t}, {-s / 2, -s * t, -1e-9}, {0, 0, 1e5}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

MeshAttributes attributes() {
  return {{{"radius", {1.0 / 3, 2, 3, 4}, false}, {"segment", {0, 7, 7, 2}, true}},
          {{"EquiangleSkewness", {0.1, 0.2, 0.3, 0.4}, false}, {"group", {5, 6, 7, 8}, true}}};
}

const SurfaceMetadata kMetadata = {"vmesh 1", "--around 6", "in.swc", "abc123"};

void expect_same(const MeshAttribute& a, const MeshAttribute& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.integer, b.integer);
}

std::vector<std::string> extensions() {
  std::vector<std::string> result = {".off", ".obj", ".stl", ".ply"};
  result.push_back(".vtp");
  return result;
}

TEST(WriteSurface, EveryFormatButStlBringsEveryBitBack) {
  const TemporaryFolder folder;
  const TriMesh mesh = tetrahedron();
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    write_surface(folder / ("t" + extension), mesh, attributes(), kMetadata);
    const auto back = read_surface(folder / ("t" + extension));
    EXPECT_EQ(back.unit, LengthUnit::mm);
    EXPECT_EQ(back.space, Space::lps);
    EXPECT_TRUE(back.warnings.empty());
    ASSERT_EQ(back.mesh.faces.size(), mesh.faces.size());
    ASSERT_EQ(back.mesh.vertices.size(), mesh.vertices.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& was = mesh.vertices[mesh.faces[f][i]];
        const Vec3& is = back.mesh.vertices[back.mesh.faces[f][i]];
        for (int k = 0; k < 3; ++k) {
          if (extension == ".stl") {
            EXPECT_EQ(static_cast<float>(is[k]), static_cast<float>(was[k]));
          } else {
            EXPECT_EQ(is[k], was[k]);
          }
        }
      }
    }
  }
}

void expect_same(const TriMesh& is, const TriMesh& was) {
  ASSERT_EQ(is.faces.size(), was.faces.size());
  for (std::size_t f = 0; f < was.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(is.vertices.at(is.faces[f][i]), was.vertices.at(was.faces[f][i])) << f;
  }
}

TEST(WriteSurface, TextBringsEveryBitBack) {
  const TemporaryFolder folder;
  for (const std::string extension : {".stl", ".ply"}) {
    SCOPED_TRACE(extension);
    const auto path = folder / ("t" + extension);
    write_surface(path, tetrahedron(), attributes(), kMetadata, {SurfaceEncoding::text});
    const std::string content = content_of(path);
    EXPECT_TRUE(
        std::all_of(content.begin(), content.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
    const auto back = read_surface(path);
    EXPECT_EQ(back.unit, LengthUnit::mm);
    EXPECT_EQ(back.space, Space::lps);
    expect_same(back.mesh, tetrahedron());
  }
  const MeshAttributes back = read_surface(folder / "t.ply").attributes;
  ASSERT_EQ(back.vertex.size(), 2u);
  ASSERT_EQ(back.face.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    expect_same(back.vertex[i], attributes().vertex[i]);
    expect_same(back.face[i], attributes().face[i]);
  }
}

TEST(WriteSurface, ANumberOfTextIsTheShortestThatIsTheSame) {
  const TemporaryFolder folder;
  TriMesh mesh = tetrahedron();
  mesh.vertices[3] = {0.1, 1.0 / 3, 1e5};
  write_surface(folder / "t.stl", mesh, {}, kMetadata, {SurfaceEncoding::text});
  expect_contains(content_of(folder / "t.stl"), "vertex 0.1 0.3333333333333333 1e+05\n");
}

TEST(WriteSurface, TextIsRefusedByFormatsWithoutTheChoice) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name) {
    return testing::message_of<Unsupported>(
        [&] { write_surface(folder / name, tetrahedron(), {}, {}, {SurfaceEncoding::text}); });
  };
  expect_contains(refused("t.vtp"), "t.vtp: VTP has no text form");
  expect_contains(refused("t.glb"), "t.glb: GLB has no text form");
  expect_contains(refused("t.obj"), "t.obj: OBJ is always text");
  expect_contains(refused("t.off"), ".stl and .ply");
  EXPECT_EQ(folder.file_count(), 0u);
}

/// The word after `key`, and how many lines begin with `item` until the next key.
std::vector<std::pair<std::string, int>> sections(const std::string& content, const std::string& key,
                                                  const std::string& item) {
  std::vector<std::pair<std::string, int>> result;
  std::istringstream lines(content);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key + " ")) result.emplace_back(line.substr(key.size() + 1), 0);
    if (line.starts_with(item + " ")) ++result.at(result.size() - 1).second;
  }
  return result;
}

TEST(WriteSurface, BoundariesAreSolidsAndGroups) {
  const TemporaryFolder folder;
  MeshAttributes with_caps = attributes();
  with_caps.face.push_back({"CapID", {12, -1, 3, -1}, true});
  write_surface(folder / "t.stl", tetrahedron(), with_caps, kMetadata, {SurfaceEncoding::text});
  write_surface(folder / "t.obj", tetrahedron(), with_caps, kMetadata);
  const std::vector<std::pair<std::string, int>> expected = {{"wall", 2}, {"cap_3", 1}, {"cap_12", 1}};
  EXPECT_EQ(sections(content_of(folder / "t.stl"), "solid", "facet normal"), expected);
  EXPECT_EQ(sections(content_of(folder / "t.obj"), "g", "f"), expected);
  for (const char* name : {"t.stl", "t.obj"}) {
    const auto back = read_surface(folder / name);
    EXPECT_EQ(back.space, Space::lps);
    ASSERT_EQ(back.mesh.faces.size(), 4u);
    for (std::size_t i = 0; i < 3; ++i) {  // the first of the wall
      EXPECT_EQ(back.mesh.vertices.at(back.mesh.faces[0][i]), tetrahedron().vertices[tetrahedron().faces[1][i]]);
    }
  }
  with_caps.face.back() = {"ModelFaceID", {2, 1, 2, 2}, true};
  write_surface(folder / "t.obj", tetrahedron(), with_caps, kMetadata);
  EXPECT_EQ(sections(content_of(folder / "t.obj"), "g", "f"), (decltype(expected){{"face_1", 1}, {"face_2", 3}}));
  write_surface(folder / "t.obj", tetrahedron(), attributes(), kMetadata);
  EXPECT_EQ(sections(content_of(folder / "t.obj"), "g", "f"), (decltype(expected){{"surface", 4}}));
}

TEST(WriteSurface, ObjHasTheNormalOfEveryVertex) {
  const TemporaryFolder folder;
  const TriMesh cube_corner = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  write_surface(folder / "t.obj", cube_corner);
  const std::string content = content_of(folder / "t.obj");
  expect_contains(content, "vn -0.57735026 -0.57735026 -0.57735026\n");  // 1 / sqrt(3)
  expect_contains(content, "f 1//1 3//3 2//2\n");
  std::istringstream lines(content);
  int normals = 0;
  for (std::string line; std::getline(lines, line);) normals += line.starts_with("vn ");
  EXPECT_EQ(normals, 4);
}

TEST(WriteSurface, PlyAndVtpKeepTheAttributes) {
  const TemporaryFolder folder;
  for (const auto& extension : extensions()) {
    if (extension != ".ply" && extension != ".vtp") continue;
    SCOPED_TRACE(extension);
    write_surface(folder / ("t" + extension), tetrahedron(), attributes(), kMetadata);
    const auto back = read_surface(folder / ("t" + extension)).attributes;
    ASSERT_EQ(back.vertex.size(), 2u);
    ASSERT_EQ(back.face.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      expect_same(back.vertex[i], attributes().vertex[i]);
      expect_same(back.face[i], attributes().face[i]);
    }
  }
}

TEST(WriteSurface, WritesTheSameBytesTwice) {
  const TemporaryFolder folder;
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    write_surface(folder / ("a" + extension), tetrahedron(), attributes(), kMetadata);
    write_surface(folder / ("b" + extension), tetrahedron(), attributes(), kMetadata);
    EXPECT_EQ(content_of(folder / ("a" + extension)), content_of(folder / ("b" + extension)));
  }
}

TEST(WriteSurface, SaysFrameUnitAndOrigin) {
  const TemporaryFolder folder;
  for (const std::string extension : {".off", ".obj", ".ply", ".stl"}) {
    SCOPED_TRACE(extension);
    write_surface(folder / ("t" + extension), tetrahedron(), {}, kMetadata);
    const std::string content = content_of(folder / ("t" + extension));
    for (const char* part : {"SPACE=LPS", "UNIT=mm", "vmesh 1"}) expect_contains(content, part);
    if (extension == ".stl") continue;
    for (const char* part : {"--around 6", "in.swc", "abc123"}) expect_contains(content, part);
  }
}

TEST(WriteSurface, BinaryStlDoesNotLookLikeText) {
  const TemporaryFolder folder;
  write_surface(folder / "t.stl", tetrahedron(), {}, {"solid solid", {}, {}, {}});
  const std::string content = content_of(folder / "t.stl");
  EXPECT_NE(content.substr(0, 5), "solid");
  EXPECT_EQ(content.size(), 84u + 4 * 50);
}

TEST(WriteSurface, PlyHasThePropertiesThatViewersLookFor) {
  const TemporaryFolder folder;
  write_surface(folder / "t.ply", tetrahedron(), attributes(), {});
  const std::string content = content_of(folder / "t.ply");
  for (const char* part : {"format binary_little_endian 1.0", "element vertex 4", "property double x",
                           "property double nz", "property double radius", "property int segment", "element face 4",
                           "property list uchar int vertex_indices", "property double quality"}) {
    expect_contains(content, part);
  }
}

TEST(WriteSurface, RefusesWhatDoesNotFitTogether) {
  const TemporaryFolder folder;
  MeshAttributes wrong;
  wrong.vertex.push_back({"radius", {1, 2}, false});
  expect_contains(testing::message_of<InvalidInput>([&] { write_surface(folder / "t.ply", tetrahedron(), wrong); }),
                  "radius");
  TriMesh mesh = tetrahedron();
  mesh.faces[2][1] = 9;
  expect_contains(testing::message_of<InvalidInput>([&] { write_surface(folder / "t.ply", mesh); }), "face 2");
  EXPECT_THROW(write_surface(folder / "t.docx", tetrahedron()), Unsupported);
  EXPECT_THROW(write_surface(folder / "none/t.ply", tetrahedron()), WriteError);
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace vmesh
