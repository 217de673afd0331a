#include <algorithm>
#include <bit>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

const std::string kHeader = "# vtk DataFile Version 4.2\nvtk output\nASCII\nDATASET POLYDATA\n";
const std::string kPoints = "POINTS 5 float\n0 0 0 1 0 0 2 0 0\n5 5 5 2 1e0 -.5\n";
const std::string kLines = "LINES 2 7\n3 0 1 2\n2 2 4\n";
const std::string kRadius = "POINT_DATA 5\nFIELD FieldData 1\nRadius 1 5 double\n1 2 3 4\n5\n";
const std::string kFile = kHeader + kPoints + kLines + kRadius;

RawCenterline parse(const std::string& text, const std::string& radius = {}) {
  CenterlineReadOptions options;
  options.radius_array = radius;
  return parse_centerline(text, centerline_format("t.vtk"), "t.vtk", options);
}

std::string error(const std::string& text) {
  const std::string message = message_of<InvalidInput>([&] { parse(text); });
  expect_contains(message, "t.vtk: ");
  return message;
}

/// kFile with `from` replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kFile;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The number's bytes, the most significant first.
template <class Number>
std::string big(Number number) {
  std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
  if (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

template <class Number>
std::string big(std::initializer_list<double> numbers) {
  std::string bytes;
  for (const double number : numbers) bytes += big(static_cast<Number>(number));
  return bytes;
}

/// kFile in the binary variant; `lines` and `attributes` stand for its cells and radii.
std::string binary(const std::string& lines, const std::string& attributes) {
  return "# vtk DataFile Version 4.2\nvtk output SPACE=RAS\nBINARY\nDATASET POLYDATA\nPOINTS 5 float\n" +
         big<float>({0, 0, 0, 1, 0, 0, 2, 0, 0, 5, 5, 5, 2, 1, -.5}) + "\n" + lines + attributes;
}

const std::string kBinaryLines = "LINES 2 7\n" + big<std::int32_t>({3, 0, 1, 2, 2, 2, 4}) + "\n";
const std::string kBinaryRadius =
    "POINT_DATA 5\nFIELD FieldData 1\nRadius 1 5 double\n" + big<double>({1, 2, 3, 4, 5}) + "\n";

void expect_is_the_file(const RawCenterline& raw) {
  ASSERT_EQ(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[3].position, Vec3(2, 1, -0.5));
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(raw.nodes[n].radius, (std::vector<double>{1, 2, 3, 5})[n]);
  ASSERT_EQ(raw.segments.size(), 3u);
  EXPECT_EQ(raw.segments[2].a, 2u);
  EXPECT_EQ(raw.segments[2].b, 3u);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2}));
  EXPECT_EQ(raw.name_of_node(3), "t.vtk: point 4");
  EXPECT_EQ(raw.warnings.size(), 1u);  // a point without a line
}

TEST(ReadLegacyVtk, ReadsPolylinesAndLeavesUnusedPointsOut) {
  const auto raw = parse(kFile);
  expect_is_the_file(raw);
  EXPECT_EQ(raw.name_of_segment(2), "t.vtk: line cell 1");
  EXPECT_EQ(raw.unit, LengthUnit::unknown);
  EXPECT_TRUE(raw.loose_branches);
}

TEST(ReadLegacyVtk, ReadsTheBinaryVariant) {
  const RawCenterline raw = parse(binary(kBinaryLines, kBinaryRadius));
  expect_is_the_file(raw);
  EXPECT_EQ(raw.space, Space::ras);
  expect_is_the_file(
      parse(binary("METADATA\nINFORMATION 0\n\nLINES 3 5\nOFFSETS vtktypeint64\n" + big<std::int64_t>({0, 3, 5}) +
                       "\nCONNECTIVITY vtktypeint64\n" + big<std::int64_t>({0, 1, 2, 2, 4}) + "\n",
                   kBinaryRadius)));
}

