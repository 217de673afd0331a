#include <cmath>
#include <numbers>
#include <sstream>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;

RawCenterline swc(const std::string& text) { return parse_centerline(text, centerline_format("t.swc"), "t.swc"); }
RawCenterline json(const std::string& text) { return parse_centerline(text, centerline_format("t.json"), "t.json"); }
std::string swc_error(const std::string& text) {
  return message_of<InvalidInput>([&] { swc(text); });
}
std::string json_error(const std::string& text) {
  return message_of<InvalidInput>([&] { json(text); });
}
const std::string kJsonHead = R"({"schema":"vmesh.centerline/1",)";

TEST(ReadSwc, TakesTheUsualTraps) {
  const auto raw =
      swc("\xEF\xBB\xBF# made by hand, UNIT=um\r\n"
          "\r\n"
          "10.0\t3\t 1.5 2 +3 0.5\t7 # its parent comes later\r\n"
          "  7 1 0 0 0 1e0 -1\r\n"
          "3 3 -1E1 .5 0 0 7.0\r\n"
          "8 0 5 5 5 2 -1");
  ASSERT_EQ(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[0].position, Vec3(1.5, 2, 3));
  EXPECT_EQ(raw.nodes[2].position, Vec3(-10, 0.5, 0));
  EXPECT_EQ(raw.nodes[2].radius, 0);
  ASSERT_EQ(raw.segments.size(), 2u);
  EXPECT_EQ(raw.segments[0].a, 1u);
  EXPECT_EQ(raw.segments[0].b, 0u);
  EXPECT_EQ(raw.segments[1].b, 2u);
  EXPECT_EQ(raw.unit, LengthUnit::um);
  EXPECT_EQ(raw.space, Space::unknown);
  EXPECT_EQ(raw.name_of_node(0), "t.swc: line 3");
  EXPECT_EQ(raw.name_of_segment(1), "t.swc: line 5");
}

TEST(ReadSwc, IsIndependentOfTheLocale) {
  const std::locale before = std::locale();
  class Comma : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  std::locale::global(std::locale(before, new Comma));
  const auto raw = swc("1 1 0.25 0 0 1.5 -1\n");
  std::locale::global(before);
  EXPECT_EQ(raw.nodes[0].position.x(), 0.25);
  EXPECT_EQ(raw.nodes[0].radius, 1.5);
}

TEST(ReadSwc, NamesTheLineThatIsWrong) {
  expect_contains(swc_error("# c\n1 1 0 0 0 1\n"), "t.swc: line 2");
  expect_contains(swc_error("1 1 0 0 zero 1 -1\n"), "line 1: the z \"zero\"");
  expect_contains(swc_error("1.5 1 0 0 0 1 -1\n"), "line 1: the id");
  expect_contains(swc_error("1 1 0,5 0 0 1 -1\n"), "line 1: the x");
  expect_contains(swc_error("1 1 0 0 0 1 -1\n2 1 0 0 1 1 9\n"), "line 2: its parent 9");
  expect_contains(swc_error("1 1 0 0 0 1 -1\n1 1 0 0 1 1 1\n"), "line 2: the id 1");
  expect_contains(swc_error("1 1 0 0 0 1 -1\n1 1 0 0 1 1 1\n"), "in line 1");
  expect_contains(swc_error("1 1 0 0 0 1 1\n"), "line 1: this sample is its own ancestor");
  expect_contains(swc_error("1 1 0 0 0 1 -1\n2 1 0 0 0 1 4\n3 1 0 0 0 1 2\n4 1 0 0 0 1 3\n"), "its own ancestor");
  expect_contains(swc_error("# nothing\n\n"), "no sample");
}

TEST(ReadSwc, LeavesNonFiniteNumbersToCleaningWhichNamesTheLine) {
  for (const std::string bad : {"nan", "inf", "-inf", "1e999"}) {
    auto raw = swc("1 1 0 0 0 1 -1\n2 1 " + bad + " 0 0 1 1\n");
    EXPECT_FALSE(std::isfinite(raw.nodes[1].position.x())) << bad;
    std::vector<std::string> warnings;
    raw = convert_to_internal(std::move(raw), LengthUnit::mm, Space::lps, warnings);
    expect_contains(message_of<InvalidInput>([&] { clean(raw); }), "t.swc: line 2");
  }
}

