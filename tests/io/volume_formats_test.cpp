// Volume meshes in the formats of other programs, read again by their descriptions.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/split_cells.h"
#include "vmesh/mesh/volume_faces.h"

#include "io_support.h"
#include "mixed_cells.h"
#include "tube_volume.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;
using testing::tube_volume;

const VolumeMetadata kMetadata = {"vmesh 1", "--layers 2", "in.swc", "abc123"};

/// Wedges are a region of their own.
VolumeMesh two_regions() {
  VolumeMesh mesh = tube_volume();
  mesh.region_names = {"core", "layers"};
  for (std::size_t c = mesh.tetrahedra.size(); c < mesh.cell_count(); ++c) mesh.cell_region[c] = 1;
  return mesh;
}

std::string all_of(const VolumeMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : mesh.points) text << p.transpose() << '\n';
  for (const Tetrahedron& t : mesh.tetrahedra) text << t[0] << ' ' << t[1] << ' ' << t[2] << ' ' << t[3] << '\n';
  for (const Wedge& w : mesh.wedges)
    for (const Index v : w) text << v << ' ';
  for (const Pyramid& p : mesh.pyramids)
    for (const Index v : p) text << v << ' ';
  for (const Index r : mesh.cell_region) text << r << ' ';
  for (const BoundaryFace& f : mesh.boundary) {
    for (const Index v : f.corners) text << v << ' ';
    text << f.patch << '\n';
  }
  for (const std::string& name : mesh.region_names) text << name << '\n';
  for (const std::string& name : mesh.patch_names) text << name << '\n';
  return text.str();
}

TEST(ReadVtu, BringsEverythingBackToTheBit) {
  const TemporaryFolder folder;
  VolumeMesh mesh = two_regions();
  for (Vec3& p : mesh.points) p += Vec3(1.0 / 3, 1e-9, 1e5);
  MeshAttribute radius{"radius", {}}, layer{"layer", {}, true};
  for (std::size_t p = 0; p < mesh.points.size(); ++p) radius.values.push_back(static_cast<double>(p) / 3);
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) layer.values.push_back(static_cast<double>(c % 7));
  write_volume(folder / "t.vtu", mesh, kMetadata, {{radius}, {layer}});
  const LoadedVolume back = read_volume(folder / "t.vtu");
  EXPECT_EQ(all_of(back.mesh), all_of(mesh));
  EXPECT_EQ(back.unit, LengthUnit::mm);
  EXPECT_EQ(back.space, Space::lps);
  EXPECT_TRUE(back.warnings.empty());
  ASSERT_EQ(back.attributes.point.size(), 1u);
  EXPECT_EQ(back.attributes.point[0].name, "radius");
  EXPECT_EQ(back.attributes.point[0].values, radius.values);
  ASSERT_EQ(back.attributes.cell.size(), 1u);
  EXPECT_EQ(back.attributes.cell[0].name, "layer");
  EXPECT_EQ(back.attributes.cell[0].values, layer.values);
  EXPECT_TRUE(back.attributes.cell[0].integer);
}

/// A grid in text.
std::string grid(const std::string& points, const std::string& ids, const std::string& offsets,
                 const std::string& types, const std::string& more = {}) {
  const auto count = [](const std::string& text) {
    std::istringstream words(text);
    return std::distance(std::istream_iterator<std::string>(words), {});
  };
  const auto array = [](const std::string& name, const std::string& values) {
    return "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\">" + values + "</DataArray>";
  };
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
         std::to_string(count(points) / 3) + "\" NumberOfCells=\"" + std::to_string(count(offsets)) +
         "\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">" + points +
         "</DataArray></Points><Cells>" + array("connectivity", ids) + array("offsets", offsets) +
         array("types", types) + "</Cells>" + more + "</Piece></UnstructuredGrid></VTKFile>";
}

LoadedVolume parse(const std::string& text) { return parse_volume(text, *find_volume_format("t.vtu"), "t.vtu"); }

const std::string kPrism = "0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1";

