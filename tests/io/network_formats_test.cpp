// Formats with a radius per vessel: VascuSynth's GXL and the Secomb group's network.dat.
#include "vmesh/io/centerline_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

std::string node(const std::string& id, const std::string& position) {
  return "<node id=\"" + id +
         "\"><attr name=\" nodeType\"><string> bifurication </string></attr><attr name=\" position\"><tup>" + position +
         "</tup></attr></node>\n";
}

std::string floats(double x, double y, double z) {
  const auto one = [](double v) { return "<float>" + std::to_string(v) + "</float>"; };
  return one(x) + one(y) + one(z);
}

std::string edge(const std::string& from, const std::string& to, const std::string& radius) {
  return "<edge id=\"e\" to=\"" + to + "\" from=\"" + from + "\"><attr name=\" flow\"><float>1</float></attr>" +
         "<attr name=\" radius\"><float> " + radius + " </float></attr></edge>\n";
}

std::string gxl(const std::string& content) {
  return "<gxl><graph id=\"g\" edgeids=\" true\">\n" + content + "</graph></gxl>";
}

const std::string kNodes = node("n0", floats(0, 0, 0)) + node("n1", floats(40, 0, 0)) + node("n2", floats(40, 30, 0)) +
                           node("n3", floats(80, 0, 0));

RawCenterline parse(const std::string& text, const Vec3& voxel = Vec3(0.5, 0.5, 1)) {
  CenterlineReadOptions options;
  options.voxel_size = voxel;
  return parse_centerline(text, centerline_format("t.gxl"), "t.gxl", options);
}

std::string error(const std::string& text) {
  return message_of<InvalidInput>([&] { parse(text); });
}

TEST(ReadGxl, ScalesPositionsByTheVoxelAndKeepsRadiiOfEdges) {
  const RawCenterline raw =
      parse(gxl(kNodes + edge("n0", "n1", "2") + edge("n1", "n2", "1") + edge("n1", "n3", "1.5")));
  ASSERT_GE(raw.nodes.size(), 4u);
  EXPECT_EQ(raw.nodes[1].position, Vec3(20, 0, 0));
  EXPECT_EQ(raw.nodes[2].position, Vec3(20, 15, 0));
  // Ends have the radius of their edge, the node between them that of the two thickest that both have.
  EXPECT_EQ(raw.nodes[0].radius, 2);
  EXPECT_EQ(raw.nodes[2].radius, 1);
  EXPECT_EQ(raw.nodes[3].radius, 1.5);
  EXPECT_EQ(raw.nodes[1].radius, 1.5);
  // The thick edge and the thin one change to their own radius one radius of that node away from it.
  ASSERT_EQ(raw.nodes.size(), 6u);
  EXPECT_EQ(raw.nodes[4].position, Vec3(18.5, 0, 0));
  EXPECT_EQ(raw.nodes[4].radius, 2);
  EXPECT_EQ(raw.nodes[5].position, Vec3(20, 1.5, 0));
  EXPECT_EQ(raw.nodes[5].radius, 1);
  ASSERT_EQ(raw.segments.size(), 5u);
  EXPECT_EQ(raw.name_of_segment(4), "t.gxl: edge 2");
  EXPECT_EQ(raw.name_of_node(5), "t.gxl: node 1");
}

TEST(ReadGxl, AShortEdgeChangesInItsMiddle) {
  const RawCenterline raw =
      parse(gxl(node("a", floats(0, 0, 0)) + node("b", floats(20, 0, 0)) + node("c", floats(40, 0, 0)) +
                node("d", floats(20, 3, 0)) + edge("a", "b", "4") + edge("b", "c", "4") + edge("b", "d", "1")),
            Vec3(1, 1, 1));
  ASSERT_EQ(raw.nodes.size(), 5u);
  EXPECT_EQ(raw.nodes[1].radius, 4);
  EXPECT_EQ(raw.nodes[4].position, Vec3(20, 1.5, 0));
  EXPECT_EQ(raw.nodes[4].radius, 1);
  ASSERT_EQ(raw.segments.size(), 4u);
}

TEST(ReadGxl, NeedsTheVoxelAndNamesWhatIsWrong) {
  const std::string good = gxl(kNodes + edge("n0", "n1", "2"));
  expect_contains(message_of<InvalidInput>([&] { parse_centerline(good, centerline_format("t.gxl"), "t.gxl"); }),
                  "--voxel-size");
  expect_contains(error(gxl(kNodes + edge("n0", "n9", "2"))), "t.gxl: edge 0: there is no node \"n9\"");
  expect_contains(error(gxl(kNodes + edge("n0", "n1", "wide"))), "t.gxl: edge 0: its radius \"wide\"");
  expect_contains(error(gxl(kNodes + node("n1", floats(1, 1, 1)))), "node 4: the id \"n1\" occurs twice");
  expect_contains(error(gxl(node("n0", "<float>1</float>"))), "node 0: its position");
  expect_contains(error(gxl(kNodes)), "no <edge>");
  expect_contains(error("<svg/>"), "not a GXL file");
}

