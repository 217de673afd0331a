#include <cstring>
#include <regex>

#include <zlib.h>

#include "vmesh/core/stored_number.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/volume_faces.h"

#include "io_support.h"
#include "tube_volume.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;
using testing::tube_volume;

const VolumeMetadata kMetadata = {"vmesh 1", "--layers 2", "in.swc", "abc123"};

/// The numbers of an array of a VTK file that is packed by zlib in 64-bit headers, by the file's description.
template <class T>
std::vector<T> vtk_array(const std::string& content, const std::string& name) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(content, found, std::regex("Name=\"" + name + "\"[^>]*offset=\"([0-9]+)\""))) << name;
  if (found.empty()) return {};
  const char* at = content.data() + content.find("\n_") + 2 + std::stoul(found[1]);
  const auto word = [&](std::size_t i) { return static_cast<std::size_t>(load<std::uint64_t>(at + 8 * i)); };
  const std::size_t blocks = word(0);
  const char* packed = at + 8 * (3 + blocks);
  std::string bytes;
  for (std::size_t b = 0; b < blocks; ++b) {
    uLongf size = b + 1 < blocks || word(2) == 0 ? word(1) : word(2);
    std::string block(size, '\0');
    EXPECT_EQ(
        uncompress(reinterpret_cast<Bytef*>(block.data()), &size, reinterpret_cast<const Bytef*>(packed), word(3 + b)),
        Z_OK);
    bytes += block;
    packed += word(3 + b);
  }
  std::vector<T> values(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = load<T>(bytes.data() + i * sizeof(T));
  return values;
}

/// Texts of a field of strings: codes, each ended by a zero.
std::vector<std::string> vtk_texts(const std::string& content, const std::string& name) {
  const std::size_t begin = content.find('>', content.find("Name=\"" + name + "\"")) + 1;
  std::istringstream codes(content.substr(begin, content.find('<', begin) - begin));
  std::vector<std::string> texts(1);
  for (int code = 0; codes >> code;) {
    if (code == 0) {
      texts.emplace_back();
    } else {
      texts.back() += static_cast<char>(code);
    }
  }
  texts.pop_back();
  return texts;
}

/// A cell's volume by the divergence theorem over its faces, as VTK's documentation orders their corners: the base of a
/// wedge looks outwards.
double vtk_volume(const std::vector<double>& x, const std::vector<std::int64_t>& corners) {
  const auto at = [&](std::size_t i) {
    const auto p = static_cast<std::size_t>(3 * corners[i]);
    return Vec3(x[p], x[p + 1], x[p + 2]);
  };
  const auto cone = [&](std::size_t a, std::size_t b, std::size_t c) { return at(a).cross(at(b)).dot(at(c)) / 6; };
  if (corners.size() == 4) return cone(0, 2, 1) + cone(0, 1, 3) + cone(1, 2, 3) + cone(2, 0, 3);
  const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return (cone(a, b, c) + cone(a, c, d) + cone(a, b, d) + cone(b, c, d)) / 2;
  };
  return cone(0, 1, 2) + cone(3, 5, 4) + quad(0, 3, 4, 1) + quad(1, 4, 5, 2) + quad(2, 5, 3, 0);
}

TEST(WriteVtu, CellsHaveTheirVolumeInVtksOrder) {
  const TemporaryFolder folder;
  const testing::TubeSizes sizes = {.radius = 2, .length = 5, .around = 12, .along = 3, .rings = 2, .layers = 3};
  const VolumeMesh mesh = tube_volume(sizes);
  write_volume(folder / "t.vtu", mesh, kMetadata);
  const std::string content = content_of(folder / "t.vtu");
  const auto x = vtk_array<double>(content, "Points");
  const auto connectivity = vtk_array<std::int64_t>(content, "connectivity");
  const auto offsets = vtk_array<std::int64_t>(content, "offsets");
  const auto types = vtk_array<std::uint8_t>(content, "types");
  ASSERT_EQ(offsets.size(), mesh.cell_count() + mesh.boundary.size());
  ASSERT_EQ(types.size(), offsets.size());
  double volume = 0;
  for (std::size_t c = 0; c < offsets.size(); ++c) {
    const std::vector<std::int64_t> corners(connectivity.begin() + (c == 0 ? 0 : offsets[c - 1]),
                                            connectivity.begin() + offsets[c]);
    const bool is_tetrahedron = c < mesh.tetrahedra.size();
    if (c >= mesh.cell_count()) {
      const BoundaryFace& face = mesh.boundary[c - mesh.cell_count()];
      EXPECT_EQ(types[c], face.is_triangle() ? 5 : 9);  // VTK_TRIANGLE, VTK_QUAD
      EXPECT_TRUE(std::equal(corners.begin(), corners.end(), face.corners.begin()));
      continue;
    }
    EXPECT_EQ(types[c], is_tetrahedron ? 10 : 13);  // VTK_TETRA, VTK_WEDGE
    const double of_cell = vtk_volume(x, corners);
    EXPECT_GT(of_cell, 0) << c;
    volume += of_cell;
  }
  // A prism over a regular polygon.
  const double around = static_cast<double>(sizes.around);
  const double area = around / 2 * sizes.radius * sizes.radius * std::sin(2 * std::numbers::pi / around);
  EXPECT_NEAR(volume, area * sizes.length, 1e-12 * volume);  // rounding of some hundred cells
}

