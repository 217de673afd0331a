#include <numbers>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

const std::string kCurve =
    R"({"@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups",
 "markups": [{"type": "Curve", "coordinateSystem": "RAS", "coordinateUnits": "cm", "controlPoints": [
  {"id": "1", "label": "a", "position": [1.0, 2.0, 3.0], "positionStatus": "defined"},
  {"id": "2", "position": [9.0, 9.0, 9.0], "positionStatus": "undefined"},
  {"id": "3", "position": [1.0, 2.0, 8.0]}],
 "measurements": [{"name": "length", "value": 5},
  {"name": "Radius", "enabled": true, "controlPointValues": [0.5, 7.0, 0.25]}]}]})";

RawCenterline parse(const std::string& text, const CenterlineReadOptions& options = {}) {
  return parse_centerline(text, centerline_format("t.json"), "t.mrk.json", options);
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = kCurve;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string error(const std::string& text) {
  const std::string message = message_of<InvalidInput>([&] { parse(text); });
  expect_contains(message, "t.mrk.json: ");
  return message;
}

TEST(ReadSlicerMarkups, ReadsACurveWithFrameUnitAndRadii) {
  const RawCenterline raw = parse(kCurve);
  EXPECT_EQ(raw.space, Space::ras);
  EXPECT_EQ(raw.unit, LengthUnit::cm);
  ASSERT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(1, 2, 8));
  EXPECT_EQ(raw.nodes[0].radius, 0.5);
  EXPECT_EQ(raw.nodes[1].radius, 0.25);
  ASSERT_EQ(raw.segments.size(), 1u);
  EXPECT_EQ(raw.name_of_node(1), "t.mrk.json: control point 2");
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0}));
  EXPECT_TRUE(raw.loose_branches);
}

TEST(ReadSlicerMarkups, TakesItsDefaultsWhereNothingIsSaid) {
  const RawCenterline raw = parse(with(R"("coordinateSystem": "RAS", "coordinateUnits": "cm",)", ""));
  EXPECT_EQ(raw.space, Space::lps);
  EXPECT_EQ(raw.unit, LengthUnit::mm);
}

TEST(ReadSlicerMarkups, TakesOneRadiusForAllWhereThereIsNone) {
  expect_contains(error(with("Radius", "Torsion")), "--radius");
  CenterlineReadOptions options;
  options.radius = 1.5;
  std::vector<std::string> warnings;
  const RawCenterline raw = convert_read(parse(with("Radius", "Torsion"), options), options, {}, {}, warnings);
  for (const CenterlineNode& node : raw.nodes) EXPECT_EQ(node.radius, 1.5);
  options = {};
  options.radius_array = "torsion";
  EXPECT_EQ(parse(with("Radius", "Torsion"), options).nodes[0].radius, 0.5);
}

TEST(ReadSlicerMarkups, TheUnitOfTheRadiusNeedNotBeThatOfThePositions) {
  const RawCenterline raw = parse(with("\"Radius\",", "\"Radius\", \"units\": \"mm\","));
  EXPECT_EQ(raw.unit, LengthUnit::cm);
  EXPECT_EQ(raw.nodes[1].position, Vec3(1, 2, 8));
  EXPECT_DOUBLE_EQ(raw.nodes[0].radius, 0.05);
  EXPECT_DOUBLE_EQ(raw.nodes[1].radius, 0.025);
  EXPECT_EQ(raw.radius_arrays, std::vector<std::string>{"Radius"});
  EXPECT_EQ(parse(with("\"Radius\",", "\"Radius\", \"units\": \"\",")).nodes[0].radius, 0.5);
  CenterlineReadOptions options;
  options.radius_array = "Section area";
  for (const std::string unit : {"mm2", "mm^2", "mm\xC2\xB2"}) {
    const double radius =
        parse(with("\"Radius\",", "\"Section Area\", \"units\": \"" + unit + "\","), options).nodes[0].radius;
    EXPECT_NEAR(std::numbers::pi * radius * radius, 0.005, 1e-15);  // square centimetres
  }
  expect_contains(error(with("\"Radius\",", "\"Radius\", \"units\": \"furlong\",")),
                  "markups[0], measurement \"radius\": the unit \"furlong\" is not known");
}

TEST(ReadSlicerMarkups, NamesTheElementThatIsWrong) {
  expect_contains(error(with("[1.0, 2.0, 8.0]", "[1.0, 2.0]")), "markups[0].controlPoints[2]: \"position\"");
  expect_contains(error(with("[1.0, 2.0, 8.0]", "[1.0, 2.0, \"x\"]")), "markups[0].controlPoints[2]");
  expect_contains(error(with("0.25]", "\"thin\"]")), "markups[0].controlPoints[2]: its radius is not a number");
  expect_contains(error(with(", 0.25]", "]")), "controlPointValues, one for every point");
  expect_contains(error(with("RAS", "NOWHERE")), "NOWHERE");
  expect_contains(error(with("\"cm\"", "\"furlong\"")), "furlong");
  expect_contains(error(with("\"Curve\"", "\"Fiducial\"")), "no curve");
  expect_contains(error(R"({"markups": 5})"), "must be an array");
}