TEST(ReadVtu, BringsEveryKindOfCellBack) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = testing::mixed_cells();
  write_volume(folder / "t.vtu", mesh);
  const LoadedVolume back = read_volume(folder / "t.vtu");
  EXPECT_EQ(all_of(back.mesh), all_of(mesh));
  EXPECT_TRUE(back.warnings.empty());
}

TEST(ReadVtu, CellsOfOtherProgramsAreTurnedAndGetTheirOutside) {
  const LoadedVolume documented = parse(grid(kPrism, "0 2 1 3 5 4", "6", "13"));
  EXPECT_EQ(documented.mesh.wedges, (std::vector<Wedge>{{0, 1, 2, 3, 4, 5}}));
  EXPECT_TRUE(documented.warnings.empty());
  const LoadedVolume other = parse(grid(kPrism, "0 1 2 3 4 5", "6", "13"));
  EXPECT_EQ(other.mesh.wedges, documented.mesh.wedges);
  ASSERT_EQ(other.warnings.size(), 1u);
  expect_contains(other.warnings[0], "t.vtu: 1 cells had corners in an order that gives a negative volume; turned");
  EXPECT_EQ(other.mesh.boundary.size(), 5u);
  EXPECT_EQ(other.mesh.patch_names, std::vector<std::string>{"wall"});
  EXPECT_EQ(other.mesh.region_names, std::vector<std::string>{"region_1"});
  const LoadedVolume lines = parse(grid(kPrism, "1 0 2 3 0 1", "4 6", "10 3"));
  EXPECT_EQ(lines.mesh.tetrahedra.size(), 1u);
  expect_contains(lines.warnings.at(0), "1 lines and loose points are left out");
}

TEST(ReadVtu, LabelsWithoutNamesAreNamedByTheirNumbers) {
  const std::string labels =
      "<CellData><DataArray type=\"Int32\" Name=\"ModelRegionID\" format=\"ascii\">7 0 0 0 0 </DataArray>"
      "<DataArray type=\"Int32\" Name=\"ModelFaceID\" format=\"ascii\">0 2 9 2 2</DataArray></CellData>";
  const LoadedVolume loaded =
      parse(grid(kPrism, "0 1 2 3 0 2 1 0 1 3 1 2 3 2 0 3", "4 7 10 13 16", "10 5 5 5 5", labels));
  EXPECT_EQ(loaded.mesh.region_names, std::vector<std::string>{"region_7"});
  EXPECT_EQ(loaded.mesh.patch_names, (std::vector<std::string>{"patch_2", "patch_9"}));
  std::vector<Index> patches;
  for (const BoundaryFace& face : loaded.mesh.boundary) patches.push_back(face.patch);
  EXPECT_EQ(patches, (std::vector<Index>{0, 1, 0, 0}));
}

TEST(ReadVtu, DamageIsNamed) {
  const auto error = [](const std::string& text) {
    const std::string message = message_of<InvalidInput>([&] { parse(text); });
    expect_contains(message, "t.vtu: ");
    return message;
  };
  expect_contains(error(grid(kPrism, "0 1 2 9", "4", "10")), "cell 0: there is no such point; the points are 0 to 5");
  expect_contains(error(grid(kPrism, "0 1 2", "3", "10")), "cell 0 has 3 corners, there should be 4");
  expect_contains(error(grid(kPrism, "0 1 2 3", "5", "10")), "cell 0: its offset is out of range");
  expect_contains(error(grid(kPrism, "0 1 2 3 4 5 0 1", "8", "12")), "cell 0 is of VTK's type 12");
  expect_contains(error(grid(kPrism, "0 1 2", "3", "5")), "there are no tetrahedra, wedges or pyramids");
  expect_contains(error(grid("nan 0 0 1 0 0 0 1 0 0 0 1", "0 1 2 3", "4", "10")), "point 0 is not finite");
  expect_contains(error(grid(kPrism, "0 1 2 3 0 1 2", "4 7", "10 5")),
                  "face 0 of the volume's boundary is turned inwards");
  expect_contains(error("<VTKFile type=\"PolyData\"/>"), "this is not a VTU file");
}

