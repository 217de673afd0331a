#include "vmesh/io/centerline_io.h"

#include "io_support.h"
#include "shared_data.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

/// A loop of three strands that share their end vertices, and a side branch; line numbers matter to the tests.
const std::string kLoop =
    "$PARAM_BEGIN\n"           // 1
    "NUM_VERTS\t6\n"           // 2
    "NUM_STRANDS\t3\n"         // 3
    "NUM_ATTRIB_PER_VERT 4\n"  // 4
    "$PARAM_END\n"             // 5
    "\n"                       // 6
    "$VERT_LIST_BEGIN\n"       // 7
    "1\t0\t0\t0\t1.5\n"        // 8
    "2\t10\t0\t0\t1\n"         // 9
    "3\t20\t0\t0\t1\n"         // 10
    "4\t10\t10\t0\t0.5\n"      // 11
    "5\t30\t1e1\t-.5\t+2\n"    // 12
    "6\t40\t0\t0\t1\n"         // 13
    "$VERT_LIST_END\n"         // 14
    "\n"                       // 15
    "$STRANDS_LIST_BEGIN\n"    // 16
    "1 1 2 3 \n"               // 17
    "2 1 4 3 \n"               // 18
    "3 3 5 6 \n"               // 19
    "$STRANDS_LIST_END\n";     // 20

RawCenterline parse(const std::string& text) { return parse_centerline(text, centerline_format("t.vmv"), "t.vmv"); }