TEST(ReadSwc, SaysWhatItIgnores) {
  const auto raw = swc("1 1 0 0 0 1 -1 77\n2 1 0 0 1 1 -5\n");
  EXPECT_EQ(raw.warnings.size(), 2u);
  EXPECT_TRUE(raw.segments.empty());
}

TEST(ReadSwc, IdsMayBeOf64BitsNegativeOrText) {
  const auto raw =
      swc("720575940590515268 0 0 0 0 3 -1\n720575940590515269 0 1 0 0 3 720575940590515268\n"
          "18446744073709551615 0 2 0 0 3 720575940590515269\n-7 0 3 0 0 3 18446744073709551615\n"
          "tip 0 4 0 0 3 -07\nnext 0 5 0 0 3 tip\n");
  ASSERT_EQ(raw.segments.size(), 5u);
  for (Index s = 0; s < 5; ++s) {
    EXPECT_EQ(raw.segments[s].a, s);
    EXPECT_EQ(raw.segments[s].b, s + 1);
  }
  EXPECT_TRUE(raw.warnings.empty());
  expect_contains(swc_error("1 1 0 0 0 1 -1\n-1 1 0 0 1 1 1\n"), "line 2: the id -1 means \"no parent\"");
  expect_contains(swc_error("1 1 0 0 0 1 -1\n2 1 0 0 1 1 tip\n"), "line 2: its parent tip is not in the file");
}

TEST(ReadSwc, AParent0MakesARootUnlessThereIsASample0) {
  const auto raw = swc("1 1 0 0 0 1 0\n2 1 0 0 1 1 1\n");
  EXPECT_EQ(raw.segments.size(), 1u);
  ASSERT_EQ(raw.warnings.size(), 1u);
  expect_contains(raw.warnings[0], "1 samples have the parent 0");
  EXPECT_EQ(swc("0 1 0 0 0 1 -1\n2 1 0 0 1 1 0\n3 1 0 0 2 1 2\n").segments.size(), 2u);
}

TEST(ReadSwc, NumbersInVoxelsNeedTheSideOfOne) {
  const std::string text = "1 1 0 2 4 3 -1\n2 1 0 2 6 3 1\n";
  CenterlineReadOptions options;
  options.voxel_size = Vec3(0.5, 0.5, 0.5);
  const auto read = [&](const std::string& content) {
    return parse_centerline(content, centerline_format("t.swc"), "t.swc", options);
  };
  for (const std::string head : {"", "# UNIT=voxels\n"}) {
    const auto raw = read(head + text);
    EXPECT_EQ(raw.nodes[1].position, Vec3(0, 1, 3));
    EXPECT_EQ(raw.nodes[1].radius, 1.5);
    EXPECT_EQ(raw.unit, LengthUnit::unknown);
  }
  expect_contains(swc_error("# UNIT=voxels\n" + text), "line 1: the numbers are in voxels; give the side");
  options.voxel_size = Vec3(0.5, 0.5, 1);
  expect_contains(message_of<InvalidInput>([&] { read(text); }), "t.swc: radii in voxels need voxels of equal sides");
}

TEST(ReadSwc, NanometresAreKnown) {
  std::vector<std::string> warnings;
  auto raw = convert_read(swc("# UNIT=nm SPACE=LPS\n1 1 3000000 0 0 7000 -1\n"), {}, {}, {}, warnings);
  EXPECT_EQ(raw.nodes[0].position.x(), 3);
  EXPECT_EQ(raw.nodes[0].radius, 0.007);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(json(kJsonHead + R"("unit":"nm","nodes":[[0,0,0,1],[0,0,5,1]],"segments":[[0,1]]})").unit, LengthUnit::nm);
}

TEST(ReadSwc, Utf16IsRefusedByName) {
  expect_contains(swc_error(std::string("\xFF\xFE\x31\0 \0", 6)), "UTF-16; save it as UTF-8");
}

TEST(ReadSwc, AMillionNodesThatEndInALoopAreRefusedQuickly) {
  std::string text = "1 1 0 0 0 1 1000000\n";
  for (int i = 2; i <= 1000000; ++i)
    text += std::to_string(i) + " 3 0 0 " + std::to_string(i) + " 1 " + std::to_string(i - 1) + "\n";
  expect_contains(swc_error(text), "its own ancestor");
}

