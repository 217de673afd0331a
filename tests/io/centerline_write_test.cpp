#include <random>

#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::content_of;
using testing::expect_contains;
using testing::message_of;
using testing::TemporaryFolder;

/// Nodes in no particular order, with coordinates that need all their digits.
Centerline sample(bool with_loop) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> real(-100, 100);
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < 60; ++i) {
    nodes.push_back({{real(random), real(random) / 3, real(random) * 1e-7}, std::exp(real(random) / 20)});
    if (i > 0 && i != 40) segments.push_back({i, static_cast<Index>(random() % i)});
  }
  if (with_loop) segments.push_back({59, 5});
  return {nodes, segments};
}

std::vector<std::string> extensions() {
  std::vector<std::string> result = {".swc", ".json", ".csv"};
  result.push_back(".vtp");
  return result;
}

TEST(WriteCenterline, EveryFormatBringsEveryBitBack) {
  const TemporaryFolder folder;
  const Centerline tree = sample(false);
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    const auto path = folder / ("t" + extension);
    write_centerline(path, tree, {"vmesh 1", "--blend 0.5", "in.swc", "abc123"});
    const auto raw = read_centerline(path);
    EXPECT_EQ(raw.unit, LengthUnit::mm);
    EXPECT_EQ(raw.space, Space::lps);
    EXPECT_TRUE(raw.warnings.empty());
    CleaningOptions as_it_is;
    as_it_is.round = as_it_is.canonical_order = false;
    as_it_is.join_gaps = false;
    const auto back = clean(raw, as_it_is);
    EXPECT_TRUE(back.report.actions.empty());
    ASSERT_EQ(back.centerline.nodes().size(), tree.nodes().size());
    EXPECT_EQ(back.centerline.component_count(), tree.component_count());
    if (extension == ".vtp") continue;  // its nodes come in the order of the lines
    for (Index n = 0; n < tree.nodes().size(); ++n) {
      EXPECT_EQ(back.centerline.node(n).position, tree.node(n).position);
      EXPECT_EQ(back.centerline.node(n).radius, tree.node(n).radius);
    }
  }
}

TEST(WriteCenterline, EveryFormatGivesTheSameTreeAfterCleaning) {
  const TemporaryFolder folder;
  const Centerline tree = sample(false);
  write_centerline(folder / "reference.json", tree);
  CenterlineLoadOptions options;
  options.cleaning.join_gaps = false;
  const auto reference = load_centerline(folder / "reference.json", options).cleaned.centerline;
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    write_centerline(folder / ("t" + extension), tree);
    testing::expect_same(load_centerline(folder / ("t" + extension), options).cleaned.centerline, reference);
  }
}

TEST(WriteCenterline, KeepsLoopsWhereTheFormatCan) {
  const TemporaryFolder folder;
  const Centerline loop = sample(true);
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    const auto path = folder / ("t" + extension);
    if (extension == ".swc") {
      expect_contains(message_of<Unsupported>([&] { write_centerline(path, loop); }), ".json");
      EXPECT_FALSE(std::filesystem::exists(path));
    } else {
      write_centerline(path, loop);
      EXPECT_EQ(load_centerline(path).cleaned.centerline.cycle_rank(), 1u);
    }
  }
}

TEST(WriteCenterline, WritesTheSameBytesTwiceAndWhereItComesFrom) {
  const TemporaryFolder folder;
  for (const auto& extension : extensions()) {
    SCOPED_TRACE(extension);
    const CenterlineMetadata metadata{"vmesh 1", "--seed\n3", "in \"x\".swc", "abc123"};
    write_centerline(folder / ("a" + extension), sample(false), metadata);
    write_centerline(folder / ("b" + extension), sample(false), metadata);
    EXPECT_EQ(content_of(folder / ("a" + extension)), content_of(folder / ("b" + extension)));
    if (extension == ".vtp") continue;  // there it is encoded; see vtp_test.cpp
    for (const char* part : {"LPS", "mm", "vmesh 1", "--seed 3", "abc123"}) {
      expect_contains(content_of(folder / ("a" + extension)), part);
    }
  }
}

TEST(WriteCenterline, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  expect_contains(message_of<WriteError>([&] { write_centerline(folder / "none/t.json", sample(false)); }), "t.json");
  EXPECT_THROW(write_centerline(folder / "t.docx", sample(false)), Unsupported);
  EXPECT_THROW(write_centerline(folder / "t.segments.csv", sample(false)), InvalidInput);
  std::filesystem::create_directory(folder / "t.segments.csv");
  EXPECT_THROW(write_centerline(folder / "t.csv", sample(false)), WriteError);
  EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace
}  // namespace vmesh
