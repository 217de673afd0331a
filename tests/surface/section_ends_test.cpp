#include "vmesh/surface/section_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/flat_ends.h"

#include "centerlines.h"

namespace vmesh {
namespace {

using testing::fork;

/// A vessel of radius 1 along x.
Centerline tube(double length = 10) { return {{{{0, 0, 0}, 1}, {{length, 0, 0}, 1}}, {{0, 1}}}; }

/// A cross-section at the end of a vessel of radius 1 along `way`, tilted by an angle, with a ring that is as wide as
/// the vessel where the plane cuts it, times `wide` and `high`.
EndSection cut(Index node, const Vec3& center, const Vec3& way, double degrees, double wide = 1, double high = 1) {
  const double angle = degrees * std::numbers::pi / 180;
  const Vec3 u = way.unitOrthogonal(), v = way.cross(u);
  const Vec3 normal = std::cos(angle) * way + std::sin(angle) * u;
  EndSection section{node, center, normal, std::numbers::pi * wide * high / std::cos(angle), {}, true};
  constexpr int kPoints = 72;
  for (int i = 0; i < kPoints; ++i) {
    const double turn = 2 * std::numbers::pi * i / kPoints;
    const Vec3 off = wide * std::cos(turn) * u + high * std::sin(turn) * v;
    section.ring.push_back(center + off - off.dot(normal) / way.dot(normal) * way);
  }
  return section;
}

GenerateResult open_surface(const Centerline& centerline, int around) {
  GenerateOptions options;
  options.around = around;
  options.open_ends.all = true;
  return generate_surface(centerline, options);
}

/// By how much the section's ring, scaled about its centre, goes through `p`, which lies in its plane.
double scale_of_ring_through(const EndSection& section, const Vec3& p) {
  const Vec3 way = p - section.center;
  for (std::size_t i = 0; i < section.ring.size(); ++i) {
    const Vec3 a = section.ring[i] - section.center;
    const Vec3 b = section.ring[(i + 1) % section.ring.size()] - section.center;
    // way = s a + t b, which the edge meets where s + t = 1
    const double whole = a.cross(b).dot(section.normal);
    const double s = way.cross(b).dot(section.normal) / whole, t = a.cross(way).dot(section.normal) / whole;
    if (s >= -1e-9 && t >= -1e-9) return s + t;
  }
  return 0;
}

void expect_sound(const GenerateResult& result) {
  EXPECT_TRUE(result.is_sound());
  EXPECT_TRUE(self_intersections(result.mesh).empty());
  const Topology closed = measure_topology(with_lids(result));
  EXPECT_TRUE(closed.closed && closed.manifold && closed.oriented && closed.outward);
  EXPECT_LT(summarize_skewness(result.mesh).max, 0.75);
}

enum class RingSize { of_section_area, of_ring };

void expect_ends_in(const EndSection& section, const GenerateResult& result,
                    RingSize size = RingSize::of_section_area) {
  const auto opening = std::find_if(result.openings.begin(), result.openings.end(),
                                    [&](const Opening& o) { return o.node == section.node; });
  ASSERT_NE(opening, result.openings.end());
  EXPECT_EQ(opening->center, section.center);
  EXPECT_EQ(opening->normal, section.normal);
  Vec3 area = Vec3::Zero();
  const double scale = section.ring.empty() || size == RingSize::of_ring
                           ? 1
                           : scale_of_ring_through(section, result.mesh.vertices[opening->ring.front()]);
  for (std::size_t j = 0; j < opening->ring.size(); ++j) {
    const Vec3 p = result.mesh.vertices[opening->ring[j]] - section.center;
    const Vec3 q = result.mesh.vertices[opening->ring[(j + 1) % opening->ring.size()]] - section.center;
    EXPECT_NEAR(p.dot(section.normal), 0, 1e-9);
    if (!section.ring.empty()) {
      EXPECT_NEAR(scale_of_ring_through(section, p + section.center), scale, 1e-9);
    }
    area += p.cross(q) / 2;
  }
  EXPECT_GT(area.normalized().dot(section.normal), 1 - 1e-9);
  if (size == RingSize::of_section_area) {
    EXPECT_NEAR(area.norm(), section.area, 1e-9);
  }
}

class SectionEndsAround : public ::testing::TestWithParam<int> {};

TEST_P(SectionEndsAround, ATubeIsCutObliquely) {
  for (const double degrees : {0, 15, 35}) {
    for (const bool with_ring : {true, false}) {
      SCOPED_TRACE(::testing::Message() << degrees << " degrees, ring " << with_ring);
      std::vector<EndSection> sections = {cut(0, {0, 0, 0}, {-1, 0, 0}, degrees),
                                          cut(1, {10, 0, 0}, {1, 0, 0}, degrees)};
      if (!with_ring) sections[0].ring = sections[1].ring = {};
      GenerateResult result = open_surface(tube(), GetParam());
      FlatEndOptions options;
      options.cap = false;
      options.sections = sections;
      const FlatEnds flat = finish_ends(result, tube(), options);
      EXPECT_TRUE(flat.not_kept.empty());
      expect_sound(result);
      for (const EndSection& section : sections) expect_ends_in(section, result);
      ASSERT_EQ(flat.ends.size(), 2u);
      for (const FlatEnd& end : flat.ends) {
        EXPECT_TRUE(end.at_section && !end.capped);
        EXPECT_GT(end.normal.dot(sections[end.node].normal), 1 - 1e-9);
      }
    }
  }
}

TEST_P(SectionEndsAround, ATubeEndsInEllipses) {
  const std::vector<EndSection> sections = {cut(0, {0, 0, 0}, {-1, 0, 0}, 20, 1.4, 0.8),
                                            cut(1, {10.1, 0.1, 0}, {1, 0, 0}, 0, 0.8, 1.3)};
  GenerateResult result = open_surface(tube(), GetParam());
  FlatEndOptions options;
  options.cap = false;
  options.sections = sections;
  EXPECT_TRUE(finish_ends(result, tube(), options).not_kept.empty());
  expect_sound(result);
  for (const EndSection& section : sections) expect_ends_in(section, result);
}

TEST_P(SectionEndsAround, CapsAndExtensionsBeginAtTheRing) {
  const EndSection section = cut(1, {10, 0, 0}, {1, 0, 0}, 25, 1.2, 0.9);
  for (const double extension : {0, 4}) {
    SCOPED_TRACE(extension);
    GenerateResult result = open_surface(tube(), GetParam());
    FlatEndOptions options;
    options.sections = {section};
    options.extension = extension;
    const FlatEnds flat = finish_ends(result, tube(), options);
    EXPECT_TRUE(result.is_sound() && result.openings.empty());
    ASSERT_EQ(flat.ends.size(), 2u);
    EXPECT_FALSE(flat.ends[0].at_section);
    EXPECT_NEAR(flat.ends[0].area, std::numbers::pi, 1e-9);
    const FlatEnd& end = flat.ends[1];
    EXPECT_TRUE(end.at_section);
    EXPECT_GT(end.normal.dot(section.normal), 1 - 1e-9);
    EXPECT_NEAR((end.center - section.center).dot(section.normal), extension * std::sqrt(end.area / std::numbers::pi),
                1e-9);
    EXPECT_NEAR(end.area, section.area, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, SectionEndsAround, ::testing::Values(6, 9, 12, 20));

TEST(SectionEnds, OfAStubMoveOnlyTheirOwnRings) {
  const std::vector<EndSection> sections = {cut(0, {0, 0, 0}, {-1, 0, 0}, 30), cut(1, {2.5, 0, 0}, {1, 0, 0}, 30)};
  GenerateResult result = open_surface(tube(2.5), 12);
  EXPECT_EQ(end_at_sections(result, sections, true).kept, (std::vector<Index>{0, 1}));
  for (const EndSection& section : sections) expect_ends_in(section, result);
}

TEST(SectionEnds, LieOnTheRingWhereTheAreaIsNotWanted) {
  const EndSection section = cut(1, {10, 0, 0}, {1, 0, 0}, 25, 1.2, 0.9);
  GenerateResult result = open_surface(tube(), 6);
  end_at_sections(result, {section}, false);
  expect_ends_in(section, result, RingSize::of_ring);
}

/// Beside another vessel, nearer and nearer, a tube ends with its area, on the ring, and at last not in its section.
TEST(SectionEnds, LieOnTheRingWhereThereIsNoRoomForTheArea) {
  const EndSection section = cut(1, {10, 0, 0}, {1, 0, 0}, 0, 1.3, 1.3);
  std::string ends_as;
  for (double apart = 2.5; apart > 1.99; apart -= 0.01) {
    const Centerline two({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, apart, 0}, 1}, {{14, apart, 0}, 1}}, {{0, 1}, {2, 3}});
    GenerateResult result = open_surface(two, 6);
    const SectionEnds ends = end_at_sections(result, {section}, true);
    const char as = ends.kept.empty() ? '-' : ends.narrowed.empty() ? 'a' : 'r';
    if (ends_as.empty() || ends_as.back() != as) ends_as += as;
    EXPECT_TRUE(self_intersections(result.mesh).empty());
    if (!ends.kept.empty())
      expect_ends_in(section, result, ends.narrowed.empty() ? RingSize::of_section_area : RingSize::of_ring);
  }
  EXPECT_EQ(ends_as, "ar-");
}

TEST(SectionEnds, OfATreeLeaveTheOtherEndsAlone) {
  const GenerateResult before = open_surface(fork(), 6);
  GenerateResult result = before;
  const Centerline centerline = fork();
  const Vec3 way = (centerline.node(3).position - centerline.node(2).position).normalized();
  const EndSection section = cut(3, centerline.node(3).position, way, 20, 1.1, 0.9);
  const SectionEnds ends = end_at_sections(result, {section}, true);
  EXPECT_EQ(ends.kept, std::vector<Index>{3});
  expect_ends_in(section, result);
  for (std::size_t i = 0; i < result.openings.size(); ++i) {
    if (result.openings[i].node == 3) continue;
    EXPECT_EQ(result.openings[i].center, before.openings[i].center);
    for (const Index v : result.openings[i].ring) EXPECT_EQ(result.mesh.vertices[v], before.mesh.vertices[v]);
  }
}

std::string reason_not_kept(const EndSection& section) {
  const GenerateResult before = open_surface(tube(), 8);
  GenerateResult result = before;
  const SectionEnds ends = end_at_sections(result, {section}, true);
  EXPECT_TRUE(ends.kept.empty());
  EXPECT_EQ(result.mesh.vertices, before.mesh.vertices);
  EXPECT_EQ(result.openings[1].normal, before.openings[1].normal);
  return ends.not_kept.size() == 1 && ends.not_kept[0].node == 1 ? ends.not_kept[0].reason : "";
}

TEST(SectionEnds, SayWhyTheyAreNotKept) {
  const Vec3 x(1, 0, 0);
  EXPECT_EQ(reason_not_kept(cut(1, {10, 0, 0}, x, 60)), "its plane is 60 degrees off the vessel's cross-section");
  EXPECT_EQ(reason_not_kept(cut(1, {12, 0, 0}, x, 0)), "its centre is 2 radii from the middle of the vessel's end");
  EndSection beside = cut(1, {10, 0, 0}, x, 0);
  for (Vec3& p : beside.ring) p.y() += 3;
  EXPECT_EQ(reason_not_kept(beside), "its ring does not go around its centre");
  EXPECT_NE(reason_not_kept(cut(1, {10, 0, 0}, x, 0, 1, 0.02)).find("a triangle would have a skewness of 0.9"),
            std::string::npos);
}

TEST(SectionEnds, ThatWouldCrossAVesselAreNotKept) {
  const Centerline two({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, 3, 0}, 1}, {{14, 3, 0}, 1}}, {{0, 1}, {2, 3}});
  GenerateResult result = open_surface(two, 8);
  FlatEndOptions options;
  options.sections = {cut(1, {10, 0, 0}, {1, 0, 0}, 0, 2.5, 2.5), cut(3, {14, 3, 0}, {1, 0, 0}, 30)};
  const FlatEnds flat = finish_ends(result, two, options);
  EXPECT_TRUE(result.is_sound());
  ASSERT_EQ(flat.not_kept.size(), 1u);
  EXPECT_EQ(flat.not_kept[0].node, 1u);
  EXPECT_EQ(flat.not_kept[0].reason, "faces would cross");
  for (const FlatEnd& end : flat.ends) {
    EXPECT_EQ(end.at_section, end.node == 3);
    if (end.node == 1) {
      EXPECT_NEAR(end.area, std::numbers::pi, 1e-9);
    }
  }
}

}  // namespace
}  // namespace vmesh