TEST(ReadSwc, SurvivesALineOfManyMegabytes) {
  expect_contains(swc_error(std::string(8 << 20, '1') + "\n"), "line 1");
  EXPECT_EQ(swc("#" + std::string(8 << 20, 'x') + "\n1 1 0 0 0 1 -1\n").nodes.size(), 1u);
}

TEST(ReadJson, ReadsOurSchema) {
  const auto raw =
      json(kJsonHead + R"("space":"RAS","unit":"cm","nodes":[[0,1,2,3],[4,5e-1,6,7]],"segments":[[1,0]],"more":1})");
  ASSERT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(4, 0.5, 6));
  EXPECT_EQ(raw.nodes[1].radius, 7);
  EXPECT_EQ(raw.segments[0].a, 1u);
  EXPECT_EQ(raw.unit, LengthUnit::cm);
  EXPECT_EQ(raw.space, Space::ras);
}

TEST(ReadJson, NamesTheEntryThatIsWrong) {
  expect_contains(json_error("{"), "t.json");
  expect_contains(json_error("[]"), "t.json");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,0,1],[0,0,1]],"segments":[]})"), "node 1");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,null,1]],"segments":[]})"), "node 0");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,1e999,1]],"segments":[]})"), "t.json");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,0,1]],"segments":[[0,1]]})"), "segment 0");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,0,1]],"segments":[[0,-1]]})"), "segment 0");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,0,1]],"segments":[[0,0.5]]})"), "segment 0");
  expect_contains(json_error(kJsonHead + R"("nodes":[[0,0,0,1]]})"), "\"segments\"");
  expect_contains(json_error(kJsonHead + R"("unit":"furlong","nodes":[],"segments":[]})"), "furlong");
  expect_contains(message_of<Unsupported>([] { json(R"({"schema":"vmesh.centerline/9"})"); }), "vmesh.centerline/1");
}

TEST(ReadJson, SurvivesDeepNesting) {
  expect_contains(json_error(std::string(1000000, '[')), "t.json");
  expect_contains(json_error(std::string(1000000, '[') + std::string(1000000, ']')), "t.json");
  // In the place of a node's index, where the message would cite it.
  expect_contains(json_error(R"({"schema": "vmesh.centerline/1", "nodes": [[0, 0, 0, 1]], "segments": [[0, )" +
                             std::string(1000000, '[') + std::string(1000000, ']') + "]]}"),
                  "brackets");
}

TEST(ReadJson, ALoopOfAMillionNodesIsALoop) {
  std::string nodes, segments;
  constexpr int kCount = 1000000;
  for (int i = 0; i < kCount; ++i) {
    nodes += (i ? ",[" : "[") + std::to_string(i % 1000) + "," + std::to_string(i / 1000) + ",0,0.1]";
    segments += (i ? ",[" : "[") + std::to_string(i) + "," + std::to_string((i + 1) % kCount) + "]";
  }
  std::vector<std::string> warnings;
  const auto raw = convert_to_internal(json(kJsonHead + "\"nodes\":[" + nodes + "],\"segments\":[" + segments + "]}"),
                                       {}, {}, warnings);
  const auto result = clean(raw);
  EXPECT_EQ(result.centerline.cycle_rank(), 1u);
}

TEST(ReadCsv, ReadsAPairOfFiles) {
  const TemporaryFolder folder;
  folder.write("t.segments.csv", "a,b\n7,3\n");
  const auto path = folder.write("t.csv", "# SPACE=LPS UNIT=mm\nRadius, z,y,x,id\n\n1.5,3,2,1,7\n2.5,6,5,4,3\n");
  const auto raw = read_centerline(path);
  ASSERT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(4, 5, 6));
  EXPECT_EQ(raw.nodes[0].radius, 1.5);
  EXPECT_EQ(raw.segments[0].a, 0u);
  EXPECT_EQ(raw.segments[0].b, 1u);
  EXPECT_EQ(raw.unit, LengthUnit::mm);
  EXPECT_EQ(csv_segments_path("d/t.nodes.csv"), "d/t.segments.csv");
  EXPECT_EQ(csv_segments_path("d/t.csv"), "d/t.segments.csv");
}

RawCenterline csv(const std::string& nodes, const std::string& segments) {
  return parse_centerline(nodes, centerline_format("t.csv"), "t.csv", {}, segments);
}

