// Tubes of ITK-TubeTK.
#include <algorithm>
#include <bit>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

RawCenterline parse(const std::string& text) { return parse_centerline(text, centerline_format("t.tre"), "t.tre"); }

std::string error(const std::string& text) {
  const std::string message = message_of<InvalidInput>([&] { parse(text); });
  expect_contains(message, "t.tre: ");
  return message;
}

const std::string kScene = "ObjectType = Scene\nNDims = 3\nNObjects = 1\n";

std::string tube(const std::string& more, const std::string& points, const std::string& count) {
  return "Comment = a vessel\nObjectType = Tube\nObjectSubType = Vessel\nNDims = 3\n" + more +
         "Root = True\nArtery = True\nPointDim = x y z id R tx\nNPoints = " + count + "\nPoints = \n" + points;
}

std::string floats(std::initializer_list<float> numbers) {
  std::string bytes;
  for (const float number : numbers) {
    const auto word = std::bit_cast<std::uint32_t>(number);
    for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(word >> (8 * byte));
  }
  return bytes;
}

TEST(ReadTubeScene, PointsCountInVoxelsOfTheSpacing) {
  const RawCenterline raw =
      parse(kScene + tube("ID = 1\nParentID = -1\nElementSpacing = 0.5 0.5 2\n", "0 0 0 1 4 0\n0 0 10 2 3 0 \n", "2") +
            "EndGroup = \n");
  ASSERT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(0, 0, 20));
  EXPECT_EQ(raw.nodes[0].radius, 2);
  EXPECT_EQ(raw.nodes[1].radius, 1.5);
  EXPECT_EQ(raw.segments.size(), 1u);
  EXPECT_EQ(raw.unit, LengthUnit::mm);
  EXPECT_EQ(raw.space, Space::lps);
  EXPECT_EQ(raw.name_of_node(1), "t.tre: point 1");
}

TEST(ReadTubeScene, AChildIsJoinedToThePointOfItsParentThatIsNamed) {
  const std::string root = tube("ID = 1\nParentID = -1\n", "0 0 0 1 2 0\n0 0 9 2 2 0\n0 0 18 3 2 0\n", "3");
  const auto with = [&](const std::string& point) {
    return parse(kScene + root +
                 tube("ID = 2\nParentID = 1\nParentPoint = " + point + "\n", "5 0 9 1 1 0\n9 0 9 2 1 0\n", "2"));
  };
  const RawCenterline raw = with("1");
  ASSERT_EQ(raw.segments.size(), 4u);
  EXPECT_EQ(raw.segments[2].a, 1u);
  EXPECT_EQ(raw.segments[2].b, 3u);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2}));
  EXPECT_EQ(with("7").segments.size(), 3u);
  EXPECT_TRUE(with("-1").loose_branches);
}

TEST(ReadTubeScene, TransformationsOfParentsApply) {
  const std::string turn = "TransformMatrix = 0 -1 0 1 0 0 0 0 1\nOffset = 10 20 30\n";
  const std::string child = tube("ID = 2\nParentID = 1\nOffset = 1 0 0\n", "0 0 0 1 2 0\n4 0 0 1 2 0\n", "2");
  const std::string group = "ObjectType = Group\nNDims = 3\nID = 1\nParentID = -1\n" + turn + "EndGroup = \n";
  for (const std::string& text : {kScene + group + child, kScene + child + group}) {
    const RawCenterline raw = parse(text);
    EXPECT_EQ(raw.nodes[0].position, Vec3(10, 21, 30));
    EXPECT_EQ(raw.nodes[1].position, Vec3(10, 25, 30));
  }
  expect_contains(error(kScene + tube("ID = 1\nParentID = 1\n", "0 0 0 1 2 0\n4 0 0 1 2 0\n", "2")),
                  "the object with the ID \"1\" is its own ancestor");
}