/// The lines between `begin` and `end`.
std::vector<std::string> section(const std::string& content, const std::string& begin, const std::string& end) {
  std::vector<std::string> result;
  const std::size_t from = content.find(begin + "\n"), to = content.find(end, from);
  if (from == std::string::npos || to == std::string::npos) {
    ADD_FAILURE() << "no " << begin;
    return result;
  }
  std::istringstream lines(content.substr(from + begin.size() + 1, to - from - begin.size() - 1));
  for (std::string line; std::getline(lines, line);) result.push_back(line);
  return result;
}

std::vector<double> numbers(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  return {std::istream_iterator<double>(words), {}};
}

std::string gmsh_group(const VolumeMesh& mesh, std::size_t element) {
  if (element < mesh.boundary.size()) return std::to_string(mesh.boundary[element].patch + 1);
  return std::to_string(mesh.patch_names.size() + mesh.cell_region[element - mesh.boundary.size()] + 1);
}

/// The corners of a face or, after all faces, of a cell, from 1.
std::vector<double> corners_from_one(const VolumeMesh& mesh, std::size_t element) {
  std::vector<double> result;
  const auto add = [&](const auto& corners) {
    for (const Index v : corners)
      if (v != kNone) result.push_back(v + 1.0);
  };
  if (element < mesh.boundary.size()) {
    add(mesh.boundary[element].corners);
  } else if (element - mesh.boundary.size() < mesh.tetrahedra.size()) {
    add(mesh.tetrahedra[element - mesh.boundary.size()]);
  } else {
    add(mesh.wedges[element - mesh.boundary.size() - mesh.tetrahedra.size()]);
  }
  return result;
}

TEST(WriteGmsh, Version2HasNodesElementsAndPhysicalNames) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = two_regions();
  write_volume(folder / "t.msh", mesh, kMetadata);
  const std::string content = content_of(folder / "t.msh");
  EXPECT_EQ(section(content, "$MeshFormat", "$End"), std::vector<std::string>{"2.2 0 8"});
  EXPECT_EQ(section(content, "$PhysicalNames", "$End"),
            (std::vector<std::string>{"5", "2 1 \"wall\"", "2 2 \"inlet\"", "2 3 \"outlet\"", "3 4 \"core\"",
                                      "3 5 \"layers\""}));
  expect_contains(content, "SPACE=LPS");
  const auto nodes = section(content, "$Nodes", "$End");
  ASSERT_EQ(nodes.size(), mesh.points.size() + 1);
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const Vec3& x = mesh.points[p];
    EXPECT_EQ(numbers(nodes[p + 1]), (std::vector<double>{static_cast<double>(p + 1), x[0], x[1], x[2]}));
  }
  const auto elements = section(content, "$Elements", "$End");
  ASSERT_EQ(elements.size(), mesh.boundary.size() + mesh.cell_count() + 1);
  const std::map<std::size_t, double> types = {{3, 2}, {6, 6}};
  for (std::size_t e = 0; e + 1 < elements.size(); ++e) {
    const std::vector<double> corners = corners_from_one(mesh, e);
    const double type = corners.size() == 4 ? (e < mesh.boundary.size() ? 3 : 4) : types.at(corners.size());
    const double group = std::stod(gmsh_group(mesh, e));
    std::vector<double> expected = {static_cast<double>(e + 1), type, 2, group, group};
    expected.insert(expected.end(), corners.begin(), corners.end());
    EXPECT_EQ(numbers(elements[e + 1]), expected);
  }
}

TEST(WriteGmsh, EveryKindOfCellHasItsType) {
  const TemporaryFolder folder;
  write_volume(folder / "t.msh", testing::mixed_cells());
  const auto elements = section(content_of(folder / "t.msh"), "$Elements", "$End");
  EXPECT_EQ(elements.at(elements.size() - 3), "11 4 2 3 3 2 7 5 8");
  EXPECT_EQ(elements.at(elements.size() - 2), "12 6 2 4 4 1 2 3 4 5 6");
  EXPECT_EQ(elements.at(elements.size() - 1), "13 7 2 3 3 2 3 6 5 7");
}