TEST(ReadCsv, ReadsWhatSpreadsheetsWriteWhereTheCommaIsDecimal) {
  for (const std::string separator : {";", "\t"}) {
    SCOPED_TRACE(separator);
    const auto row = [&](std::string line) {
      for (std::size_t at = 0; (at = line.find('|', at)) != std::string::npos;) line.replace(at, 1, separator);
      return line + "\r\n";
    };
    const auto raw = csv("\xEF\xBB\xBF" + row("# UNIT=um||||") + row("id|x|y|\"z\"|radius|\"a note\"") +
                             row("7|0,5|-1,25e1|3|1,5|\"has | in it\"") + row("3|1.5|0|4|\"2,5\"|") + row("|||||"),
                         row("a|b") + row("7|3") + row("|"));
    ASSERT_EQ(raw.nodes.size(), 2u);
    EXPECT_EQ(raw.nodes[0].position, Vec3(0.5, -12.5, 3));
    EXPECT_EQ(raw.nodes[0].radius, 1.5);
    EXPECT_EQ(raw.nodes[1].position, Vec3(1.5, 0, 4));
    EXPECT_EQ(raw.nodes[1].radius, 2.5);
    EXPECT_EQ(raw.segments.size(), 1u);
    EXPECT_EQ(raw.unit, LengthUnit::um);
  }
}

TEST(ReadCsv, RefusesNumbersWithSeparatorsOfThousandsAndUtf16) {
  const auto error = [](const std::string& nodes) { return message_of<InvalidInput>([&] { csv(nodes, "a;b\n"); }); };
  for (const std::string number : {"1.234,5", "1,234,567"})
    expect_contains(error("id;x;y;z;radius\n1;" + number + ";0;0;1\n"), "t.csv: line 2: \"" + number + "\"");
  expect_contains(error("id,x,y,z,radius\n1,\"1,234\",0,0,1\n"), "t.csv: line 2: \"1,234\" is not a number");
  expect_contains(error(std::string("\xFF\xFEi\0d\0", 6)), "t.csv: line 1: this is text in UTF-16");
  expect_contains(error(std::string("\0i\0d", 4)), "UTF-16; save it as UTF-8");
}

TEST(ReadCsv, IdsMayBeOf64BitsNegativeOrText) {
  const auto raw =
      csv("id,x,y,z,radius\n720575940590515268,0,0,0,1\n720575940590515269,1,0,0,1\n-4,2,0,0,1\nroot,3,0,0,1\n",
          "a,b\n720575940590515268,720575940590515269\n720575940590515269,-4.0\n-4,root\n");
  ASSERT_EQ(raw.segments.size(), 3u);
  for (Index s = 0; s < 3; ++s) {
    EXPECT_EQ(raw.segments[s].a, s);
    EXPECT_EQ(raw.segments[s].b, s + 1);
  }
  expect_contains(message_of<InvalidInput>([] { csv("id,x,y,z,radius\n1.5,0,0,0,1\n", "a,b\n"); }),
                  "line 2: \"1.5\" is not an id");
}

TEST(ReadCsv, TakesTheRadiusFromTheColumnThatIsNamed) {
  const auto read = [](const std::string& column, const std::string& name, std::optional<double> radius = {}) {
    CenterlineReadOptions options;
    options.radius_array = name;
    options.radius = radius;
    return parse_centerline("id,x,y,z," + column + "\n1,0,0,0,4\n2,0,0,1,4\n", centerline_format("t.csv"), "t.csv",
                            options, "a,b\n1,2\n");
  };
  EXPECT_EQ(read("Thick", "thick").nodes[1].radius, 4);
  EXPECT_EQ(read("Thick", "thick").radius_arrays, std::vector<std::string>{"thick"});
  EXPECT_EQ(read("diameter", "diameter").nodes[1].radius, 2);
  expect_contains(read("diameter", "diameter").warnings.back(), "t.csv: radii are half of \"diameter\"");
  EXPECT_NEAR(read("Area", "").nodes[1].radius, std::sqrt(4 / std::numbers::pi), 1e-15);
  expect_contains(read("Area", "").warnings.back(), "circles of the area \"area\"");
  EXPECT_EQ(read("note", "", 3).nodes[1].radius, 0);  // which convert_read() replaces
  expect_contains(message_of<InvalidInput>([&] { read("diameter", ""); }), "t.csv: line 1: there is no column radius");
  expect_contains(message_of<InvalidInput>([&] { read("radius", "width"); }), "there is no column width");
  expect_contains(message_of<InvalidInput>([&] { read("radius", "width"); }), "--radius-array");
}

