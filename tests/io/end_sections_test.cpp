#include <functional>

#include <nlohmann/json.hpp>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using nlohmann::json;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;

Centerline bent() {
  return {{{{0, 0, 0}, 2}, {{4, 1, 0}, 2}, {{9, 1, 2}, 1.5}, {{9, 7, 2}, 1}}, {{0, 1}, {1, 2}, {2, 3}}};
}

/// A capped end without a ring, and an open one with a ring; numbers that need all their digits.
std::vector<EndSection> sections() {
  const Vec3 normal = Vec3(1, 3, -0.5).normalized(), u = normal.unitOrthogonal(), v = normal.cross(u);
  EndSection capped{0, {0.1, -1.0 / 3, 0}, {-1, 0, 0}, 12.3456789012345, {}, false};
  EndSection open{3, {9, 7 + 1.0 / 7, 2}, normal, 0, {}, true};
  for (int i = 0; i < 7; ++i)
    open.ring.push_back(open.center + std::cos(2 * M_PI * i / 7) * u + 1.2 * std::sin(2 * M_PI * i / 7) * v);
  open.area = 7 / 2.0 * std::sin(2 * M_PI / 7) * 1.2;
  return {capped, open};
}

std::vector<std::string> extensions() {
  std::vector<std::string> result = {".json"};
  result.push_back(".vtp");
  return result;
}

CenterlineLoadOptions as_in_file() {
  CenterlineLoadOptions options;
  options.cleaning.round = options.cleaning.canonical_order = false;
  return options;
}

/// Positive if the ring runs counter-clockwise about the normal.
double turn_of(const EndSection& section) {
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < section.ring.size(); ++i)
    area += (section.ring[i] - section.center).cross(section.ring[(i + 1) % section.ring.size()] - section.center) / 2;
  return area.dot(section.normal);
}

TEST(EndSections, ComeBackToTheLastBit) {
  const TemporaryFolder folder;
  const std::vector<EndSection> given = sections();
  for (const std::string& extension : extensions()) {
    SCOPED_TRACE(extension);
    write_centerline(folder / ("a" + extension), bent(), {}, given);
    const CleanedCenterline cleaned = load_centerline(folder / ("a" + extension), as_in_file()).cleaned;
    EXPECT_TRUE(cleaned.report.actions.empty());
    ASSERT_EQ(cleaned.end_sections.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const EndSection &a = given[i], &b = cleaned.end_sections[i];
      EXPECT_EQ(b.node, a.node);
      EXPECT_EQ(b.center, a.center);
      EXPECT_EQ(b.normal, a.normal);
      EXPECT_EQ(b.area, a.area);
      EXPECT_EQ(b.open, a.open);
      EXPECT_EQ(b.ring, a.ring);
    }
  }
}

TEST(EndSections, AreWrittenInTheUnitAndFrameAskedFor) {
  const TemporaryFolder folder;
  const std::vector<EndSection> given = sections();
  for (const std::string& extension : extensions()) {
    SCOPED_TRACE(extension);
    CenterlineMetadata metadata;
    metadata.unit = LengthUnit::cm;
    metadata.space = Space::ras;
    write_centerline(folder / ("a" + extension), bent(), metadata, given);
    const RawCenterline raw = read_centerline(folder / ("a" + extension));
    ASSERT_EQ(raw.end_sections.size(), 2u);
    const EndSection& open = raw.end_sections[1];
    EXPECT_LT((open.center - Vec3(-0.9, -0.7 - 0.1 / 7, 0.2)).norm(), 1e-15);
    EXPECT_NEAR(open.area, given[1].area / 100, 1e-15);
    EXPECT_NEAR(turn_of(open), open.area, 1e-12);
    const CleanedCenterline cleaned = load_centerline(folder / ("a" + extension), as_in_file()).cleaned;
    ASSERT_EQ(cleaned.end_sections.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const EndSection &a = given[i], &b = cleaned.end_sections[i];
      EXPECT_LT((b.center - a.center).norm(), 1e-14);
      EXPECT_LT((b.normal - a.normal).norm(), 1e-14);
      EXPECT_NEAR(b.area, a.area, 1e-13);
      ASSERT_EQ(b.ring.size(), a.ring.size());
      for (std::size_t p = 0; p < a.ring.size(); ++p) EXPECT_LT((b.ring[p] - a.ring[p]).norm(), 1e-14);
    }
  }
}