TEST(WriteVtu, RegionsPatchesNamesAndAttributesAreThere) {
  const TemporaryFolder folder;
  VolumeMesh mesh = tube_volume();
  mesh.region_names = {"lumen", "shell"};
  for (std::size_t c = mesh.tetrahedra.size(); c < mesh.cell_count(); ++c) mesh.cell_region[c] = 1;
  MeshAttribute radius{"radius", {}}, layer{"layer", {}, true};
  for (std::size_t p = 0; p < mesh.points.size(); ++p) radius.values.push_back(static_cast<double>(p) / 3);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) layer.values.push_back(static_cast<double>(c % 5));
  write_volume(folder / "t.vtu", mesh, kMetadata, {{radius}, {layer}});
  const std::string content = content_of(folder / "t.vtu");
  const auto region = vtk_array<std::int32_t>(content, "ModelRegionID");
  const auto patch = vtk_array<std::int32_t>(content, "ModelFaceID");
  const auto layers = vtk_array<std::int32_t>(content, "layer");
  const std::size_t cells = mesh.cell_count();
  ASSERT_EQ(region.size(), cells + mesh.boundary.size());
  const std::vector<CellSide> behind = sides_of_boundary(mesh);
  for (std::size_t c = 0; c < region.size(); ++c) {
    const std::size_t cell = c < cells ? c : behind[c - cells].cell;
    EXPECT_EQ(region[c], cell < mesh.tetrahedra.size() ? 1 : 2);
    EXPECT_EQ(patch[c], c < cells ? 0 : static_cast<int>(mesh.boundary[c - cells].patch) + 1);
    EXPECT_EQ(layers[c], static_cast<int>(cell % 5));
  }
  EXPECT_EQ(vtk_array<double>(content, "MaximumInscribedSphereRadius"), radius.values);
  EXPECT_EQ(vtk_texts(content, "RegionNames"), mesh.region_names);
  EXPECT_EQ(vtk_texts(content, "PatchNames"), mesh.patch_names);
  EXPECT_EQ(vtk_texts(content, "SPACE"), std::vector<std::string>{"LPS"});
  EXPECT_EQ(vtk_texts(content, "UNIT"), std::vector<std::string>{"mm"});
  EXPECT_EQ(vtk_texts(content, "Options"), std::vector<std::string>{"--layers 2"});
}

TEST(WriteVolume, PointsAndLengthsAreInTheUnitAndFrameAskedFor) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = tube_volume();
  const MeshAttribute radius{"radius", std::vector<double>(mesh.points.size(), 3.0)};
  const MeshAttribute parameter{"parameter", std::vector<double>(mesh.points.size(), 3.0)};
  VolumeMetadata metadata = kMetadata;
  metadata.unit = LengthUnit::cm;
  metadata.space = Space::ras;
  write_volume(folder / "t.vtu", mesh, metadata, {{radius, parameter}, {}});
  const std::string content = content_of(folder / "t.vtu");
  const auto x = vtk_array<double>(content, "Points");
  const Vec3 p = mesh.points[5];
  EXPECT_DOUBLE_EQ(x[15], -p.x() / 10);
  EXPECT_DOUBLE_EQ(x[16], -p.y() / 10);
  EXPECT_DOUBLE_EQ(x[17], p.z() / 10);
  EXPECT_DOUBLE_EQ(vtk_array<double>(content, "MaximumInscribedSphereRadius")[0], 0.3);
  EXPECT_EQ(vtk_array<double>(content, "parameter")[0], 3);
  EXPECT_EQ(vtk_texts(content, "UNIT"), std::vector<std::string>{"cm"});
  EXPECT_EQ(vtk_texts(content, "SPACE"), std::vector<std::string>{"RAS"});
}

TEST(WriteVolume, RefusesWhatDoesNotFitTogetherAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  VolumeMesh mesh = tube_volume();
  expect_contains(message_of<Unsupported>([&] { write_volume(folder / "t.docx", mesh); }), ".vtu");
  expect_contains(message_of<InvalidInput>([&] {
                    write_volume(folder / "t.vtu", mesh, {}, {{}, {{"layer", {1, 2}, true}}});
                  }),
                  "t.vtu: the cell attribute layer has 2 values");
  mesh.boundary[0].patch = 9;
  expect_contains(message_of<InvalidInput>([&] { write_volume(folder / "t.vtu", mesh); }),
                  "t.vtu: face 0 of the volume's boundary is of patch 9");
  mesh = tube_volume();
  mesh.boundary.push_back(mesh.boundary[0]);
  expect_contains(message_of<InvalidInput>([&] { write_volume(folder / "t.vtu", mesh); }), "is there twice");
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(WriteVolume, WritesTheSameBytesTwice) {
  const TemporaryFolder folder;
  namespace fs = std::filesystem;
  const VolumeWriteOptions split = {.split_cells = true};
  for (const VolumeFormat& format : volume_formats()) {
    SCOPED_TRACE(format.name);
    const std::string ending = format.is_folder() ? format.folder : "t" + format.extensions[0];
    fs::create_directory(folder / "a");
    fs::create_directory(folder / "b");
    write_volume(folder / ("a/" + ending), tube_volume(), kMetadata, {}, split);
    write_volume(folder / ("b/" + ending), tube_volume(), kMetadata, {}, split);
    std::size_t files = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder / "a")) {
      if (entry.is_directory()) continue;
      const fs::path name = entry.path().lexically_relative(folder / "a");
      EXPECT_EQ(content_of(entry.path()), content_of(folder / "b" / name)) << name;
      ++files;
    }
    EXPECT_GE(files, std::max<std::size_t>(1, format.extensions.size()));
    fs::remove_all(folder / "a");
    fs::remove_all(folder / "b");
  }
}

}  // namespace
}  // namespace vmesh