TEST(WriteGmsh, Version4HasTheSameByEntities) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = two_regions();
  write_volume(folder / "t.msh4", mesh, kMetadata);
  const std::string content = content_of(folder / "t.msh4");
  EXPECT_EQ(section(content, "$MeshFormat", "$End"), std::vector<std::string>{"4.1 0 8"});
  const auto entities = section(content, "$Entities", "$End");
  ASSERT_EQ(entities.size(), 6u);
  EXPECT_EQ(entities[0], "0 0 3 2");
  EXPECT_EQ(numbers(entities[2]).at(0), 2);
  EXPECT_EQ(numbers(entities[2]).at(6), 0);  // the inlet is at z = 0
  EXPECT_EQ(numbers(entities[2]).at(8), 2);  // its physical group
  const auto nodes = section(content, "$Nodes", "$End");
  const std::vector<double> head = numbers(nodes.at(0));
  const auto count = static_cast<double>(mesh.points.size());
  EXPECT_EQ(head, (std::vector<double>{5, count, 1, count}));
  std::set<double> seen;
  for (std::size_t i = 1; i < nodes.size();) {
    const auto in_block = static_cast<std::size_t>(numbers(nodes[i]).at(3));
    for (std::size_t k = 1; k <= in_block; ++k) {
      const double tag = numbers(nodes[i + k]).at(0);
      EXPECT_TRUE(seen.insert(tag).second);
      const Vec3& x = mesh.points[static_cast<std::size_t>(tag) - 1];
      EXPECT_EQ(numbers(nodes[i + in_block + k]), (std::vector<double>{x[0], x[1], x[2]}));
    }
    i += 1 + 2 * in_block;
  }
  EXPECT_EQ(seen.size(), mesh.points.size());
  std::multiset<std::vector<double>> expected, found;  // group and corners
  for (std::size_t e = 0; e < mesh.boundary.size() + mesh.cell_count(); ++e) {
    std::vector<double> one = corners_from_one(mesh, e);
    one.insert(one.begin(), std::stod(gmsh_group(mesh, e)));
    expected.insert(one);
  }
  const auto elements = section(content, "$Elements", "$End");
  for (std::size_t i = 1; i < elements.size();) {
    const std::vector<double> block = numbers(elements[i]);
    const auto in_block = static_cast<std::size_t>(block.at(3));
    for (std::size_t k = 1; k <= in_block; ++k) {
      std::vector<double> one = numbers(elements[i + k]);
      one[0] = block[1];  // in place of its number
      found.insert(one);
    }
    i += 1 + in_block;
  }
  EXPECT_EQ(found, expected);
}