TEST(EndSections, AreLeftOutWhereTheFormatHasNoRoom) {
  const TemporaryFolder folder;
  for (const char* name : {"a.swc", "a.csv"}) {
    write_centerline(folder / name, bent(), {}, sections());
    EXPECT_TRUE(load_centerline(folder / name).cleaned.end_sections.empty());
    EXPECT_FALSE(centerline_format(folder / name).keeps_end_sections);
  }
  EXPECT_TRUE(centerline_format("t.json").keeps_end_sections && centerline_format("t.vtp").keeps_end_sections);
  write_centerline(folder / "none.json", bent());
  EXPECT_EQ(testing::content_of(folder / "none.json").find("end_sections"), std::string::npos);
}

TEST(EndSections, ThatAreWrongAreNotWritten) {
  const TemporaryFolder folder;
  const auto message = [&](const std::function<void(EndSection&)>& spoil) {
    std::vector<EndSection> spoilt = sections();
    spoil(spoilt[1]);
    return message_of<InvalidInput>([&] { write_centerline(folder / "a.json", bent(), {}, spoilt); });
  };
  expect_contains(message([](EndSection& s) { s.node = 1; }), "node 1 is no end");
  expect_contains(message([](EndSection& s) { s.node = 4; }), "node 4 is no end");
  expect_contains(message([](EndSection& s) { s.area = 0; }), "area");
  expect_contains(message([](EndSection& s) { s.ring.resize(2); }), "ring");
  EXPECT_EQ(folder.file_count(), 0u);
}

json document() {
  return json::parse(R"({"schema": "vmesh.centerline/1", "unit": "mm", "space": "LPS",
    "nodes": [[0, 0, 0, 2], [5, 0, 0, 2], [9, 0, 0, 2]], "segments": [[0, 1], [1, 2]],
    "end_sections": [{"node": 2, "center": [9, 0, 0], "normal": [2, 0, 0], "area": 12, "open": true,
                      "ring": [[9, 2, 0], [9, -1, 2], [9, -1, -2]]}]})");
}

RawCenterline parse(const json& file) { return parse_centerline(file.dump(), centerline_format("t.json"), "t.json"); }

TEST(EndSections, InJsonMayHaveNormalsOfAnyLengthAndNoRing) {
  json file = document();
  file["end_sections"][0].erase("ring");
  file["end_sections"][0]["note"] = "members of later versions";
  std::vector<std::string> warnings;
  const CleanedCenterline cleaned = clean(convert_to_internal(parse(file), {}, {}, warnings));
  ASSERT_EQ(cleaned.end_sections.size(), 1u);
  EXPECT_EQ(cleaned.end_sections[0].normal, Vec3(1, 0, 0));
  EXPECT_TRUE(cleaned.end_sections[0].ring.empty());
}

TEST(EndSections, InJsonAreRefusedWithWhatIsWrong) {
  const auto message = [](const char* key, const json& value) {
    json file = document();
    file["end_sections"][0][key] = value;
    return message_of<InvalidInput>([&] { parse(file); });
  };
  for (const auto& [key, value, part] : std::vector<std::tuple<const char*, json, const char*>>{
           {"node", 1, "node 1 is no end: it is in 2 segments"},
           {"node", 3, "\"3\" is not a node; the nodes are 0 to 2"},
           {"node", -1, "is not a node"},
           {"node", 1.5, "is not a node"},
           {"node", "2", "is not a node"},
           {"center", {1, 2}, "\"center\": it must be [x, y, z]"},
           {"center", {1, 2, "3"}, "must be a number"},
           {"normal", {0, 0, 0}, "its normal is zero"},
           {"normal", nullptr, "\"normal\": it must be [x, y, z]"},
           {"area", 0, "its area must be greater than 0"},
           {"area", -3, "its area must be greater than 0"},
           {"area", "12", "is not a number"},
           {"open", 1, "neither true nor false"},
           {"ring", {{9, 2, 0}, {9, -1, 2}}, "at least three points"},
           {"ring", json::array(), "at least three points"},
           {"ring", {1, 2, 3}, "\"ring\" point 0: it must be [x, y, z]"},
           {"ring", 7, "\"ring\": it must be an array"}}) {
    SCOPED_TRACE(::testing::Message() << key << " " << value);
    const std::string text = message(key, value);
    expect_contains(text, "t.json: end section 0: ");
    expect_contains(text, part);
  }
  for (const char* key : {"node", "center", "normal", "area", "open"}) {
    json file = document();
    file["end_sections"][0].erase(key);
    expect_contains(message_of<InvalidInput>([&] { parse(file); }), std::string("\"") + key + "\" is missing");
  }
  json file = document();
  file["end_sections"] = 3;
  expect_contains(message_of<InvalidInput>([&] { parse(file); }), "\"end_sections\" must be an array");
  file["end_sections"] = {3};
  expect_contains(message_of<InvalidInput>([&] { parse(file); }), "must be an object");
  const std::string text = document().dump();
  const std::string infinite = std::string(text).replace(text.find("\"area\":12"), 9, "\"area\":1e999");
  EXPECT_THROW(parse_centerline(infinite, centerline_format("t.json"), "t.json"), InvalidInput);
}