TEST(ReadTubeScene, BinaryPointsAreFloats) {
  const std::string points = floats({0, 0, 0, 1, 2, 0, 0, 0, 10, 2, 1.5f, 0});
  const RawCenterline raw = parse(kScene + tube("BinaryData = True\nElementType = MET_FLOAT\n", points, "2") + "\n" +
                                  tube("BinaryData = True\n", points, "2"));
  ASSERT_EQ(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[3].position, Vec3(0, 0, 10));
  EXPECT_EQ(raw.nodes[3].radius, 1.5);
  expect_contains(error(kScene + tube("BinaryData = True\n", points.substr(1), "2")),
                  "the file ends within the points");
  expect_contains(error(kScene + tube("BinaryData = True\nElementType = MET_SHORT\n", points, "2")), "\"MET_SHORT\"");
}

TEST(ReadTubeScene, BinaryPointsMayBeginWithTheirHighByte) {
  std::string points = floats({0, 0, 0, 1, 2, 0, 0, 0, 10, 2, 1.5f, 0});
  for (std::size_t i = 0; i < points.size(); i += 4)
    std::reverse(points.begin() + static_cast<std::ptrdiff_t>(i), points.begin() + static_cast<std::ptrdiff_t>(i + 4));
  for (const char* key : {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}) {
    const RawCenterline raw = parse(kScene + tube("BinaryData = True\n" + std::string(key) + " = True\n", points, "2"));
    EXPECT_EQ(raw.nodes[1].position, Vec3(0, 0, 10));
    EXPECT_EQ(raw.nodes[1].radius, 1.5);
  }
  expect_contains(error(kScene + tube("BinaryData = True\nCompressedData = True\n", points, "2")), "compressed");
}

TEST(ReadTubeScene, PointDimSaysWhereTheNumbersAre) {
  const std::pair<const char*, const char*> variants[] = {
      {"x y z r", "1 2 3 4"},
      {"r x y z", "4 1 2 3"},
      {"id z y x mark R", "7 3 2 1 0 4"},
      {"x y z Radius tx ty tz", "1 2 3 4 0 0 1"},
      {"id x y z red green blue alpha mark r rn mn bn cv lv ro in tx ty tz v1x v1y v1z v2x v2y v2z a1 a2 a3",
       "0 1 2 3 1 0 0 1 0 4 0 0 0 0 0 0 0 0 0 1 0 0 0 0 0 0 0 0 0"}};
  for (const auto& [names, numbers] : variants) {
    const std::string point = numbers;
    const RawCenterline raw = parse(kScene + "ObjectType = Tube\nNDims = 3\nPointDim = " + names +
                                    "\nNPoints = 2\nPoints =\n" + point + "\n" + point + " \n");
    ASSERT_EQ(raw.nodes.size(), 2u) << names;
    EXPECT_EQ(raw.nodes[1].position, Vec3(1, 2, 3)) << names;
    EXPECT_EQ(raw.nodes[1].radius, 4) << names;
  }
}

TEST(ReadTubeScene, SpacingIsAppliedBeforeTheTransformation) {
  const RawCenterline raw =
      parse(kScene + tube("ElementSpacing = .5 .5 2\nTransformMatrix = 0 -3 0 3 0 0 0 0 3\nOffset = 100 0 0\n",
                          "0 0 0 1 4 0\n2 0 10 2 3 0\n", "2"));
  EXPECT_EQ(raw.nodes[0].position, Vec3(100, 0, 0));
  EXPECT_LT((raw.nodes[1].position - Vec3(100, 3, 60)).norm(), 1e-12);
  EXPECT_NEAR(raw.nodes[0].radius, 4 * .5 * 3, 1e-12) << "radii grow with what is around them";
  expect_contains(error(kScene + tube("TransformMatrix = 1 0 0 0 0 0 0 0 1\n", "0 0 0 1 4 0\n2 0 10 2 3 0\n", "2")),
                  "its determinant must not be 0");
}

