#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <nlohmann/json.hpp>
#if VMESH_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include "vmesh/io/surface_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using nlohmann::json;
using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;

constexpr SurfaceWriteOptions kCompressed = {SurfaceEncoding::compressed};

/// A bent tube, far from the origin.
TriMesh tube() {
  constexpr Index kRings = 60, kAround = 9;
  TriMesh mesh;
  for (Index i = 0; i < kRings; ++i) {
    for (Index j = 0; j < kAround; ++j) {
      const double turn = 2 * std::numbers::pi * j / kAround, along = 0.05 * i;
      const double r = 20 + (2 + 0.3 * std::sin(5 * along)) * std::cos(turn);
      mesh.vertices.emplace_back(100 + r * std::cos(along), -300 + r * std::sin(along), 2 * std::sin(turn));
    }
  }
  for (Index i = 0; i + 1 < kRings; ++i) {
    for (Index j = 0; j < kAround; ++j) {
      const Index a = i * kAround + j, b = i * kAround + (j + 1) % kAround;
      mesh.faces.push_back({a, b, b + kAround});
      mesh.faces.push_back({a, b + kAround, a + kAround});
    }
  }
  return mesh;
}

MeshAttributes attributes(const TriMesh& mesh) {
  MeshAttributes attributes = {
      {{"radius", {}}, {"segment", {}, true}, {"red", {}, true}, {"green", {}, true}, {"blue", {}, true}}, {}};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double value = static_cast<double>(v);
    attributes.vertex[0].values.push_back(0.001 + std::abs(std::sin(value)));
    attributes.vertex[1].values.push_back(1e6 + static_cast<double>(v / 50));
    for (std::size_t c = 2; c < 5; ++c) attributes.vertex[c].values.push_back(std::fmod(value, 251));
  }
  return attributes;
}

#if VMESH_HAS_MESHOPTIMIZER

/// A GLB file whose views are unpacked.
struct Glb {
  explicit Glb(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    header = json::parse(bytes.substr(20, length));
    binary = bytes.substr(28 + length);
    size = bytes.size();
  }

  std::string content(const json& accessor) const {
    const json& view = header.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const std::size_t length = view.at("byteLength");
    if (!view.contains("extensions")) return binary.substr(view.at("byteOffset"), length);
    const json& packed = view.at("extensions").at("EXT_meshopt_compression");
    const std::size_t count = packed.at("count"), stride = packed.at("byteStride");
    EXPECT_EQ(count * stride, length);
    EXPECT_EQ(header.at("buffers").at(packed.at("buffer").get<std::size_t>()).contains("extensions"), false);
    const std::string from = binary.substr(packed.at("byteOffset"), packed.at("byteLength"));
    const auto* data = reinterpret_cast<const unsigned char*>(from.data());
    std::string to(length, '\0');
    if (packed.at("mode") == "TRIANGLES") {
      EXPECT_EQ(data[0], 0xe1);  // of the version in the specification
      EXPECT_EQ(meshopt_decodeIndexBuffer(to.data(), count, stride, data, from.size()), 0);
    } else {
      EXPECT_EQ(data[0], 0xa0);
      EXPECT_EQ(meshopt_decodeVertexBuffer(to.data(), count, stride, data, from.size()), 0);
    }
    if (packed.contains("filter")) {
      EXPECT_EQ(packed.at("filter"), "EXPONENTIAL");
      meshopt_decodeFilterExp(to.data(), count, stride);
    }
    return to;
  }

  const json& accessor(const json& number) const { return header.at("accessors").at(number.get<std::size_t>()); }
  const json& primitive() const { return header.at("meshes").at(0).at("primitives").at(0); }

  template <class Number>
  std::vector<Number> numbers(const json& number) const {
    const std::string bytes = content(accessor(number));
    std::vector<Number> result(bytes.size() / sizeof(Number));
    std::memcpy(result.data(), bytes.data(), bytes.size());
    return result;
  }
  std::vector<float> floats(const std::string& attribute) const {
    return numbers<float>(primitive().at("attributes").at(attribute));
  }
  /// With the least corner first, in ascending order.
  std::vector<std::array<unsigned, 3>> triangles() const { return triangles(primitive()); }
  std::vector<std::array<unsigned, 3>> triangles(const json& of_primitive) const {
    const auto corners = numbers<unsigned>(of_primitive.at("indices"));
    std::vector<std::array<unsigned, 3>> result;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      result.push_back({corners[i], corners[i + 1], corners[i + 2]});
      std::rotate(result.back().begin(), std::min_element(result.back().begin(), result.back().end()),
                  result.back().end());
    }
    std::sort(result.begin(), result.end());
    return result;
  }

  json header;
  std::string binary;
  std::size_t size = 0;
};