std::string field(const std::string& name, const std::string& type, int components, const std::string& numbers) {
  return "<DataArray type=\"" + type + "\" Name=\"EndSection" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + numbers + "</DataArray>";
}

/// A line through points 0, 1 and 3; point 2 belongs to nothing. The end is at point 3.
std::string vtp(const std::string& arrays) {
  return "<VTKFile type=\"PolyData\"><PolyData><FieldData>" + arrays +
         "</FieldData><Piece NumberOfPoints=\"4\" NumberOfLines=\"1\"><PointData><DataArray type=\"Float64\" "
         "Name=\"Radius\">1 1 1 1</DataArray></PointData><Points><DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\">0 0 0 5 0 0 9 9 9 9 0 0</DataArray></Points><Lines><DataArray type=\"Int64\" "
         "Name=\"connectivity\">0 1 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\">3</DataArray></Lines>"
         "</Piece></PolyData></VTKFile>";
}

std::string flat_end(const std::string& node = "3", const std::string& offsets = "0 3",
                     const std::string& normal = "1 0 0", const std::string& area = "3") {
  return field("Node", "Int32", 1, node) + field("Center", "Float64", 3, "9 0 0") +
         field("Normal", "Float32", 3, normal) + field("Area", "Float64", 1, area) + field("Open", "UInt8", 1, "1") +
         field("Ring", "Float64", 3, "9 1 0 9 -1 1 9 -1 -1") + field("RingOffsets", "Int64", 1, offsets);
}

TEST(EndSections, InVtpReferToPoints) {
  const RawCenterline raw = parse_centerline(vtp(flat_end()), centerline_format("t.vtp"), "t.vtp");
  ASSERT_EQ(raw.end_sections.size(), 1u);
  const EndSection& section = raw.end_sections[0];
  EXPECT_EQ(raw.nodes[section.node].position, Vec3(9, 0, 0));
  EXPECT_TRUE(section.open);
  ASSERT_EQ(section.ring.size(), 3u);
  EXPECT_EQ(section.ring[1], Vec3(9, -1, 1));
}

TEST(EndSections, InVtpAreRefusedWithWhatIsWrong) {
  const auto message = [](const std::string& arrays) {
    return message_of<InvalidInput>([&] { parse_centerline(vtp(arrays), centerline_format("t.vtp"), "t.vtp"); });
  };
  expect_contains(message(flat_end("2")), "there is no point 2 with a line");
  expect_contains(message(flat_end("-1")), "there is no point -1");
  expect_contains(message(flat_end("3 0")), "EndSectionCenter: it holds 3 numbers, there should be 6");
  expect_contains(message(flat_end("3", "0 2")), "EndSectionRingOffsets");
  expect_contains(message(flat_end("3", "3 0")), "EndSectionRingOffsets");
  expect_contains(message(flat_end("3", "0 3", "0 0 0")), "normal is zero");
  expect_contains(message(flat_end("3", "0 3", "1 0 nan")), "not finite");
  expect_contains(message(flat_end("3", "0 3", "1 0 0", "-1")), "area must be greater than 0");
  expect_contains(message(field("Node", "Int32", 1, "3")), "EndSectionCenter");
}

TEST(EndSections, InLegacyVtkAreReadLikewise) {
  const std::string file =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nFIELD FieldData 5\nEndSectionNode 1 1 int\n2\n"
      "EndSectionCenter 3 1 double\n9 0 0\nEndSectionNormal 3 1 double\n1 0 0\nEndSectionArea 1 1 double\n3\n"
      "EndSectionOpen 1 1 int\n0\nPOINTS 3 double\n0 0 0 5 0 0 9 0 0\nLINES 1 4\n3 0 1 2\nPOINT_DATA 3\n"
      "SCALARS Radius double\nLOOKUP_TABLE default\n1 1 1\n";
  const RawCenterline raw = parse_centerline(file, centerline_format("t.vtk"), "t.vtk");
  ASSERT_EQ(raw.end_sections.size(), 1u);
  EXPECT_EQ(raw.end_sections[0].node, 2u);
  EXPECT_FALSE(raw.end_sections[0].open);
}

}  // namespace
}  // namespace vmesh