TEST(ReadTubeScene, SeveralTubesAreAsManyPaths) {
  std::string text = kScene;
  for (int t = 0; t < 7; ++t)
    text += tube("ID = " + std::to_string(t) + "\nOffset = " + std::to_string(20 * t) + " 0 0\n",
                 "0 0 0 1 1 0\n0 0 4 2 1 0\n0 0 8 3 1 0\n", "3");
  const RawCenterline raw = parse(text);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2, 4, 6, 8, 10, 12}));
  EXPECT_EQ(raw.nodes.back().position, Vec3(120, 0, 8));
  EXPECT_TRUE(raw.warnings.empty());
}

TEST(ReadTubeScene, WarnsWhereTheSceneHasFewerObjectsThanItSays) {
  const std::string scene = "ObjectType = Scene\nNDims = 3\nNObjects = 2\n";
  const std::string one = tube("", "0 0 0 1 1 0\n0 0 4 2 1 0\n", "2");
  EXPECT_TRUE(parse(scene + one + one).warnings.empty());
  const RawCenterline raw = parse(scene + one);
  ASSERT_EQ(raw.warnings.size(), 1u);
  expect_contains(raw.warnings[0], "t.tre: NObjects is 2, but only 1 are there; the file may be cut off");
}

TEST(ReadTubeScene, OtherObjectsAreLeftOut) {
  std::string blob = tube("ID = 9\n", "0 0 0 1 2 0\n0 0 4 1 2 0\n", "2");
  blob.replace(blob.find("= Tube"), 6, "= Blob");
  const RawCenterline raw = parse(kScene + blob + tube("", "0 0 0 1 2 0\n4 0 0 1 2 0\n", "2"));
  EXPECT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(4, 0, 0));
  EXPECT_EQ(raw.warnings, std::vector<std::string>{"t.tre: 1 objects are no tubes; left out"});
  expect_contains(error(kScene + blob), "no tube of two points");
}

TEST(ReadTubeScene, NamesTheLineThatIsWrong) {
  const std::string points = "0 0 0 1 2 0\n0 0 4 1 2 0\n";
  const std::string good = kScene + tube("ElementSpacing = 1 1 1\n", points, "2");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error(text.replace(at, from.size(), to));
  };
  EXPECT_EQ(parse(good).nodes.size(), 2u);
  expect_contains(with("ObjectType = Scene\n", ""), "line 1: this is not a scene of tubes");
  expect_contains(with("NObjects = 1", "hello"), "line 3: \"hello\" is no line such as");
  expect_contains(with("id R tx", "id w tx"), "PointDim must name x, y, z and r; it is \"x y z id w tx\"");
  expect_contains(with("= 1 1 1", "= 1 1"), "line 8: ElementSpacing needs 3 numbers");
  expect_contains(with("= 1 1 1", "= 1 1 one"), "\"one\" is not a number");
  expect_contains(with("0 0 4 1", "0 0 four 1"), "line 15: \"four\" is not a number");
  expect_contains(with("NPoints = 2", "NPoints = 3"), "the file ends within the points");
  expect_contains(with("NPoints = 2", "NPoints = 2000000000"), "which the file cannot hold");
  expect_contains(with("NPoints = 2", "NPoints = -2"), "NPoints is \"-2\"");
  expect_contains(with("NDims = 3\nNObjects", "NDims = 2\nNObjects"), "NDims is \"2\"");
}

TEST(ReadTubeScene, AChainOfManyParentsIsPlacedQuickly) {
  std::string text = kScene;
  constexpr int kCount = 100000;
  for (int t = kCount; t > 0; --t)
    text += "ObjectType = Group\nID = " + std::to_string(t) + "\nParentID = " + std::to_string(t - 1) +
            "\nOffset = 1 0 0\n";
  text += tube("ParentID = " + std::to_string(kCount) + "\n", "0 0 0 1 2 0\n0 0 4 1 2 0\n", "2");
  EXPECT_EQ(parse(text).nodes[0].position, Vec3(kCount, 0, 0));
}

}  // namespace
}  // namespace vmesh
