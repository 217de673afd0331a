#include "vmesh/centerline/edits.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// A trunk of radius 3 along x, with branches of 2 and 1; the last of these branches again.
Centerline tree() {
  return {{{{0, 0, 0}, 3}, {{20, 0, 0}, 3}, {{40, 20, 0}, 2}, {{40, -20, 0}, 1}, {{60, -20, 0}, 1}, {{60, -40, 0}, 1}},
          {{0, 1}, {1, 2}, {1, 3}, {3, 4}, {3, 5}}};
}

/// By the definition, at distance `d` along the vessels.
double profile(const RadiusChange& change, double d) {
  if (d >= change.length / 2) return 1;
  return 1 + change.share * (1 + std::cos(2 * std::numbers::pi * d / change.length)) / 2;
}

TEST(CenterlineEdits, NarrowAVesselByTheProfile) {
  const RadiusChange change{1, 10, -0.6};
  const EditedCenterline edited = edit_centerline(tree(), {.radius = {change}});
  const auto& nodes = edited.centerline.nodes();
  ASSERT_EQ(edited.original, (std::vector<Index>{0, 1, 2, 3, 4, 5}));
  EXPECT_NEAR(nodes[1].radius, 0.4 * 3, 1e-12);
  for (const Index n : {0, 2, 3, 4, 5}) EXPECT_EQ(nodes[n].radius, tree().node(n).radius);
  std::size_t narrowed = 0;
  for (Index n = 6; n < nodes.size(); ++n) {
    const Vec3& p = nodes[n].position;
    const double d = (p - Vec3(20, 0, 0)).norm();
    // Straight vessels: the radius falls evenly from 3 over the length of the segment, whichever it is.
    const double end = p.x() <= 20 ? 3 : p.y() > 0 ? 2 : 1, length = p.x() <= 20 ? 20 : std::sqrt(800.0);
    EXPECT_NEAR(nodes[n].radius, profile(change, d) * (3 + (end - 3) * d / length), 1e-9);
    narrowed += d < 5;
  }
  EXPECT_GE(narrowed, 3u * 11);  // a twenty-fourth of the length apart, on three vessels
  EXPECT_EQ(find_branches(edited.centerline).size(), find_branches(tree()).size());
}

TEST(CenterlineEdits, KnowTheFactorBetweenNodes) {
  const Centerline line({{{0, 0, 0}, 1}, {{30, 0, 0}, 1}, {{60, 0, 0}, 1}}, {{0, 1}, {1, 2}});
  const RadiusChange narrow{1, 8, -0.5}, wide{0, 40, 0.3};
  const ChangedRadius radius(line, {narrow, wide});
  for (double x = 0; x <= 60; x += 0.7) {
    const bool first = x <= 30;
    EXPECT_NEAR(radius.factor(first ? 0 : 1, (first ? x : x - 30) / 30),
                profile(narrow, std::abs(x - 30)) * profile(wide, x), 1e-12);
  }
  EXPECT_EQ(radius.factor_at_node(2), 1);
  EXPECT_NEAR(radius.factor_at_node(0), 1.3, 1e-12);
  // Only where something changes.
  for (const double t : radius.steps(1)) EXPECT_LE(30 * t, 4 + 8.0 / 24 + 1e-9);
}

TEST(CenterlineEdits, RemoveABranchAndWhatHangsOnIt) {
  const std::vector<Branch> branches = find_branches(tree());
  for (Index b = 0; b < branches.size(); ++b) {
    const bool is_trunk = branches[b].nodes.front() == 0 || branches[b].nodes.back() == 0;
    if (is_trunk) {
      EXPECT_THROW(edit_centerline(tree(), {.removed_branches = {b}}), InvalidInput);
      continue;
    }
    const EditedCenterline edited = edit_centerline(tree(), {.removed_branches = {b}});
    EXPECT_EQ(edited.centerline.component_count(), 1u);
    const bool is_thin_one = branches[b].segments == std::vector<Index>{2};
    EXPECT_EQ(edited.centerline.segments().size(), is_thin_one ? 2u : 4u);
    for (std::size_t n = 0; n < edited.original.size(); ++n)
      EXPECT_EQ(edited.centerline.nodes()[n].position, tree().node(edited.original[n]).position);
  }
}

TEST(CenterlineEdits, ScaleEverythingAndKeepFlatEnds) {
  EndSection section{2, {40, 20, 0}, {1, 0, 0}, 12, {{40, 22, 0}, {40, 20, 2}, {40, 18, 0}}, true};
  EndSection removed{4, {60, -20, 0}, {1, 0, 0}, 3, {}, true};
  const Index thin = 2;
  ASSERT_EQ(find_branches(tree())[thin].segments, std::vector<Index>{2});
  const EditedCenterline edited =
      edit_centerline(tree(), {.radius = {{2, 6, 0.5}}, .removed_branches = {thin}, .scale = 2}, {section, removed});
  EXPECT_NEAR(edited.centerline.node(2).radius, 2 * 1.5 * 2, 1e-12);
  EXPECT_EQ(edited.centerline.node(1).position, Vec3(40, 0, 0));
  ASSERT_EQ(edited.end_sections.size(), 1u);
  EXPECT_EQ(edited.end_sections[0].node, 2u);
  EXPECT_EQ(edited.end_sections[0].center, Vec3(80, 40, 0));
  EXPECT_NEAR(edited.end_sections[0].area, 12 * 1.5 * 1.5 * 4, 1e-12);
  EXPECT_EQ(edited.end_sections[0].ring[0], Vec3(80, 46, 0));
}

TEST(CenterlineEdits, OfAnIsolatedNodeChangeIt) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{9, 0, 0}, 1}, {{20, 0, 0}, 2}}, {{0, 1}});
  EXPECT_NEAR(edit_centerline(centerline, {.radius = {{2, 1, -0.5}}}).centerline.node(2).radius, 1, 1e-12);
  EXPECT_NEAR(ChangedRadius(centerline, {{2, 1, -0.5}}).factor(1, 0), 0.5, 1e-12);
}

std::string refusal_of(const CenterlineEdit& edit) {
  try {
    edit_centerline(tree(), edit);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(CenterlineEdits, SayWhatIsWrong) {
  EXPECT_EQ(refusal_of({.radius = {{6, 5, -0.5}}}),
            "the change of the radius at node 6: the centerline has 6 nodes, numbered from 0");
  EXPECT_EQ(refusal_of({.radius = {{1, 0, -0.5}}}), "the change of the radius at node 1: its length must be positive");
  EXPECT_EQ(refusal_of({.radius = {{1, 5, -1}}}),
            "the change of the radius at node 1: nothing would be left of the vessel; give a smaller share");
  EXPECT_EQ(refusal_of({.removed_branches = {5}}), "branch 5 cannot be removed: the centerline has 5, numbered from 0");
  EXPECT_EQ(refusal_of({.scale = std::nan("")}), "the scale must be a positive number");
}

}  // namespace
}  // namespace vmesh