TEST(WriteTetgen, HasThreeFilesAndNoWedges) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = two_regions();
  const std::string refused = message_of<Unsupported>([&] { write_volume(folder / "t.node", mesh); });
  expect_contains(refused, "t.node: TetGen holds no wedges");
  EXPECT_EQ(folder.file_count(), 0u);
  write_volume(folder / "t.ele", mesh, kMetadata, {}, {.split_cells = true});
  EXPECT_EQ(folder.file_count(), 3u);
  const VolumeMesh split = split_cells(mesh).mesh;
  const auto rows = [&](const std::string& name) {
    std::vector<std::vector<double>> result;
    std::istringstream lines(content_of(folder / name));
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#') && !line.empty()) result.push_back(numbers(line));
    return result;
  };
  const auto nodes = rows("t.node"), cells = rows("t.ele"), faces = rows("t.face");
  ASSERT_EQ(nodes.size(), split.points.size() + 1);
  ASSERT_EQ(cells.size(), split.tetrahedra.size() + 1);
  ASSERT_EQ(faces.size(), split.boundary.size() + 1);
  EXPECT_EQ(nodes[0], (std::vector<double>{static_cast<double>(split.points.size()), 3, 0, 0}));
  EXPECT_EQ(cells[0], (std::vector<double>{static_cast<double>(split.tetrahedra.size()), 4, 1}));
  EXPECT_EQ(faces[0], (std::vector<double>{static_cast<double>(split.boundary.size()), 1}));
  for (std::size_t i = 0; i < split.points.size(); ++i) {
    const Vec3& x = split.points[i];
    EXPECT_EQ(nodes[i + 1], (std::vector<double>{static_cast<double>(i), x[0], x[1], x[2]}));
  }
  for (std::size_t i = 0; i < split.tetrahedra.size(); ++i) {
    const auto& [a, b, c, d] = split.tetrahedra[i];
    EXPECT_EQ(cells[i + 1], (std::vector<double>{static_cast<double>(i), 1.0 * a, 1.0 * b, 1.0 * c, 1.0 * d,
                                                 split.cell_region[i] + 1.0}));
  }
  for (std::size_t i = 0; i < split.boundary.size(); ++i) {
    const auto& [a, b, c, none] = split.boundary[i].corners;
    EXPECT_EQ(faces[i + 1],
              (std::vector<double>{static_cast<double>(i), 1.0 * a, 1.0 * b, 1.0 * c, split.boundary[i].patch + 1.0}));
  }
  expect_contains(content_of(folder / "t.face"), "# patch 2: inlet\n");
}

/// Faces of elements as CalculiX numbers them (manual: "Four-node tetrahedral element", "Six-node wedge element").
const std::vector<std::vector<std::size_t>> kC3D4 = {{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
const std::vector<std::vector<std::size_t>> kC3D6 = {{1, 2, 3}, {4, 5, 6}, {1, 2, 5, 4}, {2, 3, 6, 5}, {3, 1, 4, 6}};

TEST(WriteAbaqus, SetsAndSurfacesAreThoseOfTheMesh) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = two_regions();
  write_volume(folder / "t.inp", mesh, kMetadata);
  std::map<std::string, std::vector<std::vector<double>>> blocks;
  std::map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> surfaces;
  std::istringstream lines(content_of(folder / "t.inp"));
  std::string block;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_FALSE(line.empty()) << "CalculiX takes no empty lines";
    std::istringstream fields(line);
    for (std::string field; !line.starts_with('*') && std::getline(fields, field, ',');)
      EXPECT_LE(field.size(), 21u) << "CalculiX reads 20 characters, after a blank";
    if (line.starts_with("**")) continue;
    if (line.starts_with('*')) {
      block = line;
    } else if (block.starts_with("*SURFACE")) {
      const std::size_t s = line.find(", S");
      surfaces[block].emplace_back(std::stoul(line), std::stoul(line.substr(s + 3)));
    } else {
      blocks[block].push_back(numbers(line));
    }
  }
  ASSERT_EQ(blocks["*NODE"].size(), mesh.points.size());
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    const std::vector<double>& node = blocks["*NODE"][p];
    ASSERT_EQ(node.size(), 4u);
    EXPECT_EQ(node[0], static_cast<double>(p + 1));
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(node[static_cast<std::size_t>(k) + 1], mesh.points[p][k], 1e-12);  // 13 digits
  }
  const auto& tetrahedra = blocks["*ELEMENT, TYPE=C3D4, ELSET=core"];
  const auto& wedges = blocks["*ELEMENT, TYPE=C3D6, ELSET=layers"];
  ASSERT_EQ(tetrahedra.size(), mesh.tetrahedra.size());
  ASSERT_EQ(wedges.size(), mesh.wedges.size());
  std::map<std::size_t, std::vector<double>> element;
  for (const auto* rows : {&tetrahedra, &wedges})
    for (const std::vector<double>& row : *rows)
      element[static_cast<std::size_t>(row[0])] = {row.begin() + 1, row.end()};
  ASSERT_EQ(element.size(), mesh.cell_count());
  EXPECT_EQ(element.at(1), corners_from_one(mesh, mesh.boundary.size()));
  EXPECT_EQ(element.at(mesh.cell_count()), corners_from_one(mesh, mesh.boundary.size() + mesh.cell_count() - 1));
  for (Index patch = 0; patch < mesh.patch_names.size(); ++patch) {
    std::multiset<std::set<double>> expected, found;
    std::set<double> nodes, listed;
    for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
      if (mesh.boundary[f].patch != patch) continue;
      const std::vector<double> corners = corners_from_one(mesh, f);
      expected.insert({corners.begin(), corners.end()});
      nodes.insert(corners.begin(), corners.end());
    }
    for (const auto& [number, side] : surfaces["*SURFACE, NAME=" + mesh.patch_names[patch] + ", TYPE=ELEMENT"]) {
      const std::vector<double>& corners = element.at(number);
      std::set<double> face;
      for (const std::size_t i : (corners.size() == 4 ? kC3D4 : kC3D6).at(side - 1)) face.insert(corners.at(i - 1));
      found.insert(face);
    }
    EXPECT_EQ(found, expected) << mesh.patch_names[patch];
    for (const std::vector<double>& row : blocks["*NSET, NSET=" + mesh.patch_names[patch]]) {
      EXPECT_LE(row.size(), 16u);
      listed.insert(row.begin(), row.end());
    }
    EXPECT_EQ(listed, nodes) << mesh.patch_names[patch];
  }
}

