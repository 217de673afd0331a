#include <numbers>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;

/// A file of two polylines with five points, one of them in no line.
std::string vtp(const std::string& radius_name = "Radius", const std::string& points = "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0",
                const std::string& ids = "0 1 2 2 4", const std::string& offsets = "3 5",
                const std::string& count = "5") {
  return R"(<?xml version="1.0"?><VTKFile type="PolyData" version="0.1" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints=")" +
         count + R"(" NumberOfVerts="0" NumberOfLines="2" NumberOfStrips="0" NumberOfPolys="0">
<PointData><DataArray type="Float64" Name=")" +
         radius_name + R"(" format="ascii">1 2 3 4 5</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">)" +
         points + R"(</DataArray></Points>
<Lines><DataArray type="Int64" Name="connectivity" format="ascii">)" +
         ids + R"(</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">)" +
         offsets + R"(</DataArray></Lines></Piece></PolyData></VTKFile>)";
}

RawCenterline parse(const std::string& text, const std::string& radius = {}) {
  CenterlineReadOptions options;
  options.radius_array = radius;
  return parse_centerline(text, centerline_format("t.vtp"), "t.vtp", options);
}

std::string error(const std::string& text) {
  ::testing::internal::CaptureStderr();
  const auto message = message_of<InvalidInput>([&] { parse(text); });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "readers must not write to the terminal";
  expect_contains(message, "t.vtp");
  return message;
}

TEST(ReadVtp, ReadsPolylinesAndLeavesUnusedPointsOut) {
  const auto raw = parse(vtp());
  ASSERT_EQ(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[3].position, Vec3(2, 1, 0));
  EXPECT_EQ(raw.nodes[3].radius, 5);
  EXPECT_EQ(raw.segments.size(), 3u);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2}));
  EXPECT_EQ(raw.name_of_node(3), "t.vtp: point 4");
  EXPECT_EQ(raw.name_of_segment(2), "t.vtp: line cell 1");
  EXPECT_EQ(raw.warnings.size(), 1u);
  EXPECT_EQ(raw.unit, LengthUnit::unknown);
  EXPECT_TRUE(raw.loose_branches);
}

TEST(ReadVtp, FindsTheRadiusUnderItsUsualNamesOrTheOneGiven) {
  for (const std::string name : {"MaximumInscribedSphereRadius", "Radius", "radius"}) {
    EXPECT_EQ(parse(vtp(name)).nodes[0].radius, 1) << name;
  }
  EXPECT_EQ(parse(vtp("thickness"), "thickness").nodes[0].radius, 1);
  expect_contains(error(vtp("thickness")), "thickness");
}

TEST(ReadVtp, DiametersAndAreasBecomeRadiiWhichIsSaid) {
  const auto diameters = parse(vtp("MeanDiameter"), "MeanDiameter");
  EXPECT_EQ(diameters.nodes[1].radius, 1);
  EXPECT_EQ(diameters.radius_arrays, std::vector<std::string>{"MeanDiameter"});
  expect_contains(diameters.warnings.back(), "t.vtp: radii are half of \"MeanDiameter\"");
  for (const std::string wanted : {"CenterlineSectionArea", ""}) {
    const auto areas = parse(vtp("CenterlineSectionArea"), wanted);
    for (Index n = 0; n < 3; ++n) {
      const double radius = areas.nodes[n].radius;
      EXPECT_NEAR(std::numbers::pi * radius * radius, n + 1, 1e-12);
    }
    expect_contains(areas.warnings.back(), "circles of the area \"CenterlineSectionArea\"");
  }
  EXPECT_EQ(parse(vtp("RadiusOfTheArea"), "RadiusOfTheArea").nodes[1].radius, 2);
}

TEST(ReadVtp, AnAreaIsTakenOnlyIfNothingElseMayHoldTheRadius) {
  const std::string area = R"(<DataArray type="Float64" Name="AREA" format="ascii">5 5 5 5 5</DataArray>)";
  const auto with_area = [&](std::string text) { return text.insert(text.find("<PointData>") + 11, area); };
  EXPECT_EQ(parse(with_area(vtp("Radius"))).nodes[1].radius, 2);
  EXPECT_EQ(parse(with_area(vtp("Radius"))).radius_arrays, std::vector<std::string>{"Radius"});
  expect_contains(error(with_area(vtp("SectionArea"))), "--radius-array");
  CenterlineReadOptions one_for_all;
  one_for_all.radius = 7;
  const auto raw = parse_centerline(vtp("SectionArea"), centerline_format("t.vtp"), "t.vtp", one_for_all);
  EXPECT_EQ(raw.nodes[1].radius, 0);  // which convert_read() replaces
  EXPECT_TRUE(raw.radius_arrays.empty());
}