const std::string kNetwork =
    "A network\n550. 550. 230. box dimensions in microns\n32 32 14 number of tissue points\n20. outer bound distance\n"
    "40. max. segment length\n50 maximum number of segments per node\n\n2 total number of segments\n"
    "name type from to diam flow hd\n1 5 11 12 12.5 3 .4\n2 5 12 13 12.5 3 .4\n3 total number of nodes\nname x y z\n"
    "11 0 0 0\n12 100 0 0\n13 150 60 1e1 with more\n1 total number of boundary nodes\nnode bctype press\n11 0 30 .4\n";

std::string network_with(const std::string& from, const std::string& to) {
  std::string text = kNetwork;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ReadNetwork, HalvesDiametersAndKnowsItsUnit) {
  const RawCenterline raw = parse_centerline(kNetwork, centerline_format("t.dat"), "t.dat");
  EXPECT_EQ(raw.unit, LengthUnit::um);
  ASSERT_EQ(raw.nodes.size(), 3u);
  EXPECT_EQ(raw.nodes[2].position, Vec3(150, 60, 10));
  for (const CenterlineNode& n : raw.nodes) EXPECT_EQ(n.radius, 6.25);
  ASSERT_EQ(raw.segments.size(), 2u);
  EXPECT_EQ(raw.segments[1].a, 1u);
  EXPECT_EQ(raw.segments[1].b, 2u);
  EXPECT_EQ(raw.name_of_node(2), "t.dat: line 16");
  EXPECT_EQ(raw.name_of_segment(0), "t.dat: line 10");
}

TEST(ReadNetwork, NamesTheLineThatIsWrong) {
  const auto wrong = [](const std::string& from, const std::string& to) {
    return message_of<InvalidInput>(
        [&] { parse_centerline(network_with(from, to), centerline_format("t.dat"), "t.dat"); });
  };
  expect_contains(wrong("2 5 12 13 12.5", "2 5 12 14 12.5"), "t.dat: line 11: there is no node 14");
  expect_contains(wrong("2 5 12 13 12.5", "2 5 12 13 wide"), "t.dat: line 11: \"wide\" is not a number");
  expect_contains(wrong("12 100 0 0", "11 100 0 0"), "t.dat: line 15: the node 11 occurs twice");
  expect_contains(wrong("2 total number of segments", "many segments"), "t.dat: line 8: \"many\"");
  expect_contains(wrong("3 total number of nodes", "9 total number of nodes"), "t.dat: line 17");
  expect_contains(wrong(kNetwork, "1 2 3\n"), "the file ends where");
}

#if VMESH_WITH_HDF5
// The same networks in other formats, converted elsewhere, in which sections share end points.
TEST(ReadHdf5, NetworksOfMorphIoAreThoseInVtp) {
  VMESH_NEED_SHARED_DATA("microvascular_loops");
  for (const std::string name : {"vasculature1", "vasculature2"}) {
    SCOPED_TRACE(name);
    CenterlineLoadOptions um;
    um.unit = LengthUnit::um;
    const Centerline ours =
        load_centerline(testing::shared_data("microvascular_loops/" + name + ".h5")).cleaned.centerline;
    const Centerline theirs =
        load_centerline(testing::shared_data("microvascular_loops/" + name + ".vtp"), um).cleaned.centerline;
    EXPECT_EQ(ours.nodes().size(), theirs.nodes().size());
    EXPECT_EQ(ours.segments().size(), theirs.segments().size());
    EXPECT_EQ(ours.cycle_rank(), theirs.cycle_rank());
    EXPECT_NEAR(ours.length_in_radii(), theirs.length_in_radii(), 1e-6 * theirs.length_in_radii());
  }
}

TEST(ReadHdf5, DamagedFilesAreRefusedOrRead) {
  VMESH_NEED_SHARED_DATA("microvascular_loops");
  const testing::TemporaryFolder folder;
  const std::string whole = testing::content_of(testing::shared_data("microvascular_loops/vasculature1.h5"));
  for (std::size_t i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    std::string damaged = whole;
    damaged[(i * 7919 + 13) % damaged.size()] = static_cast<char>(i * 31);
    if (i % 4 == 0) damaged.resize(damaged.size() * (i + 1) / 41);
    try {
      EXPECT_FALSE(read_centerline(folder.write("d.h5", damaged)).nodes.empty());
    } catch (const InvalidInput& problem) {
      testing::expect_contains(problem.what(), "d.h5");
    }
  }
}

// A billion points, none of which is in the file.
TEST(ReadHdf5, BelievesNoTableLargerThanItsFile) {
  testing::expect_contains(
      message_of<InvalidInput>([&] { read_centerline(VMESH_FOUND "/h5/a_table_larger_than_its_file.h5"); }),
      "larger than the file can hold");
}
#else
TEST(ReadHdf5, NeedsHdf5) {
  const testing::TemporaryFolder folder;
  testing::expect_contains(testing::message_of<Unsupported>([&] { read_centerline(folder.write("t.h5", "\x89HDF")); }),
                           "VMESH_WITH_HDF5");
}
#endif

}  // namespace
}  // namespace vmesh
