// Tubes of ITK-TubeTK.
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

const std::string kScene = "ObjectType = Scene\nNDims = 3\nNObjects = 2\n";

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
  expect_contains(with("NObjects = 2", "hello"), "line 3: \"hello\" is no line such as");
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