TEST(ReadSlicerMarkups, IsNotWritten) {
  expect_contains(message_of<Unsupported>([] { centerline_output_format("tree.mrk.json"); }), "read, not written");
  EXPECT_EQ(centerline_output_format("tree.json").name, "JSON");
}

std::string curve_from(const Vec3& a, const Vec3& b, const std::string& unit = "mm") {
  const auto point = [](const Vec3& p) {
    return "{\"position\": [" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) +
           "]}";
  };
  return R"({"markups": [{"type": "Curve", "coordinateSystem": "LPS", "coordinateUnits": ")" + unit +
         R"(", "controlPoints": [)" + point(a) + ", " + point((a + b) / 2) + ", " + point(b) +
         R"(], "measurements": [{"name": "Radius", "controlPointValues": [1, 1, 1]}]}]})";
}

TEST(SeveralFiles, MakeOneTree) {
  const testing::TemporaryFolder folder;
  const std::vector<std::filesystem::path> paths = {
      folder.write("trunk.mrk.json", curve_from({0, 0, 0}, {0, 0, 20})),
      folder.write("left.mrk.json", curve_from({0, 0, 20}, {-9, 0, 30})),
      folder.write("right.mrk.json", curve_from({0.3, 0, 20.2}, {9, 0, 30}))};
  const RawCenterline raw = read_centerline(paths);
  ASSERT_EQ(raw.nodes.size(), 9u);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2, 4}));
  EXPECT_EQ(raw.name_of_node(4), (folder / "left.mrk.json").string() + ": control point 1");
  EXPECT_EQ(raw.name_of_segment(5), (folder / "right.mrk.json").string() + ": curve 0");
  EXPECT_EQ(raw.place_of_node(8), "control point 2 of " + (folder / "right.mrk.json").string());
  const Centerline tree = load_centerline(paths).cleaned.centerline;
  EXPECT_EQ(tree.component_count(), 1u);
  EXPECT_EQ(tree.cycle_rank(), 0u);
  EXPECT_EQ(load_centerline({paths[2], paths[0], paths[1]}).cleaned.centerline.component_count(), 1u);
}

TEST(SeveralFiles, MustAgreeOnTheUnit) {
  const testing::TemporaryFolder folder;
  const std::vector<std::filesystem::path> paths = {folder.write("a.mrk.json", curve_from({0, 0, 0}, {0, 0, 20})),
                                                    folder.write("b.mrk.json", curve_from({0, 0, 2}, {0, 5, 4}, "cm"))};
  const std::string message = message_of<InvalidInput>([&] { read_centerline(paths); });
  expect_contains(message, "b.mrk.json: its unit is cm");
}

TEST(SeveralFiles, OfOtherKindsAreJoinedToo) {
  const testing::TemporaryFolder folder;
  const std::vector<std::filesystem::path> paths = {
      folder.write("a.swc", "# SPACE=LPS\n# UNIT=mm\n1 0 0 0 0 2 -1\n2 0 0 0 20 2 1\n"),
      folder.write("b.mrk.json", curve_from({0, 0, 20.5}, {0, 9, 30}))};
  EXPECT_EQ(load_centerline(paths).cleaned.centerline.component_count(), 1u);
}

TEST(ImplausibleRadii, AreHintedAtUnlessTheUnitIsGiven) {
  const testing::TemporaryFolder folder;
  const auto tree = [&](const std::string& radius, const std::string& tags) {
    return folder.write("a.swc", tags + "1 0 0 0 0 " + radius + " -1\n2 0 0 0 200 " + radius + " 1\n");
  };
  const auto is_hinted_at = [](const std::filesystem::path& path, const CenterlineLoadOptions& options = {}) {
    for (const std::string& warning : load_centerline(path, options).warnings) {
      if (warning.find("radii") != std::string::npos) return warning.find("--unit") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(is_hinted_at(tree("0.04", "")));
  EXPECT_FALSE(is_hinted_at(tree("0.06", "")));
  EXPECT_FALSE(is_hinted_at(tree("39", "")));
  EXPECT_TRUE(is_hinted_at(tree("41", "")));
  EXPECT_TRUE(is_hinted_at(tree("5", "# UNIT=cm\n")));
  EXPECT_FALSE(is_hinted_at(tree("5", "# UNIT=um\n")));
  CenterlineLoadOptions in_micrometres;
  in_micrometres.unit = LengthUnit::um;
  EXPECT_FALSE(is_hinted_at(tree("5", ""), in_micrometres));
}

}  // namespace
}  // namespace vmesh
