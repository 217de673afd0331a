#include <algorithm>
#include <bit>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

const std::string kHeader =
    "\n\ndefine VERTEX 4\ndefine EDGE 3\ndefine POINT 8\n\nParameters {\n    Units {\n        Coordinates \"um\"\n    "
    "}\n"
    "    ContentType \"HxSpatialGraph\"\n}\n\nVERTEX { float[3] VertexCoordinates } @1\n"
    "EDGE { int[2] EdgeConnectivity } @2\nEDGE { int NumEdgePoints } @3\nPOINT { float[3] EdgePointCoordinates } @4\n";
const std::string kGraph =
    "@1\n0 0 0\n0 0 50\n20 0 80\n-20 0 80\n\n@2\n0 1\n1 2\n1 3\n\n@3\n3\n3\n2\n\n"
    "@4\n0 0 0\n1 0 25\n0 0 50\n0 0 50\n12 0 60\n20 0 80\n0 0 50\n-20 0 80\n\n";
const std::string kFile = "# AmiraMesh 3D ASCII 2.0" + kHeader +
                          "POINT { float thickness } @5\n\n# Data section follows\n" + kGraph +
                          "@5\n5\n4\n3\n3\n2.5\n2\n3\n1\n";

RawCenterline parse(const std::string& text, const CenterlineReadOptions& options = {}) {
  return parse_centerline(text, centerline_format("t.am"), "t.am", options);
}

std::string with(const std::string& from, const std::string& to, std::string text = kFile) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error(const std::string& text) {
  return message_of<InvalidInput>([&] { parse(text); });
}

void expect_is_the_graph(const RawCenterline& raw) {
  EXPECT_EQ(raw.unit, LengthUnit::um);
  ASSERT_EQ(raw.nodes.size(), 6u);  // four vertices, two points between them
  ASSERT_EQ(raw.segments.size(), 5u);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2, 4}));
  EXPECT_EQ(raw.nodes[raw.segments[1].b].position, Vec3(0, 0, 50));
  EXPECT_EQ(raw.segments[1].b, raw.segments[2].a);
  EXPECT_EQ(raw.segments[1].b, raw.segments[4].a);
  EXPECT_EQ(raw.nodes[raw.segments[2].b].position, Vec3(12, 0, 60));
}

TEST(ReadAmira, ReadsVerticesEdgesAndPointsBetween) {
  const RawCenterline raw = parse(kFile);
  expect_is_the_graph(raw);
  EXPECT_EQ(raw.nodes[raw.segments[0].a].radius, 5);
  EXPECT_EQ(raw.nodes[raw.segments[1].b].radius, 3);
  EXPECT_EQ(raw.nodes[raw.segments[2].b].radius, 2.5);
  EXPECT_EQ(raw.nodes[raw.segments[4].b].radius, 1);
  EXPECT_EQ(raw.name_of_segment(3), "t.am: edge 1");
}

TEST(ReadAmira, TheTransformationMatrixOfTheGraphIsApplied) {
  const auto placed = [](const std::string& matrix) {
    return parse(
        with("    ContentType \"HxSpatialGraph\"",
             "    History {\n LoadCommand \"a } \\\" b\"\n TransformationMatrix 9 0 0 0 0 9 0 0 0 0 9 0 0 0 0 1,\n}\n"
             "    ContentType \"HxSpatialGraph\",\n    TransformationMatrix " +
                 matrix +
                 ",\n"
                 "    &TransformationMatrix \"AAAA=\""));
  };
  // A quarter turn about z, twice the size, and a shift.
  const RawCenterline plain = parse(kFile), moved = placed("0 2 0 0 -2 0 0 0 0 0 2 0 -6895 -3723 7 1");
  ASSERT_EQ(moved.nodes.size(), plain.nodes.size());
  for (std::size_t n = 0; n < plain.nodes.size(); ++n) {
    const Vec3 p = plain.nodes[n].position;
    EXPECT_LT((moved.nodes[n].position - Vec3(-2 * p.y() - 6895, 2 * p.x() - 3723, 2 * p.z() + 7)).norm(), 1e-9);
    EXPECT_NEAR(moved.nodes[n].radius, 2 * plain.nodes[n].radius, 1e-9);
  }
  const auto refusal = [&](const std::string& matrix) { return message_of<InvalidInput>([&] { placed(matrix); }); };
  expect_contains(refusal("1 0 0 0 0 1 0 0 0 0 3 0 0 0 0 1"), "t.am: line 16: the TransformationMatrix skews");
  expect_contains(refusal("1 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1"), "apply the transform in Amira");
  expect_contains(refusal("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1"), "apply the transform in Amira");
  expect_contains(refusal("1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"), "apply the transform in Amira");
  expect_contains(refusal("1 0 0 0"), "has 16 numbers");
  expect_contains(refusal("1 0 0 0 0 one 0 0 0 0 1 0 0 0 0 1"), "\"one\" is not a number");
}