TEST(WriteAbaqus, PyramidsAreRefusedUnlessSplit) {
  const TemporaryFolder folder;
  expect_contains(message_of<Unsupported>([&] { write_volume(folder / "t.inp", testing::mixed_cells()); }),
                  "t.inp: Abaqus holds no pyramids, and 1 cells of this mesh are such");
  write_volume(folder / "t.inp", testing::mixed_cells(), {}, {}, {.split_cells = true});
  EXPECT_EQ(content_of(folder / "t.inp").find("C3D6"), std::string::npos);
}

/// The entries of a list of OpenFOAM, after its number.
std::vector<std::string> foam_list(const std::string& content) {
  std::vector<std::string> entries = section(content.substr(content.find("\n}\n")), "(", "\n)\n");
  std::istringstream head(content.substr(content.find("\n}\n") + 3));
  std::size_t count = 0;
  head >> count;
  EXPECT_EQ(entries.size(), count);
  return entries;
}

std::vector<Index> foam_face(std::string text) {
  std::replace(text.begin(), text.end(), '(', ' ');
  std::replace(text.begin(), text.end(), ')', ' ');
  std::istringstream words(text);
  std::size_t count = 0;
  words >> count;
  std::vector<Index> corners{std::istream_iterator<Index>(words), {}};
  EXPECT_EQ(corners.size(), count);
  return corners;
}

TEST(WriteOpenFoam, PyramidsAreCellsLikeOthers) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = testing::mixed_cells();
  write_volume(folder / "polyMesh", mesh);
  EXPECT_EQ(foam_list(content_of(folder / "polyMesh/neighbour")), (std::vector<std::string>{"2", "2"}));
  EXPECT_EQ(foam_list(content_of(folder / "polyMesh/owner")).size(), 2 + mesh.boundary.size());
}