TEST(ReadCsv, NamesFileAndLineThatAreWrong) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& nodes, const std::string& segments) {
    folder.write("t.segments.csv", segments);
    return message_of<InvalidInput>([&] { read_centerline(folder.write("t.csv", nodes)); });
  };
  expect_contains(error("id,x,y,z\n", "a,b\n"), "no column radius");
  expect_contains(error("id,x,y,z,radius\n1,2,3\n", "a,b\n"), "t.csv: line 2");
  expect_contains(error("id,x,y,z,radius\n1,2,3,4,five\n", "a,b\n"), "line 2: \"five\"");
  expect_contains(error("id,x,y,z,radius\n1,2,3,4,5\n1,2,3,4,5\n", "a,b\n"), "line 3: the id 1");
  expect_contains(error("id,x,y,z,radius\n1,2,3,4,5\n", "a,b\n1,2\n"), "t.segments.csv: line 2");
  std::filesystem::remove(folder / "t.segments.csv");
  expect_contains(message_of<ReadError>([&] { read_centerline(folder / "t.csv"); }), "t.segments.csv");
  folder.write("t.segments.csv", "a,b\n");
  expect_contains(message_of<InvalidInput>([&] { read_centerline(folder / "t.segments.csv"); }), "nodes");
}

TEST(ReadCsv, ReadsNodesAndEdgesOfVoreen) {
  const TemporaryFolder folder;
  const std::string edges =
      "id;node1id;node2id;length;avgRadiusAvg;num_voxels\n0;0;1;20.5;2.5;7\n1;1;2;9;1.5;7\n2;1;3;9;-1;0\n";
  folder.write("brain_edges.csv", edges);
  const auto path =
      folder.write("brain_nodes.csv",
                   "id;pos_x;pos_y;pos_z;degree;isAtSampleBorder\n0;0;0;0;1;1\n1;0;0;20;3;0\n2;9;0;20;1;0\n"
                   "3;-9;0;20.5;1;0\n");
  const auto raw = read_centerline(path);
  ASSERT_GE(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[3].position, Vec3(-9, 0, 20.5));
  EXPECT_EQ(raw.nodes[0].radius, 2.5);
  EXPECT_EQ(raw.nodes[1].radius, 1.5);
  EXPECT_EQ(raw.nodes[3].radius, 0);  // taken from its neighbours when it is cleaned
  EXPECT_EQ(raw.radius_arrays, std::vector<std::string>{"avgRadiusAvg"});
  expect_contains(raw.warnings.at(0), "1 segments have the radius -1");
  EXPECT_EQ(load_centerline(path).cleaned.centerline.component_count(), 1u);
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string changed = edges;
    folder.write("brain_edges.csv", changed.replace(changed.find(from), from.size(), to));
    return message_of<InvalidInput>([&] { read_centerline(path); });
  };
  expect_contains(error(";1.5;", ";-2;"), "brain_edges.csv: line 3: \"-2\" is not a radius");
  expect_contains(error(";1;2;", ";1;7;"), "brain_edges.csv: line 3: there is no node with the id 7");
  expect_contains(error("node2id", "other"), "there is no column");
  expect_contains(error("avgRadiusAvg", "other"), "brain_nodes.csv: line 1: there is no column radius");
  folder.write("brain_nodes.segments.csv", "a,b\n0,1\n");
  expect_contains(message_of<InvalidInput>([&] { read_centerline(path); }), "no column radius");  // ours is read
}

RawCenterline obj(const std::string& text) {
  CenterlineReadOptions options;
  options.radius = 1;
  return parse_centerline(text, centerline_format("t.obj"), "t.obj", options);
}

TEST(ReadObjOfLines, ReadsPolylines) {
  const auto raw = obj("# UNIT=um\nl 1 2 3\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 5 0\nl -3/1 -1/2\n");
  EXPECT_EQ(raw.unit, LengthUnit::um);
  ASSERT_EQ(raw.nodes.size(), 4u);
  ASSERT_EQ(raw.segments.size(), 3u);
  EXPECT_EQ(raw.nodes[raw.segments[0].b].position, Vec3(1, 0, 0));
  EXPECT_EQ(raw.nodes[raw.segments[1].b].position, Vec3(2, 0, 0));
  EXPECT_EQ(raw.nodes[raw.segments[2].a].position, Vec3(1, 0, 0));
  EXPECT_EQ(raw.nodes[raw.segments[2].b].position, Vec3(2, 5, 0));
  EXPECT_EQ(raw.name_of_segment(2), "t.obj: line cell 1");
}