TEST(ReadAmira, UnitsMayBeNanometres) {
  EXPECT_EQ(parse(with("\"um\"", "\"nm\"")).unit, LengthUnit::nm);
  EXPECT_EQ(parse(with("\"um\"", "\"\xB5m\"")).unit, LengthUnit::um);
}

std::string bytes_of(const std::string& numbers, bool floats, bool big) {
  std::string all;
  std::istringstream in(numbers);
  for (double value; in >> value;) {
    const float real = static_cast<float>(value);
    const auto whole = static_cast<std::int32_t>(value);
    std::string one(reinterpret_cast<const char*>(floats ? static_cast<const void*>(&real) : &whole), 4);
    if (big == (std::endian::native == std::endian::little)) std::reverse(one.begin(), one.end());
    all += one;
  }
  return all;
}

std::string binary(const std::string& first_line, bool big) {
  return first_line + kHeader + "VERTEX { byte mark } @7(HxByteRLE,5)\nPOINT { float Diameter } @5\n\n@7\n" +
         std::string("\2\1\x82\3\4") + "\n@1\n" + bytes_of("0 0 0 0 0 50 20 0 80 -20 0 80", true, big) + "\n@2\n" +
         bytes_of("0 1 1 2 1 3", false, big) + "\n@3\n" + bytes_of("3 3 2", false, big) + "\n@4\n" +
         bytes_of("0 0 0 1 0 25 0 0 50 0 0 50 12 0 60 20 0 80 0 0 50 -20 0 80", true, big) + "\n@5\n" +
         bytes_of("10 8 6 6 5 4 6 2", true, big) + "\n";
}

TEST(ReadAmira, ReadsBothBinaryVariants) {
  for (const RawCenterline& raw :
       {parse(binary("# AmiraMesh BINARY-LITTLE-ENDIAN 2.1", false)), parse(binary("# Avizo BINARY 2.0", true))}) {
    expect_is_the_graph(raw);
    EXPECT_EQ(raw.nodes[raw.segments[0].a].radius, 5);
    EXPECT_EQ(raw.nodes[raw.segments[4].b].radius, 1);
  }
}

TEST(ReadAmira, TakesTheRadiusOfEdgesOrOneForAll) {
  const std::string of_edges =
      with("POINT { float thickness }", "EDGE { double mean }", with("@5\n5\n4\n3\n3\n2.5\n2\n3\n1\n", "@5\n5 3 2\n"));
  expect_contains(error(of_edges), "it has mean; name the array with --radius-array");
  CenterlineReadOptions options;
  options.radius_array = "mean";
  const RawCenterline raw = parse(of_edges, options);
  EXPECT_EQ(raw.nodes[raw.segments[0].a].radius, 5);
  EXPECT_EQ(raw.nodes[raw.segments.back().b].radius, 2);
  options = {};
  options.radius = 2;
  for (const CenterlineNode& node : parse(of_edges, options).nodes) EXPECT_EQ(node.radius, 0);  // given later
}

TEST(ReadAmira, NamesTheLineThatIsWrong) {
  expect_contains(error("solid x\n"), "t.am: line 1: this is not an Amira file");
  expect_contains(error(with("1 0 25", "1 O 25")), "\"O\" is not a number");
  expect_contains(error(with("1 0 25\n", "")), "\"@5\" is not a number");
  expect_contains(error(with("@3\n3\n3\n2", "@3\n3\n3\n3")), "edge 2 has more points than there are");
  expect_contains(error(with("@2\n0 1", "@2\n0 4")), "edge 0 runs to a vertex that is not there");
  expect_contains(error(with("define POINT 8", "define POINT 99999999999")), "more than the file can hold");
  expect_contains(error(with("define POINT 8\n", "")), "the header does not \"define\" how many \"point\"");
  expect_contains(error(with("float[3] VertexCoordinates", "quaternion Vertex")),
                  "the type \"quaternion\" is not known");
  expect_contains(error(with("EdgeConnectivity", "Edges")), "no EdgeConnectivity");
  expect_contains(error(with("@5\n5\n", "@6\n5\n")), "\"@6\" is not a place that the header declares");
  expect_contains(error(kFile.substr(0, kFile.find("@4\n0"))), "the data of EdgePointCoordinates are not there");
  expect_contains(message_of<Unsupported>([] { parse(with("thickness } @5", "thickness } @5(HxLzma,9)")); }), "hxlzma");
}

TEST(ReadAmira, EveryCutFileIsRefused) {
  const std::string file = binary("# AmiraMesh BINARY-LITTLE-ENDIAN 2.1", false);
  for (std::size_t size = 1; size + 1 < file.size(); ++size) {
    SCOPED_TRACE(size);
    expect_contains(message_of<Error>([&] { parse(file.substr(0, size)); }), "t.am: ");
  }
}

}  // namespace
}  // namespace vmesh