TEST(WriteOpenFoam, FacesBoundClosedCells) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = two_regions();
  write_volume(folder / "polyMesh", mesh, kMetadata);
  const auto points = foam_list(content_of(folder / "polyMesh/points"));
  const auto faces = foam_list(content_of(folder / "polyMesh/faces"));
  const auto owner = foam_list(content_of(folder / "polyMesh/owner"));
  const auto neighbour = foam_list(content_of(folder / "polyMesh/neighbour"));
  ASSERT_EQ(points.size(), mesh.points.size());
  ASSERT_EQ(owner.size(), faces.size());
  ASSERT_EQ(faces.size(), neighbour.size() + mesh.boundary.size());
  std::vector<Vec3> closed(mesh.cell_count(), Vec3::Zero());
  std::vector<double> volume(mesh.cell_count(), 0);
  std::pair<int, int> before = {-1, -1};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::vector<Index> corners = foam_face(faces[f]);
    Vec3 normal = Vec3::Zero();
    double cone = 0;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 &a = mesh.points[corners[0]], &b = mesh.points[corners[i - 1]], &c = mesh.points[corners[i]];
      normal += (b - a).cross(c - a) / 2;
      cone += a.cross(b).dot(c) / 6;
    }
    const auto of = static_cast<std::size_t>(std::stoi(owner[f]));
    closed[of] += normal;
    volume[of] += cone;
    if (f >= neighbour.size()) continue;
    const auto next = static_cast<std::size_t>(std::stoi(neighbour[f]));
    closed[next] -= normal;
    volume[next] -= cone;
    EXPECT_LT(of, next);
    const std::pair<int, int> now = {static_cast<int>(of), static_cast<int>(next)};
    EXPECT_LT(before, now) << "upper-triangular order";
    before = now;
  }
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    EXPECT_LT(closed[c].norm(), 1e-14);  // the faces of a closed cell
    EXPECT_GT(volume[c], 0);
  }
  const std::string boundary = content_of(folder / "polyMesh/boundary");
  expect_contains(boundary, "    wall\n    {\n        type        wall;\n");
  std::size_t first = neighbour.size();
  for (Index p = 0; p < 3; ++p) {
    const std::string entry = boundary.substr(boundary.find("    " + mesh.patch_names[p] + "\n"));
    const std::size_t start = std::stoul(entry.substr(entry.find("startFace") + 9));
    const std::size_t count = std::stoul(entry.substr(entry.find("nFaces") + 6));
    EXPECT_EQ(start, first);
    first += count;
    std::multiset<std::set<Index>> expected, found;
    for (const BoundaryFace& face : mesh.boundary) {
      if (face.patch == p) expected.insert({face.corners.begin(), face.corners.begin() + (face.is_triangle() ? 3 : 4)});
    }
    for (std::size_t f = start; f < start + count; ++f) {
      const std::vector<Index> corners = foam_face(faces[f]);
      found.insert({corners.begin(), corners.end()});
    }
    EXPECT_EQ(found, expected);
  }
  EXPECT_EQ(first, faces.size());
  expect_contains(content_of(folder / "polyMesh/cellZones"),
                  "    layers\n    {\n        type        cellZone;\n        cellLabels  List<label>\n" +
                      std::to_string(mesh.wedges.size()) + "\n(\n" + std::to_string(mesh.tetrahedra.size()) + "\n");
  expect_contains(content_of(folder / "polyMesh/points"), "SPACE=LPS UNIT=mm");
}

const MeshAttribute& attribute(const std::vector<MeshAttribute>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const MeshAttribute& a) { return a.name == name; });
}