TEST(ReadLegacyVtk, SkipsInTheBinaryVariantWhatIsNoCenterline) {
  const std::string ten(10, '\n');  // bytes that look like the ends of lines
  const std::string others = "CELL_DATA 2\nSCALARS Radius short\nLOOKUP_TABLE default\n" + big<std::int16_t>({9, 9}) +
                             "\nPOINT_DATA 5\nSCALARS flag bit\nLOOKUP_TABLE default\n\x0a\nCOLOR_SCALARS c 2\n" + ten +
                             "\nLOOKUP_TABLE mine 2\n" + ten.substr(2) + "\nNORMALS n char\n" + ten + ten.substr(5) +
                             "\nFIELD FieldData 2\nnames 1 2 string\n\xc2no\x80\x03" + "abc\nRadius 1 5 float\n" +
                             big<float>({1, 2, 3, 4, 5}) + "\n";
  expect_is_the_file(parse(binary("FIELD FieldData 1\nSPACE 1 1 string\n\xc3LPS\n" + kBinaryLines, others)));
}

TEST(ReadLegacyVtk, SaysWhatIsWrongInTheBinaryVariant) {
  const std::string file = binary(kBinaryLines, kBinaryRadius);
  for (std::size_t size = 1; size + 1 < file.size(); ++size) {
    SCOPED_TRACE(size);
    expect_contains(message_of<Error>([&] { parse(file.substr(0, size)); }), "t.vtk: ");
  }
  expect_contains(error(binary("LINES 2 7\n" + big<std::int32_t>({3, 0, 1, 2, 2, 2, 5}) + "\n", kBinaryRadius)),
                  "there is no point 5");
  expect_contains(error(binary("LINES 2 7\n" + big<std::int32_t>({9, 0, 1, 2, 2, 2, 4}) + "\n", kBinaryRadius)),
                  "the cells do not have the 7 numbers");
  expect_contains(error(binary(kBinaryLines, "POINT_DATA 5\nSCALARS Radius quaternion\nLOOKUP_TABLE t\n")),
                  "the type \"quaternion\" is not known");
}

TEST(ReadLegacyVtk, TakesRadiiOfLinesAndHalvesDiameters) {
  const std::string cells = "CELL_DATA 2\nSCALARS Diameter double\nLOOKUP_TABLE default\n4 2\n";
  const RawCenterline raw = parse(kHeader + kPoints + kLines + cells, "Diameter");
  // The lines meet in a point, which has the smaller radius; the thick line gets a node that radius away.
  ASSERT_EQ(raw.nodes.size(), 4u + 1u);
  EXPECT_EQ(raw.nodes[0].radius, 2);
  EXPECT_EQ(raw.nodes[1].radius, 2);
  EXPECT_EQ(raw.nodes[2].radius, 1);
  EXPECT_EQ(raw.nodes[3].radius, 1);
  EXPECT_EQ(raw.nodes[4].radius, 2);
  EXPECT_EQ(raw.nodes[4].position, Vec3(1.5, 0, 0));
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 3}));
  expect_contains(error(kHeader + kPoints + kLines + cells), "none of points and Diameter of lines");
  CenterlineReadOptions one_for_all;
  one_for_all.radius = 3;
  EXPECT_EQ(
      parse_centerline(kHeader + kPoints + kLines, centerline_format("t.vtk"), "t.vtk", one_for_all).nodes[0].radius,
      0);
}

TEST(ReadLegacyVtk, ReadsCellsWithOffsets) {
  expect_is_the_file(parse(with(kLines,
                                "METADATA\nINFORMATION 0\n\n"
                                "LINES 3 5\nOFFSETS vtktypeint64\n0 3 5\nCONNECTIVITY vtktypeint64\n0 1 2 2 4\n")));
}

TEST(ReadLegacyVtk, SkipsWhatIsNoCenterline) {
  const std::string others =
      "POLYGONS 1 4\n3 0 1 2\nCELL_DATA 3\nSCALARS Radius int 2\nLOOKUP_TABLE default\n9 9 9 9 9 9\n"
      "LOOKUP_TABLE mine 1\n0 0 0 1\nPOINT_DATA 5\nSCALARS label int\nLOOKUP_TABLE default\n7 7 7 7 7\n"
      "NORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\nTEXTURE_COORDINATES t 2 float\n0 0 0 0 0 0 0 0 0 0\n"
      "COLOR_SCALARS c 1\n0 0 0 0 0\n";
  expect_is_the_file(parse(with("POINT_DATA 5\n", others)));
  expect_is_the_file(parse(with("FieldData 1\n", "FieldData 2\nTopology 2 5 vtktypeint64\n1 2 3 4 5 6 7 8 9 0\n")));
}