Glb written(const TemporaryFolder& folder, const TriMesh& mesh, const SurfaceWriteOptions& options) {
  write_surface(folder / "t.glb", mesh, attributes(mesh), {}, options);
  return Glb(content_of(folder / "t.glb"));
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(double{a[i]} - double{b[i]}));
  return largest;
}

TEST(CompressedGlb, HoldsTheSurfaceToTheRoundingThatIsTold) {
  const TemporaryFolder folder;
  const TriMesh mesh = tube();
  const Glb plain = written(folder, mesh, {}), packed = written(folder, mesh, kCompressed);
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    EXPECT_EQ(packed.header.at(list), json({"EXT_meshopt_compression"}));
  EXPECT_TRUE(packed.header.at("buffers").at(1).at("extensions").at("EXT_meshopt_compression").at("fallback"));
  EXPECT_EQ(packed.triangles(), plain.triangles());
  const double farthest = 0.022;  // m, from the middle
  EXPECT_LT(largest_difference(packed.floats("POSITION"), plain.floats("POSITION")), 2e-6 * farthest);
  EXPECT_LT(largest_difference(packed.floats("NORMAL"), plain.floats("NORMAL")), 1. / 4000);
  EXPECT_EQ(packed.floats("_SEGMENT"), plain.floats("_SEGMENT"));
  EXPECT_EQ(packed.content(packed.accessor(packed.primitive().at("attributes").at("COLOR_0"))),
            plain.content(plain.accessor(plain.primitive().at("attributes").at("COLOR_0"))));
  const std::vector<float> radius = packed.floats("_RADIUS"), exact = plain.floats("_RADIUS");
  for (std::size_t v = 0; v < exact.size(); ++v) EXPECT_NEAR(radius[v], exact[v], 3.1e-5 * exact[v]);
}

TEST(CompressedGlb, SaysTheRangeOfWhatIsUnpacked) {
  const TemporaryFolder folder;
  const Glb packed = written(folder, tube(), kCompressed);
  const std::vector<float> positions = packed.floats("POSITION");
  const json& accessor = packed.accessor(packed.primitive().at("attributes").at("POSITION"));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = positions[axis], high = low;
    for (std::size_t i = axis; i < positions.size(); i += 3) {
      low = std::min(low, positions[i]);
      high = std::max(high, positions[i]);
    }
    EXPECT_EQ(accessor.at("min").at(axis).get<float>(), low);
    EXPECT_EQ(accessor.at("max").at(axis).get<float>(), high);
  }
}

TEST(CompressedGlb, IsLessThanHalfAsLargeAndTheSameTwice) {
  const TemporaryFolder folder;
  const TriMesh mesh = tube();
  write_surface(folder / "plain.glb", mesh);
  write_surface(folder / "a.glb", mesh, {}, {}, kCompressed);
  write_surface(folder / "b.glb", mesh, {}, {}, kCompressed);
  EXPECT_LT(2 * content_of(folder / "a.glb").size(), content_of(folder / "plain.glb").size());
  EXPECT_EQ(content_of(folder / "a.glb"), content_of(folder / "b.glb"));
}

TEST(CompressedGlb, KeepsPatches) {
  const TemporaryFolder folder;
  const TriMesh mesh = tube();
  MeshAttributes patches;
  patches.face.push_back({"ModelFaceID", std::vector<double>(mesh.faces.size(), 1), true});
  for (std::size_t f = 0; f < mesh.faces.size(); f += 3) patches.face[0].values[f] = 2;
  patches.patch_names = {"wall", "inlet"};
  write_surface(folder / "plain.glb", mesh, patches);
  write_surface(folder / "packed.glb", mesh, patches, {}, kCompressed);
  const Glb plain(content_of(folder / "plain.glb")), packed(content_of(folder / "packed.glb"));
  EXPECT_EQ(packed.header.at("materials"), plain.header.at("materials"));
  const json &some = plain.header.at("meshes").at(0).at("primitives"),
             &same = packed.header.at("meshes").at(0).at("primitives");
  ASSERT_EQ(some.size(), 2u);
  ASSERT_EQ(same.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p) EXPECT_EQ(packed.triangles(same[p]), plain.triangles(some[p]));
  EXPECT_EQ(plain.triangles(some[1]).size(), (mesh.faces.size() + 2) / 3);
}

