// Names of the patches of surfaces, in the files that have room for them.
#include <nlohmann/json.hpp>

#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;
using testing::tetrahedron;

/// No face has the second name.
MeshAttributes named() {
  MeshAttributes attributes;
  attributes.face.push_back({"ModelFaceID", {3, 1, 1, 4}, true});
  attributes.face.push_back({"CapID", {2, -1, -1, 3}, true});
  attributes.patch_names = {"wall", "cap_1", "inlet", "outlet.left-2"};
  return attributes;
}

std::vector<double> labels_of(const LoadedSurface& surface) {
  const MeshAttribute* labels = find_attribute(surface.attributes.face, "ModelFaceID");
  return labels ? labels->values : std::vector<double>();
}

TEST(PatchNames, VtpAndPlyBringThemBack) {
  const TemporaryFolder folder;
  for (const auto& [name, encoding] : {std::pair("t.vtp", SurfaceEncoding::usual),
                                       {"t.ply", SurfaceEncoding::usual},
                                       {"text.ply", SurfaceEncoding::text}}) {
    SCOPED_TRACE(name);
    write_surface(folder / name, tetrahedron(), named(), {}, {encoding});
    const LoadedSurface back = read_surface(folder / name);
    EXPECT_EQ(back.attributes.patch_names, named().patch_names);
    EXPECT_EQ(labels_of(back), named().face[0].values);
    EXPECT_TRUE(back.warnings.empty());
  }
  expect_contains(content_of(folder / "t.ply"), "comment patch 3 inlet\n");
}

TEST(PatchNames, GroupsAndSolidsAreNumberedInTheirOrder) {
  const TemporaryFolder folder;
  write_surface(folder / "t.obj", tetrahedron(), named());
  write_surface(folder / "t.stl", tetrahedron(), named(), {}, {SurfaceEncoding::text});
  write_surface(folder / "t.glb", tetrahedron(), named());
  for (const char* name : {"t.obj", "t.stl", "t.glb"}) {
    SCOPED_TRACE(name);
    const LoadedSurface back = read_surface(folder / name);
    EXPECT_EQ(back.attributes.patch_names, (std::vector<std::string>{"wall", "inlet", "outlet.left-2"}));
    EXPECT_EQ(labels_of(back), (std::vector<double>{1, 1, 2, 3}));  // faces come group by group
    EXPECT_TRUE(back.warnings.empty());
    // Once more, from what was read.
    write_surface(folder / "again.vtp", back.mesh, back.attributes);
    EXPECT_EQ(read_surface(folder / "again.vtp").attributes.patch_names, back.attributes.patch_names);
  }
  expect_contains(content_of(folder / "t.obj"), "\ng outlet.left-2\n");
  expect_contains(content_of(folder / "t.stl"), "solid inlet\n");
}

/// The JSON of a GLB file.
nlohmann::json header_of(const std::string& glb) {
  const auto size = static_cast<unsigned char>(glb[12]) + 256 * static_cast<unsigned char>(glb[13]);
  return nlohmann::json::parse(glb.substr(20, static_cast<std::size_t>(size)));
}

TEST(PatchNames, GlbHasAPrimitiveAndAMaterialForEach) {
  const TemporaryFolder folder;
  write_surface(folder / "t.glb", tetrahedron(), named());
  const nlohmann::json glb = header_of(content_of(folder / "t.glb"));
  const nlohmann::json& primitives = glb.at("meshes").at(0).at("primitives");
  ASSERT_EQ(glb.at("meshes").size(), 1u);
  ASSERT_EQ(primitives.size(), 3u);
  ASSERT_EQ(glb.at("materials").size(), 3u);
  const std::vector<std::pair<std::string, int>> expected = {{"wall", 2}, {"inlet", 1}, {"outlet.left-2", 1}};
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(primitives[p].at("material"), p);
    EXPECT_EQ(primitives[p].at("extras").at("name"), expected[p].first);
    EXPECT_EQ(glb.at("materials").at(p).at("name"), expected[p].first);
    EXPECT_EQ(primitives[p].at("attributes"), primitives[0].at("attributes"));
    EXPECT_EQ(glb.at("accessors").at(primitives[p].at("indices").get<std::size_t>()).at("count"),
              3 * expected[p].second);
  }
  // Vertices are there once.
  const auto positions = primitives[0].at("attributes").at("POSITION").get<std::size_t>();
  EXPECT_EQ(glb.at("accessors").at(positions).at("count"), 4);
  EXPECT_EQ(read_surface(folder / "t.glb").mesh.vertices.size(), 4u);
}

TEST(PatchNames, GlbWithoutPatchesHasOnePrimitive) {
  const TemporaryFolder folder;
  write_surface(folder / "t.glb", tetrahedron());
  const nlohmann::json glb = header_of(content_of(folder / "t.glb"));
  ASSERT_EQ(glb.at("meshes").at(0).at("primitives").size(), 1u);
  EXPECT_FALSE(glb.at("meshes").at(0).at("primitives").at(0).contains("extras"));
  EXPECT_EQ(glb.at("materials").at(0).at("name"), "vessel");
  EXPECT_TRUE(read_surface(folder / "t.glb").attributes.patch_names.empty());
}

TEST(PatchNames, OneGroupIsNoPatch) {
  const TemporaryFolder folder;
  write_surface(folder / "t.obj", tetrahedron());
  const LoadedSurface back = read_surface(folder / "t.obj");
  EXPECT_TRUE(back.attributes.patch_names.empty());
  EXPECT_TRUE(labels_of(back).empty());
}

TEST(PatchNames, TetGenHasThemBesideItsMarkers) {
  const TemporaryFolder folder;
  write_surface(folder / "t.smesh", tetrahedron(), named());
  const std::string content = content_of(folder / "t.smesh");
  expect_contains(content, "3 0 2 1 2\n");
  expect_contains(content, "# patch 2: inlet\n");
}

TEST(PatchNames, OfOtherProgramsAreLeftOutWhereTheyAreNoNames) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng 12\nf 1 3 2\ng b\nf 1 2 4\nf 1 4 3\ng\nf 2 3 4\n");
  const LoadedSurface back = read_surface(path);
  EXPECT_TRUE(back.attributes.patch_names.empty());
  EXPECT_EQ(labels_of(back), (std::vector<double>{1, 2, 2, 3}));
  expect_contains(back.warnings.at(0), "t.obj: the names of patches are left out: \"12\"");
}

TEST(PatchNames, ThatAreWrongAreRefused) {
  const TemporaryFolder folder;
  const auto error_of = [&](const auto& damage) {
    MeshAttributes attributes = named();
    damage(attributes);
    return message_of<InvalidInput>([&] { write_surface(folder / "t.vtp", tetrahedron(), attributes); });
  };
  expect_contains(error_of([](MeshAttributes& a) { a.patch_names[1] = "Inlet"; }), "t.vtp: two patches have the name");
  expect_contains(error_of([](MeshAttributes& a) { a.patch_names[1] = ""; }), "\"\" cannot be the name of a patch");
  expect_contains(error_of([](MeshAttributes& a) { a.patch_names.pop_back(); }),
                  "face 3: there is no name for ModelFaceID 4; there are 3 names");
  EXPECT_EQ(folder.file_count(), 0u);
}

}  // namespace
}  // namespace vmesh