TEST(ReadVtp, RefusesBrokenFilesWithoutNoise) {
  error("<VTKFile");
  error("not XML at all");
  error("<VTKFile type=\"PolyData\"><unclosed></VTKFile>");
  error("<VTKFile type=\"ImageData\" version=\"0.1\"></VTKFile>");
  expect_contains(error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 9")), "point 9");
  expect_contains(error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 -1")), "point -1");
  error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 4", "3 500"));
  error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 4", "5 3"));
  expect_contains(error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 4", "3 5", "99999999999")),
                  "99999999999");
  expect_contains(error(vtp("Radius", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0", "0 1 2 2 4", "3 5", "-4")), "-4");
}

TEST(ReadVtp, EveryCutFileIsRefused) {
  const std::string whole = vtp();
  for (std::size_t size = 0; size + 1 < whole.size(); size += 3) {
    SCOPED_TRACE(size);
    error(whole.substr(0, size));
  }
}

/// One point with a radius, in a file of its own. `points` and `radius` are the rest of their tags and their data.
std::string one_point(const std::string& file, const std::string& points, const std::string& radius,
                      const std::string& rest = "") {
  return "<VTKFile type='PolyData' " + file +
         "><PolyData><Piece NumberOfPoints='1' NumberOfVerts = \"1\"><PointData><DataArray Name='a&amp;b' " + radius +
         "</PointData><Points><DataArray NumberOfComponents='3' " + points +
         "</Points><Verts><DataArray type='Int8' Name='connectivity'>0</DataArray><DataArray type='Int8' "
         "Name='offsets'>1</DataArray></Verts></Piece></PolyData>" +
         rest + "</VTKFile>";
}

void expect_point(const std::string& file) {
  const RawCenterline raw = parse(file, "a&b");
  ASSERT_EQ(raw.nodes.size(), 1u);
  EXPECT_EQ(raw.nodes[0].position, Vec3(1, 2, -3));
  EXPECT_EQ(raw.nodes[0].radius, 7);
}

TEST(ReadVtp, ReadsNumbersInEveryEncoding) {
  const std::string end = "</DataArray>", text = "type='Float64' format='ascii'> 1 2\n-3e0 " + end;
  const std::string radius = "type='UInt8'>7" + end;
  expect_point(one_point("", text, radius));
  // The number of bytes, then the bytes.
  expect_point(one_point("", "type='Int8' format='binary'>AwAAAAEC/Q==" + end, radius));
  expect_point(one_point("header_type='UInt64'", "type='Int8' format='binary'> AwAAAAAAAAABAv0=\n" + end, radius));
  expect_point(one_point("byte_order='BigEndian'", "type='Int16' format='binary'>AAAABgABAAL//Q==" + end,
                         "type='UInt32' format='binary'>AAAABAAAAAc=" + end));
  // The number of blocks, their size, that of the last, their compressed sizes, then zlib's bytes.
  expect_point(one_point("compressor='vtkZLibDataCompressor'",
                         "type='Int8' format='binary'>AQAAAAMAAAADAAAACwAAAA==eJxjZPoLAAEHAQE=" + end, radius));
  expect_point(one_point("", "type='Int8' format='appended' offset='0'/>",
                         "type='Int8' format='appended' offset='12'/>",
                         "<AppendedData encoding='base64'> _AwAAAAEC/Q==AQAAAAc=</AppendedData>"));
  expect_point(
      one_point("", "type='Int8' format='appended' offset='0'/>", "type='Int8' format='appended' offset='7'/>",
                "<AppendedData encoding='raw'>_" + std::string("\3\0\0\0\1\2\xfd\1\0\0\0\7", 12) + "</AppendedData>"));
}

TEST(ReadVtp, PutsPiecesOneBehindTheOther) {
  const auto piece = [](const std::string& x, const std::string& radius) {
    return "<Piece NumberOfPoints='2' NumberOfLines='1'><PointData><DataArray type='Int8' Name='radius'>" + radius +
           "</DataArray></PointData><Points><DataArray type='Int8' NumberOfComponents='3'>0 0 0 " + x +
           " 0 0</DataArray></Points><Lines><DataArray type='Int8' Name='connectivity'>0 1</DataArray><DataArray "
           "type='Int8' Name='offsets'>2</DataArray></Lines></Piece>";
  };
  const auto raw =
      parse("<VTKFile type='PolyData'><PolyData>" + piece("4", "1 2") + piece("5", "3 4") + "</PolyData></VTKFile>");
  ASSERT_EQ(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[3].position, Vec3(5, 0, 0));
  EXPECT_EQ(raw.nodes[3].radius, 4);
  ASSERT_EQ(raw.segments.size(), 2u);
  EXPECT_EQ(raw.segments[1].b, 3u);
}

TEST(ReadVtp, RefusesWhatItCannotUnpack) {
  const std::string text = "type='Int8'>1 2 3</DataArray>";
  expect_contains(message_of<Unsupported>([&] { parse(one_point("compressor='vtkLZ4DataCompressor'", text, text)); }),
                  "LZ4");
  expect_contains(
      error(one_point("compressor='vtkZLibDataCompressor'",
                      "type='Int8' format='binary'>AQAAAAMAAAADAAAACwAAAA==eJxjZPoLAAEHAQA=</DataArray>", text)),
      "damaged");
  expect_contains(error(one_point("", "type='Int8' format='appended' offset='99'/>", text,
                                  "<AppendedData encoding='raw'>_abc</AppendedData>")),
                  "99");
  expect_contains(
      error(one_point("", "type='Int8' format='appended' offset='0'/>", "type='Int8' format='appended' offset='0'/>",
                      "<AppendedData encoding='raw'>_" + std::string("\3\0\0\0\1\2\3", 7) + "</AppendedData>")),
      "overlap");
}

TEST(ReadVtp, CutsOfACompressedFileAreRefused) {
  const TemporaryFolder folder;
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < 500; ++i) {
    nodes.push_back({{i * 0.1, i * 0.01, 0}, 1});
    if (i > 0) segments.push_back({i - 1, i});
  }
  write_centerline(folder / "t.vtp", Centerline(nodes, segments));
  const std::string whole = testing::content_of(folder / "t.vtp");
  for (std::size_t size = 0; size + 20 < whole.size(); size += 97) {
    SCOPED_TRACE(size);
    error(whole.substr(0, size));
  }
  // Damage inside the data: an error or other numbers, but no crash.
  for (std::size_t at = 400; at < whole.size(); at += 53) {
    std::string damaged = whole;
    damaged[at] = damaged[at] == 'A' ? 'B' : 'A';
    try {
      parse(damaged);
    } catch (const InvalidInput& problem) {
      expect_contains(problem.what(), "t.vtp");
    }
  }
}

/// Cells of an unstructured grid over five points: a triangle, a line, a polyline and a vertex, numbered 10 to 40.
std::string vtu(const std::string& types = "5 3 4 1", const std::string& ids = "0 1 2 2 3 0 1 2 4",
                const std::string& radius = R"(<DataArray type="Int8" Name="radius">1 2 3 4 5</DataArray>)") {
  return R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><FieldData>
<DataArray type="String" Name="UNIT" NumberOfTuples="1" format="ascii">117 109 0</DataArray></FieldData>
<Piece NumberOfPoints="5" NumberOfCells="4"><PointData>)" +
         radius + R"(</PointData><CellData><DataArray type="Int8" Name="wide">10 20 30 40</DataArray></CellData>
<Points><DataArray type="Int8" NumberOfComponents="3">0 0 0 9 0 0 18 0 0 18 9 0 5 5 5</DataArray></Points>
<Cells><DataArray type="Int8" Name="connectivity">)" +
         ids + R"(</DataArray><DataArray type="Int8" Name="offsets">3 5 8 9</DataArray>
<DataArray type="UInt8" Name="types">)" +
         types + R"(</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";
}

RawCenterline parse_vtu(const std::string& text, const std::string& radius = {}) {
  CenterlineReadOptions options;
  options.radius_array = radius;
  return parse_centerline(text, centerline_format("t.vtu"), "t.vtu", options);
}

TEST(ReadVtu, TakesLinesAndPointsAndSaysWhatItLeavesOut) {
  const auto raw = parse_vtu(vtu());
  EXPECT_EQ(raw.unit, LengthUnit::um);
  ASSERT_EQ(raw.nodes.size(), 5u);
  ASSERT_EQ(raw.segments.size(), 3u);
  EXPECT_EQ(raw.nodes[raw.segments[0].b].position, Vec3(18, 9, 0));
  EXPECT_EQ(raw.nodes[raw.segments[0].b].radius, 4);
  EXPECT_EQ(raw.nodes[raw.segments[1].a].position, Vec3(0, 0, 0));
  EXPECT_EQ(raw.nodes[raw.segments[2].b].radius, 3);
  ASSERT_EQ(raw.warnings.size(), 1u);
  expect_contains(raw.warnings[0], "t.vtu: 1 cells are neither lines nor points");
}

TEST(ReadVtu, NumbersOfCellsStayWithTheirCells) {
  const auto raw = parse_vtu(vtu(), "wide");
  ASSERT_GE(raw.segments.size(), 3u);
  double end = 0, alone = 0, begin = 0;
  for (const CenterlineNode& node : raw.nodes) {
    if (node.position == Vec3(18, 9, 0)) end = node.radius;
    if (node.position == Vec3(0, 0, 0)) begin = node.radius;
    if (node.position == Vec3(5, 5, 5)) alone = node.radius;
  }
  EXPECT_EQ(end, 20);
  EXPECT_EQ(begin, 30);
  EXPECT_EQ(alone, 40);
}

TEST(ReadVtu, NamesWhatIsWrong) {
  const auto refusal = [](const std::string& text) { return message_of<InvalidInput>([&] { parse_vtu(text); }); };
  expect_contains(refusal(vtp()), "this is not a VTU file");
  expect_contains(error(vtu()), "this is not a VTP file");
  expect_contains(refusal(vtu("5 3 4")), "t.vtu");
  expect_contains(refusal(vtu("5 3 4 1", "0 1 2 2 3 0 1 7 4")), "there is no point 7");
  expect_contains(refusal(vtu("5 5 5 5")), "t.vtu");
  expect_contains(refusal(vtu("5 3 4 1", "0 1 2 2 3 0 1 2 4", "")), "--radius-array");
  std::string without_types = vtu();
  without_types.replace(without_types.find("\"types\""), 7, "\"other\"");
  expect_contains(refusal(without_types), "needs an array \"types\"");
  const std::string text = vtu();
  for (std::size_t end = 0; end < text.size(); end += 7) EXPECT_THROW(parse_vtu(text.substr(0, end)), InvalidInput);
}

TEST(ReadVtu, PackedAndAppendedDataAreReadAsThoseOfVtp) {
  VMESH_NEED_SHARED_DATA("field/lines.vtu");
  const auto cleaned = load_centerline(testing::shared_data("field/lines.vtu")).cleaned;
  EXPECT_EQ(cleaned.centerline.nodes().size(), 37u);
  EXPECT_EQ(cleaned.centerline.segments().size(), 36u);
  EXPECT_EQ(cleaned.centerline.component_count(), 1u);
}

TEST(WriteVtp, NamesItsArraysLikeVmtkDoes) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  write_surface(folder / "t.vtp", mesh,
                {{{"radius", {1, 2, 3}, false}, {"group", {0, 0, 1}, true}, {"distance", {0, 0, 0}, false}},
                 {{"EquiangleSkewness", {0.25}, false}, {"quality", {1}, false}}});
  const std::string content = testing::content_of(folder / "t.vtp");
  for (const char* name : {"Normals", "MaximumInscribedSphereRadius", "GroupIds", "Distance", "EquiangleSkewness",
                           "Quality", "SPACE", "UNIT"}) {
    expect_contains(content, std::string("Name=\"") + name + "\"");
  }
}

TEST(WriteVtp, PacksInBlocks) {
  const TemporaryFolder folder;
  TriMesh mesh;  // more than three blocks of points
  for (Index i = 0; i < 40'000; ++i) mesh.vertices.emplace_back(i, 0.5 * i * i, std::sqrt(i));
  for (Index i = 0; i + 2 < mesh.vertices.size(); ++i) mesh.faces.push_back({i, i + 1, i + 2});
  write_surface(folder / "t.vtp", mesh);
  const TriMesh again = read_surface(folder / "t.vtp").mesh;
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.faces, mesh.faces);
}

TEST(WriteVtp, NamesMayHaveAnyCharacter) {
  const TemporaryFolder folder;
  const TriMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::string name = "a<b> & \"c\"";
  write_surface(folder / "t.vtp", mesh, {{{name, {1, 2, 3}, false}}, {}});
  const MeshAttributes read = read_surface(folder / "t.vtp").attributes;
  EXPECT_TRUE(std::any_of(read.vertex.begin(), read.vertex.end(), [&](const auto& a) { return a.name == name; }));
}

}  // namespace
}  // namespace vmesh