TEST(CompressedGlb, KeepsBonesExactly) {
  const TemporaryFolder folder;
  const TriMesh mesh = tube();
  SurfaceSkin skin;
  skin.joints = {{"a", {100, -300, 0}}, {"b", {110, -290, 1}}};
  skin.joint_of_vertex.assign(mesh.vertices.size(), {0, 1, 0, 0});
  skin.weight.assign(mesh.vertices.size(), {0.3F, 0.7F, 0, 0});
  const Glb plain = written(folder, mesh, {.skin = &skin});
  const Glb packed = written(folder, mesh, {SurfaceEncoding::compressed, &skin});
  for (const char* name : {"JOINTS_0", "WEIGHTS_0"})
    EXPECT_EQ(packed.content(packed.accessor(packed.primitive().at("attributes").at(name))),
              plain.content(plain.accessor(plain.primitive().at("attributes").at(name))));
  const auto matrices = [](const Glb& glb) {
    return glb.content(glb.accessor(glb.header.at("skins").at(0).at("inverseBindMatrices")));
  };
  EXPECT_EQ(matrices(packed), matrices(plain));
}

#if VMESH_WITH_ASSIMP
TEST(CompressedGlb, IsRefusedByTheReaderWithItsReason) {
  const TemporaryFolder folder;
  write_surface(folder / "t.glb", tube(), {}, {}, kCompressed);
  expect_contains(message_of<Unsupported>([&] { read_surface(folder / "t.glb"); }),
                  "t.glb: it is compressed by EXT_meshopt_compression, which is not read");
}
#endif

#else

TEST(CompressedGlb, NeedsMeshoptimizer) {
  const TemporaryFolder folder;
  expect_contains(
      message_of<Unsupported>([&] { write_surface(folder / "t.glb", tube(), attributes(tube()), {}, kCompressed); }),
      "t.glb: to compress it needs meshoptimizer");
  EXPECT_EQ(folder.file_count(), 0u);
}

#endif

TEST(CompressedGlb, IsTheOnlyFormatWithCompression) {
  const TemporaryFolder folder;
  for (const char* name : {"t.ply", "t.stl", "t.obj", "t.off", "t.vtp"})
    expect_contains(message_of<Unsupported>([&] { write_surface(folder / name, tube(), {}, {}, kCompressed); }),
                    " has no compressed form; compressed are .glb");
  EXPECT_EQ(folder.file_count(), 0u);
}

/// Programs ignore the place of a node whose mesh has bones.
TEST(Glb, ASurfaceWithBonesLiesWhereItsVerticesAre) {
  const TemporaryFolder folder;
  const TriMesh mesh = tube();
  SurfaceSkin skin;
  skin.joints = {{"a", {100, -300, 0}}};
  skin.joint_of_vertex.assign(mesh.vertices.size(), {0, 0, 0, 0});
  skin.weight.assign(mesh.vertices.size(), {1, 0, 0, 0});
  write_surface(folder / "t.glb", mesh, {}, {}, {.skin = &skin});
  const std::string bytes = content_of(folder / "t.glb");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const json header = json::parse(bytes.substr(20, length));
  EXPECT_FALSE(header.at("nodes").at(0).contains("translation"));
  EXPECT_FALSE(header.at("nodes").at(1).contains("translation"));
  std::array<float, 3> first = {};
  std::memcpy(first.data(), bytes.data() + 28 + length, sizeof first);
  EXPECT_NEAR(first[0], mesh.vertices[0].x() / 1000, 1e-7);
  EXPECT_NEAR(first[1], mesh.vertices[0].z() / 1000, 1e-7);
  EXPECT_NEAR(first[2], -mesh.vertices[0].y() / 1000, 1e-7);
}

}  // namespace
}  // namespace vmesh