TEST(ReadObjOfLines, NamesWhatIsWrong) {
  const auto error = [](const std::string& text) { return message_of<InvalidInput>([&] { obj(text); }); };
  expect_contains(error("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nf 1 2 3\n"), "t.obj: line 5: it has faces");
  expect_contains(error("v 0 0 0\nl 1 2\n"), "t.obj: line 2: there is no vertex 2");
  expect_contains(error("v 0 0 0\nl 1 zero\n"), "t.obj: line 2: \"zero\" is not a vertex index");
  expect_contains(error("v 0 0 0\n"), "contains no line");
  expect_contains(message_of<InvalidInput>(
                      [] { parse_centerline("v 0 0 0\nv 1 0 0\nl 1 2\n", centerline_format("t.obj"), "t.obj"); }),
                  "--radius");
}

std::string ply_of_edges(const std::string& edges,
                         const std::string& ends = "property int vertex1\nproperty int vertex2\n") {
  return "ply\nformat ascii 1.0\ncomment UNIT=mm\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty float radius\nelement edge 2\n" +
         ends +
         "end_header\n"
         "0 0 0 3\n5 0 0 2\n9 0 0 1\n" +
         edges;
}

RawCenterline ply(const std::string& text) { return parse_centerline(text, centerline_format("t.ply"), "t.ply"); }

TEST(ReadPlyOfEdges, ReadsVerticesWithRadiiAndEdges) {
  const auto raw = ply(ply_of_edges("0 1\n1 2\n"));
  EXPECT_EQ(raw.unit, LengthUnit::mm);
  ASSERT_EQ(raw.segments.size(), 2u);
  EXPECT_EQ(raw.nodes[raw.segments[1].b].position, Vec3(9, 0, 0));
  EXPECT_EQ(raw.nodes[raw.segments[1].b].radius, 1);
}

TEST(ReadPlyOfEdges, NamesWhatIsWrong) {
  const auto error = [](const std::string& text) { return message_of<InvalidInput>([&] { ply(text); }); };
  expect_contains(error(ply_of_edges("0 1\n1 3\n")), "t.ply: edge 1: it runs to a vertex that is not there");
  expect_contains(error(ply_of_edges("0 1\n1 -1\n")), "t.ply: edge 1");
  expect_contains(error(ply_of_edges("0 1\n2\n")), "t.ply: edge 1: the file ends here");
  expect_contains(error(ply_of_edges("0 1\n1 2\n", "property int a\nproperty int b\n")), "vertex1 and vertex2");
  expect_contains(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement face 1\n"
                        "property list uchar int vertex_indices\nend_header\n0 3 0 0 0\n"),
                  "this is a surface");
  expect_contains(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n"), "no edges");
}

TEST(ReadCenterline, SaysWhenThereIsNothingToRead) {
  const TemporaryFolder folder;
  expect_contains(message_of<ReadError>([&] { read_centerline(folder / "none.swc"); }), "none.swc");
  std::filesystem::create_directory(folder / "sub.swc");
  expect_contains(message_of<ReadError>([&] { read_centerline(folder / "sub.swc"); }), "folder");
  for (const std::string name : {"e.swc", "e.json", "e.csv", "e.vtp"}) {
    folder.write("e.segments.csv", "");
    expect_contains(message_of<InvalidInput>([&] { read_centerline(folder.write(name, "")); }), name);
  }
  expect_contains(message_of<Unsupported>([&] { read_centerline(folder / "a.nope"); }), ".vtp");
  expect_contains(message_of<Unsupported>([&] { read_centerline(folder / "a"); }), ".swc");
}

TEST(ReadCenterline, ReadsFromAStream) {
  std::istringstream in("1 1 0 0 0 1 -1\n");
  EXPECT_EQ(read_centerline(in, centerline_format("t.swc"), "stdin").nodes.size(), 1u);
  std::istringstream empty;
  expect_contains(message_of<InvalidInput>([&] { read_centerline(empty, centerline_format("t.swc"), "stdin"); }),
                  "stdin");
}

}  // namespace
}  // namespace vmesh