TEST(WriteMeshComplete, SurfacesHaveTheNumbersOfTheVolume) {
  const TemporaryFolder folder;
  const VolumeMesh mesh = split_cells(two_regions()).mesh;
  const MeshAttribute radius{"radius", std::vector<double>(mesh.points.size(), 2.5)};
  write_volume(folder / "mesh-complete", mesh, kMetadata, {{radius}, {}});
  const LoadedVolume volume = read_volume(folder / "mesh-complete/mesh-complete.mesh.vtu");
  EXPECT_EQ(volume.mesh.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(volume.mesh.cell_region, mesh.cell_region);
  const auto& node = attribute(volume.attributes.point, "GlobalNodeID");
  const auto& element = attribute(volume.attributes.cell, "GlobalElementID");
  for (std::size_t p = 0; p < mesh.points.size(); ++p) EXPECT_EQ(node.values[p], static_cast<double>(p + 1));
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) EXPECT_EQ(element.values[c], static_cast<double>(c + 1));
  const auto faces_in = [&](const std::string& name) {
    const LoadedSurface surface = read_surface(folder / ("mesh-complete/" + name));
    const auto& nodes = attribute(surface.attributes.vertex, "GlobalNodeID");
    const auto& elements = attribute(surface.attributes.face, "GlobalElementID");
    const auto& patch = attribute(surface.attributes.face, "ModelFaceID");
    std::map<std::array<Index, 3>, double> result;
    for (std::size_t f = 0; f < surface.mesh.faces.size(); ++f) {
      Triangle corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index v = surface.mesh.faces[f][i];
        corners[i] = static_cast<Index>(nodes.values[v]) - 1;
        EXPECT_EQ(surface.mesh.vertices[v], mesh.points[corners[i]]);
        const Tetrahedron& behind = mesh.tetrahedra.at(static_cast<std::size_t>(elements.values[f]) - 1);
        EXPECT_EQ(std::count(behind.begin(), behind.end(), corners[i]), 1);
      }
      result[corners] = patch.values[f];
    }
    return result;
  };
  std::map<std::array<Index, 3>, double> all;
  std::array<std::map<std::array<Index, 3>, double>, 3> of_patch;
  for (const BoundaryFace& face : mesh.boundary) {
    const Triangle corners = {face.corners[0], face.corners[1], face.corners[2]};
    all[corners] = of_patch[face.patch][corners] = face.patch + 1.0;
  }
  EXPECT_EQ(faces_in("mesh-complete.exterior.vtp"), all);
  EXPECT_EQ(faces_in("walls_combined.vtp"), of_patch[0]);
  for (Index p = 0; p < 3; ++p) EXPECT_EQ(faces_in("mesh-surfaces/" + mesh.patch_names[p] + ".vtp"), of_patch[p]);
  EXPECT_EQ(read_surface(folder / "mesh-complete/mesh-complete.exterior.vtp").attributes.vertex.at(1).values[0], 2.5);
}

TEST(WriteFolders, AnOldMeshIsReplacedWhollyOrNotAtAll) {
  const TemporaryFolder folder;
  VolumeMesh mesh = split_cells(tube_volume()).mesh;
  write_volume(folder / "mesh-complete/", mesh);
  mesh.patch_names[2] = "left";
  write_volume(folder / "mesh-complete", mesh);
  EXPECT_TRUE(std::filesystem::exists(folder / "mesh-complete/mesh-surfaces/left.vtp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mesh-complete/mesh-surfaces/outlet.vtp"));
  folder.write("mesh-complete/solver.inp", "mine");
  const std::string refused = message_of<WriteError>([&] { write_volume(folder / "mesh-complete", mesh); });
  expect_contains(refused, "the folder is there and holds solver.inp, which would be lost");
  EXPECT_EQ(content_of(folder / "mesh-complete/solver.inp"), "mine");
  folder.write("file-polyMesh", "mine");
  expect_contains(message_of<WriteError>([&] { write_volume(folder / "file-polyMesh", mesh); }), "this is a file");
  mesh.boundary.pop_back();
  EXPECT_THROW(write_volume(folder / "polyMesh", mesh), InvalidInput);
  EXPECT_THROW(write_volume(folder / "none/polyMesh", tube_volume()), WriteError);
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(WriteSmesh, FacetsHaveTheMarkersOfTheirPatches) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1}},
                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  MeshAttributes attributes;
  attributes.face.push_back({"CapID", {2, -1, 1, -1}, true});
  write_surface(folder / "t.smesh", mesh, attributes, {"vmesh 1", {}, {}, {}});
  std::vector<std::vector<double>> rows;
  std::istringstream lines(content_of(folder / "t.smesh"));
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with('#') && !line.empty()) rows.push_back(numbers(line));
  EXPECT_EQ(rows, (std::vector<std::vector<double>>{{4, 3, 0, 0},
                                                    {0, 0, 0, 0},
                                                    {1, 1, 0, 0},
                                                    {2, 0, 1.0 / 3, 0},
                                                    {3, 0, 0, 1},
                                                    {4, 1},
                                                    {3, 0, 2, 1, 3},
                                                    {3, 0, 1, 3, 1},
                                                    {3, 0, 3, 2, 2},
                                                    {3, 1, 2, 3, 1},
                                                    {0},
                                                    {0}}));
  expect_contains(content_of(folder / "t.smesh"), "# patch 3: cap_2\n");
}

}  // namespace
}  // namespace vmesh