std::string error(const std::string& text) {
  const std::string message = message_of<InvalidInput>([&] { parse(text); });
  expect_contains(message, "t.vmv: line ");
  return message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// kLoop with `from` replaced.
std::string with(const std::string& from, const std::string& to) { return replaced(kLoop, from, to); }

std::string with_every(const std::string& from, const std::string& to) {
  std::string text = kLoop;
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

void expect_is_loop(const RawCenterline& raw) {
  ASSERT_EQ(raw.nodes.size(), 6u);
  ASSERT_EQ(raw.segments.size(), 6u);
  EXPECT_EQ(raw.nodes[4].position, Vec3(30, 10, -0.5));
  EXPECT_EQ(raw.nodes[4].radius, 2);
  EXPECT_EQ(raw.path_starts, (std::vector<Index>{0, 2, 4}));
  EXPECT_EQ(raw.segments[3].a, 3u);
  EXPECT_EQ(raw.segments[3].b, 2u);
}

TEST(ReadVmv, ReadsVerticesAndStrands) {
  const auto raw = parse(kLoop);
  expect_is_loop(raw);
  EXPECT_TRUE(raw.warnings.empty());
  EXPECT_EQ(raw.unit, LengthUnit::unknown);
  EXPECT_EQ(raw.space, Space::unknown);
  EXPECT_EQ(raw.name_of_node(4), "t.vmv: line 12");
  EXPECT_EQ(raw.name_of_segment(5), "t.vmv: line 19");
}

TEST(ReadVmv, KeepsLoops) {
  std::vector<std::string> warnings;
  const auto cleaned = clean(convert_to_internal(parse(kLoop), LengthUnit::um, Space::ras, warnings));
  EXPECT_EQ(cleaned.centerline.nodes().size(), 6u);
  EXPECT_EQ(cleaned.centerline.cycle_rank(), 1u);
  EXPECT_EQ(cleaned.centerline.component_count(), 1u);
  EXPECT_EQ(cleaned.centerline.segments().size(), 6u);
  double thickest = 0;
  for (const auto& node : cleaned.centerline.nodes()) thickest = std::max(thickest, node.radius);
  EXPECT_DOUBLE_EQ(thickest, 0.002);
}

TEST(ReadVmv, StrandsThatRepeatTheirEndPointsAreJoinedThere) {
  auto text = with("6\t40", "7\t20\t0\t0\t1\n6\t40");
  text = replaced(replaced(text, "VERTS\t6", "VERTS\t7"), "3 3 5 6", "3 7 5 6");
  std::vector<std::string> warnings;
  const auto cleaned = clean(convert_to_internal(parse(text), LengthUnit::mm, Space::lps, warnings));
  EXPECT_EQ(cleaned.centerline.nodes().size(), 6u);
  EXPECT_EQ(cleaned.centerline.component_count(), 1u);
}

TEST(ReadVmv, SaysWhenStrandsShareNoVertex) {
  const auto raw = parse(replaced(with("2 1 4 3", "2 4 6"), "3 3 5 6", "3 5"));
  ASSERT_EQ(raw.warnings.size(), 3u);
  expect_contains(raw.warnings[0], "1 strands have fewer than two vertices");
  expect_contains(raw.warnings[1], "1 vertices belong to no strand");
  expect_contains(raw.warnings[2], "where the 2 strands join");
}

TEST(ReadVmv, TakesWhatVariesBetweenWriters) {
  expect_is_loop(parse(with_every("\n", "\r\n")));
  expect_is_loop(parse(with_every("\t", "   ")));
  expect_is_loop(parse("\xEF\xBB\xBF" + with("$STRANDS_LIST_END\n", "$STRANDS_LIST_END")));
  expect_is_loop(parse(with_every("NUM_", "$NUM_")));
  expect_is_loop(parse(kLoop.substr(kLoop.find("$VERT_LIST_BEGIN"))));  // the counts are a check, nothing else
  expect_is_loop(parse(with("$PARAM_END", "RADIUS_SIMULATION_TIME_STEPS 7\n$PARAM_END")));
  const std::size_t strands = kLoop.find("$STRANDS");
  expect_is_loop(parse(kLoop.substr(strands) + kLoop.substr(0, strands)));
}

TEST(ReadVmv, ReadsUnitAndFrameFromComments) {
  const auto raw = parse("# UNIT=um SPACE=RAS\n" + with("1 1 2 3 ", "1 1 2 3 # the first"));
  expect_is_loop(raw);
  EXPECT_EQ(raw.unit, LengthUnit::um);
  EXPECT_EQ(raw.space, Space::ras);
}

TEST(ReadVmv, SaysWhatItIgnores) {
  const auto raw = parse(with("0.5\n", "0.5 77\n") + "$RADIUS_SIMULATION_BEGIN\n1.5 2.5\n$RADIUS_SIMULATION_END\n");
  expect_is_loop(raw);
  ASSERT_EQ(raw.warnings.size(), 2u);
  expect_contains(raw.warnings[0], "line 21: the section \"$RADIUS_SIMULATION_BEGIN\"");
  expect_contains(raw.warnings[1], "1 vertices have more columns");
}

TEST(ReadVmv, NamesTheLineThatIsWrong) {
  expect_contains(error(with("2\t10\t0\t0\t1\n", "2\t10\t0\t0\n")), "line 9: it has 4 columns");
  expect_contains(error(with("-.5", "low")), "line 12: the z \"low\"");
  expect_contains(error(with("4\t10", "4.5\t10")), "line 11: the vertex id \"4.5\"");
  expect_contains(error(with("4\t10", "2\t10")), "line 11: the vertex id 2 was given before, in line 9");
  expect_contains(error(with("2 1 4 3", "2 1 4 9")), "line 18: there is no vertex 9");
  expect_contains(error(with("2 1 4 3", "2 9")), "line 18: there is no vertex 9");
  expect_contains(error(with("2 1 4 3", "2 1 x 3")), "line 18: the vertex id \"x\"");
  expect_contains(error(with("2 1 4 3", "two 1 4 3")), "line 18: the strand id \"two\"");
}

TEST(ReadVmv, RefusesCountsThatAreNotKept) {
  expect_contains(error(with("VERTS\t6", "VERTS\t7")), "line 2: 7 vertices are promised and 6 are there");
  expect_contains(error(with("STRANDS\t3", "STRANDS\t2")), "line 3: 2 strands are promised and 3 are there");
  expect_contains(error(with("VERTS\t6", "VERTS\t99999999999999")), "line 2");
  expect_contains(error(with("VERTS\t6", "VERTS\t-6")), "line 2: \"NUM_VERTS\" must be followed by one count");
  expect_contains(error(with("VERTS\t6", "VERTS")), "line 2: \"NUM_VERTS\"");
  expect_contains(error(with("VERT 4", "VERT 3")), "line 4: there must be at least four attributes");
}

TEST(ReadVmv, RefusesSectionsThatAreMissingRepeatedOrMixedUp) {
  expect_contains(error(kLoop.substr(0, kLoop.find("$STRANDS"))), "line 15: the file ends without a section $STRANDS");
  expect_contains(error(kLoop.substr(kLoop.find("$STRANDS"))), "without a section $VERT_LIST_BEGIN");
  expect_contains(error(kLoop + "$VERT_LIST_BEGIN\n$VERT_LIST_END\n"),
                  "line 21: this section occurs twice, first in line 7");
  expect_contains(error(with("$VERT_LIST_END\n", "")), "line 15: \"$STRANDS_LIST_BEGIN\" comes before the end");
  expect_contains(error(with("$VERT_LIST_END", "$PARAM_END")),
                  "line 14: \"$PARAM_END\" ends a section that is not open");
  expect_contains(error("1 1 0 0 0 1 -1\n"), "line 1: \"1\" is outside of every section");
  expect_contains(error("$VERT_LIST_BEGIN\n$VERT_LIST_END\n$STRANDS_LIST_BEGIN\n1\n$STRANDS_LIST_END\n"),
                  "line 3: there is no strand of two vertices");
  expect_contains(error("\n"), "line 1: the file ends without");
}

TEST(ReadVmv, EveryCutFileIsRefused) {
  const std::size_t whole = kLoop.size() - 1;  // the last line needs no end
  for (std::size_t size = 1; size < whole; ++size) {
    SCOPED_TRACE(size);
    error(kLoop.substr(0, size));
  }
  expect_is_loop(parse(kLoop.substr(0, whole)));
}

TEST(ReadVmv, LeavesNonFiniteNumbersToCleaningWhichNamesTheLine) {
  for (const std::string bad : {"nan", "inf", "1e999"}) {
    std::vector<std::string> warnings;
    const auto raw = convert_to_internal(parse(with("1e1", bad)), LengthUnit::mm, Space::lps, warnings);
    expect_contains(message_of<InvalidInput>([&] { clean(raw); }), "t.vmv: line 12");
  }
}

TEST(WriteVmv, IsRefusedWithAdvice) {
  const testing::TemporaryFolder folder;
  const Centerline one({{{0, 0, 0}, 1}}, {});
  expect_contains(message_of<Unsupported>([&] { write_centerline(folder / "t.vmv", one); }), "write the centerline as");
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(SharedData, VmvOfABrainTreeHasThePointsOfItsSwcWithoutTheJoints) {
  VMESH_NEED_SHARED_DATA("brain_brava_swc/BG0002.CNG.vmv");
  const auto vmv = read_centerline(testing::shared_data("brain_brava_swc/BG0002.CNG.vmv"));
  const auto swc = read_centerline(testing::shared_data("brain_brava_swc/BG0002.CNG.swc"));
  ASSERT_EQ(vmv.nodes.size(), swc.nodes.size());
  for (std::size_t n = 0; n < swc.nodes.size(); ++n) {
    EXPECT_LE((vmv.nodes[n].position - swc.nodes[n].position).cwiseAbs().maxCoeff(), 0.005 + 1e-9) << "node " << n;
    EXPECT_NEAR(vmv.nodes[n].radius, swc.nodes[n].radius, 0.005 + 1e-9) << "node " << n;
  }
  EXPECT_EQ(vmv.path_starts.size(), 109u);
  EXPECT_EQ(swc.segments.size() - vmv.segments.size(), vmv.path_starts.size() - 1);
  ASSERT_EQ(vmv.warnings.size(), 1u);
  expect_contains(vmv.warnings[0], "where the 109 strands join");
}

}  // namespace
}  // namespace vmesh
