#include "vmesh/centerline/raw_centerline.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

RawCenterline one_node(LengthUnit unit, Space space) {
  RawCenterline raw;
  raw.nodes = {{{1, 2, 3}, 4}};
  raw.unit = unit;
  raw.space = space;
  raw.source = "one.swc";
  return raw;
}

TEST(ConvertToInternal, ScalesToMillimetresAndTurnsToLps) {
  std::vector<std::string> warnings;
  const auto raw = convert_to_internal(one_node(LengthUnit::cm, Space::ras), {}, {}, warnings);
  EXPECT_EQ(raw.nodes[0].position, Vec3(-10, -20, 30));
  EXPECT_EQ(raw.nodes[0].radius, 40);
  EXPECT_EQ(raw.unit, LengthUnit::mm);
  EXPECT_EQ(raw.space, Space::lps);
  EXPECT_TRUE(warnings.empty());
  const auto micro = convert_to_internal(one_node(LengthUnit::um, Space::lps), {}, {}, warnings);
  EXPECT_EQ(micro.nodes[0].position, Vec3(0.001, 0.002, 0.003));
}

TEST(ConvertToInternal, ConvertsFlatEnds) {
  RawCenterline raw = one_node(LengthUnit::cm, Space::ras);
  raw.end_sections = {{0, {1, 2, 3}, {0, 1, 0}, 2, {{1, 2, 3}, {0, 2, 3}, {0, 2, 4}}, true}};
  std::vector<std::string> warnings;
  const EndSection section = convert_to_internal(raw, {}, {}, warnings).end_sections.at(0);
  EXPECT_EQ(section.center, Vec3(-10, -20, 30));
  EXPECT_EQ(section.normal, Vec3(0, -1, 0));
  EXPECT_EQ(section.area, 200);
  EXPECT_EQ(section.ring, (std::vector<Vec3>{{-10, -20, 30}, {0, -20, 30}, {0, -20, 40}}));
  const auto area = [](const EndSection& s) -> Vec3 { return (s.ring[1] - s.ring[0]).cross(s.ring[2] - s.ring[0]); };
  EXPECT_EQ(area(raw.end_sections[0]).dot(raw.end_sections[0].normal) > 0, area(section).dot(section.normal) > 0);
}

TEST(Merge, RenumbersFlatEnds) {
  RawCenterline a = one_node(LengthUnit::mm, Space::lps), b = a;
  b.end_sections = {{0, {1, 2, 3}, {0, 1, 0}, 2, {}, true}};
  const RawCenterline all = merge({a, b});
  ASSERT_EQ(all.end_sections.size(), 1u);
  EXPECT_EQ(all.end_sections[0].node, 1u);
}

TEST(ConvertToInternal, SaysWhatItAssumes) {
  std::vector<std::string> warnings;
  const auto raw = convert_to_internal(one_node(LengthUnit::unknown, Space::unknown), {}, {}, warnings);
  EXPECT_EQ(raw.nodes[0].position, Vec3(1, 2, 3));
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("one.swc"), std::string::npos);
  EXPECT_NE(warnings[0].find("mm"), std::string::npos);
  EXPECT_NE(warnings[1].find("LPS"), std::string::npos);
}

TEST(ConvertToInternal, LetsAnOverrideWinAndSaysWhenTheFileDisagrees) {
  std::vector<std::string> warnings;
  auto raw = convert_to_internal(one_node(LengthUnit::unknown, Space::lps), LengthUnit::cm, {}, warnings);
  EXPECT_EQ(raw.nodes[0].radius, 40);
  EXPECT_TRUE(warnings.empty());
  raw = convert_to_internal(one_node(LengthUnit::mm, Space::lps), LengthUnit::cm, Space::ras, warnings);
  EXPECT_EQ(raw.nodes[0].position, Vec3(-10, -20, 30));
  EXPECT_EQ(warnings.size(), 2u);
}

TEST(LengthUnit, NamesAreReadBack) {
  for (const auto unit : {LengthUnit::um, LengthUnit::mm, LengthUnit::cm, LengthUnit::m, LengthUnit::unknown}) {
    EXPECT_EQ(parse_length_unit(to_string(unit)), unit);
  }
  for (const auto space : {Space::lps, Space::ras, Space::unknown}) EXPECT_EQ(parse_space(to_string(space)), space);
  EXPECT_EQ(parse_length_unit("Micron"), LengthUnit::um);
  EXPECT_EQ(parse_length_unit("furlong"), std::nullopt);
  EXPECT_THROW(millimetres_per(LengthUnit::unknown), InvalidInput);
}

}  // namespace
}  // namespace vmesh