TEST(ReadLegacyVtk, FindsTheRadiusUnderItsUsualNamesOrTheOneGiven) {
  expect_is_the_file(parse(with("FIELD FieldData 1\nRadius 1 5 double\n",
                                "SCALARS MaximumInscribedSphereRadius double 1\nLOOKUP_TABLE default\n")));
  expect_is_the_file(parse(with("Radius", "radius")));
  expect_is_the_file(parse(with("Radius", "thickness"), "thickness"));
  expect_contains(error(with("Radius", "thickness")), "it has thickness");
  expect_contains(error(with("Radius 1 5 double\n1 2 3 4\n5", "Radius 2 5 double\n1 2 3 4 5 6 7 8 9 0")),
                  "one number for every point");
}

TEST(ReadLegacyVtk, ReadsFrameAndUnitFromTitleOrFieldData) {
  EXPECT_EQ(parse(with("vtk output", "vtk output SPACE=RAS")).space, Space::ras);
  const auto raw = parse(with("POINTS", "FIELD FieldData 2\nSPACE 1 1 string\nRAS\nUNIT 1 1 string\ncm\nPOINTS"));
  expect_is_the_file(raw);
  EXPECT_EQ(raw.space, Space::ras);
  EXPECT_EQ(raw.unit, LengthUnit::cm);
}

TEST(ReadLegacyVtk, NamesTheLineThatIsWrong) {
  expect_contains(error("1 1 0 0 0 1 -1\n"), "line 1: this is not a legacy VTK file");
  expect_contains(error(with("1e0", "one")), "line 7: \"one\" is not a number");
  expect_contains(error(with("2 2 4\n", "2 2 5\n")), "line 10: there is no point 5");
  expect_contains(error(with("2 2 4\n", "2 2 -1\n")), "line 10: there is no point -1");
  expect_contains(error(with("LINES 2 7", "LINES 2 8")), "line 10: the cells do not have the 8 numbers");
  expect_contains(error(with("LINES 2 7", "LINES 1 4")), "line 10: \"2\" is not a keyword");
  expect_contains(error(with("2 2 4\n", "9999999 2 4\n")), "line 10: the count 9999999");
  expect_contains(error(with("POINTS 5", "POINTS 99999999999")), "line 5: the count 99999999999");
  expect_contains(error(with("POINTS 5", "POINTS -5")), "line 5: the count -5 is negative");
  expect_contains(error(with("POINT_DATA 5", "POINT_DATA 4")), "line 11: there must be data for every one of the 5");
  expect_contains(error(with("Radius 1 5", "Radius 9999999 9999999")), "line 13: the count 9999999");
  expect_contains(error(with(kLines, "LINES 3 5\nOFFSETS int\n0 3 6\nCONNECTIVITY int\n0 1 2 2 4\n")),
                  "line 10: the offset 6");
  expect_contains(error(with(kLines, "")), "it contains no line");
  expect_contains(error(kHeader), "it contains no point");
}

TEST(ReadLegacyVtk, EveryCutFileIsRefused) {
  for (std::size_t size = 1; size + 2 < kFile.size(); ++size) {
    SCOPED_TRACE(size);
    expect_contains(message_of<Error>([&] { parse(kFile.substr(0, size)); }), "t.vtk: ");
  }
}

TEST(ReadLegacyVtk, SaysWhatIsNotSupported) {
  expect_contains(error(with("ASCII", "OCTAL")), "ASCII or BINARY");
  expect_contains(message_of<Unsupported>([] { parse(with("POLYDATA", "UNSTRUCTURED_GRID")); }), "UNSTRUCTURED_GRID");
}

TEST(SharedData, LegacyVtkIsTheSameCenterlineAsItsVtp) {
  VMESH_NEED_SHARED_DATA("pairs_centerline_surface/aorta-centerline.vtk");
  for (const std::string name : {"pairs_centerline_surface/aorta-centerline",
                                 "pairs_centerline_surface/centerline-based-material-props_c++_aorta_cl",
                                 "pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_cl",
                                 "pairs_centerline_surface/project-node-onto-centerline_c++_demo-centerlines",
                                 "microvascular_loops/tapmeier_network"}) {
    SCOPED_TRACE(name);
    const auto vtk = read_centerline(testing::shared_data(name + ".vtk"));
    const auto vtp = read_centerline(testing::shared_data(name + ".vtp"));
    ASSERT_EQ(vtk.nodes.size(), vtp.nodes.size());
    for (std::size_t n = 0; n < vtp.nodes.size(); ++n) {
      ASSERT_LE((vtk.nodes[n].position - vtp.nodes[n].position).norm(), 1e-5 * vtp.nodes[n].position.norm());
      ASSERT_NEAR(vtk.nodes[n].radius, vtp.nodes[n].radius, 1e-6 * vtp.nodes[n].radius + 1e-12);
    }
    ASSERT_EQ(vtk.segments.size(), vtp.segments.size());
    for (std::size_t s = 0; s < vtp.segments.size(); ++s) {
      ASSERT_EQ(vtk.segments[s].a, vtp.segments[s].a);
      ASSERT_EQ(vtk.segments[s].b, vtp.segments[s].b);
    }
    EXPECT_EQ(vtk.path_starts, vtp.path_starts);
    EXPECT_EQ(vtk.segment_numbers, vtp.segment_numbers);
  }
}

LoadedSurface surface_of(const std::string& text) { return parse_surface(text, surface_format("t.vtk"), "t.vtk"); }

TEST(ReadLegacyVtkSurface, ReadsPolygonsAndStripsWithWhatBelongsToThem) {
  const LoadedSurface surface =
      surface_of(kHeader +
                 "POINTS 5 float\n0 0 0 1 0 0 1 1 0 0 1 0 2 1 0\nVERTICES 1 2\n1 0\nLINES 1 3\n2 0 1\n"
                 "POLYGONS 1 4\n3 0 1 2\nTRIANGLE_STRIPS 1 5\n4 3 0 2 4\nPOINT_DATA 5\n"
                 "SCALARS MaximumInscribedSphereRadius double\nLOOKUP_TABLE default\n1 2 3 4 5.5\n"
                 "CELL_DATA 4\nFIELD f 2\nGroupIds 1 4 int\n1 2 3 4\nlate 1 3 int\n1 2 3\n");
  EXPECT_EQ(surface.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {3, 0, 2}, {2, 0, 4}}));
  ASSERT_EQ(surface.attributes.vertex.size(), 1u);
  EXPECT_EQ(surface.attributes.vertex[0].name, "radius");
  EXPECT_EQ(surface.attributes.vertex[0].values, (std::vector<double>{1, 2, 3, 4, 5.5}));
  ASSERT_EQ(surface.attributes.face.size(), 1u);
  EXPECT_EQ(surface.attributes.face[0].name, "group");
  EXPECT_TRUE(surface.attributes.face[0].integer);
  EXPECT_EQ(surface.attributes.face[0].values, (std::vector<double>{3, 4, 4}));
}

TEST(ReadLegacyVtkSurface, ReadsTheBinaryVariant) {
  const std::string head = "# vtk DataFile Version 5.1\nwall SPACE=RAS\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n" +
                           big<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + "\n";
  const LoadedSurface old = surface_of(head + "POLYGONS 2 8\n" + big<std::int32_t>({3, 0, 1, 2, 3, 0, 2, 3}) + "\n");
  const LoadedSurface recent =
      surface_of(head + "POLYGONS 3 6\nOFFSETS vtktypeint64\n" + big<std::int64_t>({0, 3, 6}) +
                 "\nCONNECTIVITY vtktypeint64\n" + big<std::int64_t>({0, 1, 2, 0, 2, 3}) + "\n");
  for (const LoadedSurface& surface : {old, recent}) {
    EXPECT_EQ(surface.mesh.vertices[2], Vec3(1, 1, 0));
    EXPECT_EQ(surface.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(surface.space, Space::ras);
  }
}

TEST(ReadLegacyVtkSurface, RefusesAFileWithoutFaces) {
  expect_contains(message_of<InvalidInput>([] { surface_of(kFile); }), "no triangle");
  expect_contains(message_of<InvalidInput>([] { surface_of(kHeader + kPoints + "POLYGONS 1 4\n3 0 1 5\n"); }),
                  "there is no point 5");
}

}  // namespace
}  // namespace vmesh
