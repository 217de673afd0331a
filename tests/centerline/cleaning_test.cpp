#include "vmesh/centerline/cleaning.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

using Action = CleaningAction::Kind;

RawCenterline raw_of(std::vector<CenterlineNode> nodes, std::vector<CenterlineSegment> segments) {
  RawCenterline raw;
  raw.nodes = std::move(nodes);
  raw.segments = std::move(segments);
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  raw.source = "test.swc";
  raw.node_word = "line";
  return raw;
}

/// Polylines with points of their own, as VMTK writes them.
RawCenterline polylines(const std::vector<std::vector<CenterlineNode>>& lines) {
  RawCenterline raw = raw_of({}, {});
  raw.loose_branches = true;
  for (const auto& line : lines) {
    raw.path_starts.push_back(static_cast<Index>(raw.segments.size()));
    for (std::size_t i = 0; i < line.size(); ++i) {
      raw.nodes.push_back(line[i]);
      const auto n = static_cast<Index>(raw.nodes.size() - 1);
      if (i > 0) raw.segments.push_back({n - 1, n});
    }
  }
  return raw;
}

CenterlineNode node(double x, double y, double r) { return {{x, y, 0}, r}; }

void expect_same(const Centerline& a, const Centerline& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  ASSERT_EQ(a.segments().size(), b.segments().size());
  for (Index n = 0; n < a.nodes().size(); ++n) {
    EXPECT_EQ(a.node(n).position, b.node(n).position) << "node " << n;
    EXPECT_EQ(a.node(n).radius, b.node(n).radius) << "node " << n;
  }
  for (Index s = 0; s < a.segments().size(); ++s) {
    EXPECT_EQ(a.segment(s).a, b.segment(s).a) << "segment " << s;
    EXPECT_EQ(a.segment(s).b, b.segment(s).b) << "segment " << s;
  }
}

std::string message_of_failure(const RawCenterline& raw) {
  try {
    clean(raw);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "no exception";
}

/// Three straight branches of 10 mm that should meet at the origin, off by `gap` along x.
RawCenterline star(double gap) {
  RawCenterline raw = raw_of(
      {{{gap, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, gap, 0}, 1}, {{0, 10, 0}, 1}, {{-gap, 0, 0}, 1}, {{-10, 0, 0}, 1}},
      {{0, 1}, {2, 3}, {4, 5}});
  raw.node_word = "line";
  return raw;
}

TEST(JoinEnds, JoinsThoseWithinTheToleranceAndTellsWhere) {
  RawCenterline raw = star(0.3);
  EXPECT_EQ(clean(raw).centerline.component_count(), 3u);
  for (const EndTolerance tolerance : {EndTolerance{0.45, 0}, EndTolerance{0, 0.45}}) {
    raw.join_ends = tolerance;
    const CleanedCenterline cleaned = clean(raw);
    EXPECT_EQ(cleaned.centerline.component_count(), 1u);
    EXPECT_EQ(cleaned.centerline.cycle_rank(), 0u);
    EXPECT_EQ(cleaned.centerline.nodes().size(), 6u);
    ASSERT_EQ(cleaned.report.count(Action::joined_ends), 2u);
    EXPECT_NE(cleaned.report.actions.back().message.find("test.swc: line 2: this end of a branch lies 0.424"),
              std::string::npos)
        << cleaned.report.actions.back().message;
  }
  raw.join_ends = {0.42, 0};  // the square root of 2, times 0.3, is more
  EXPECT_EQ(clean(raw).report.count(Action::joined_ends), 0u);
}

TEST(JoinEnds, ClosesLoopsButNotShortBranches) {
  RawCenterline ring = raw_of({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{10, 10, 0}, 1}, {{0, 10, 0}, 1}, {{0, 0.5, 0}, 1}},
                              {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  ring.join_ends = {0.6, 0};
  EXPECT_EQ(clean(ring).centerline.cycle_rank(), 1u);
  ring.tree_only = true;
  EXPECT_EQ(clean(ring).centerline.cycle_rank(), 0u);
  RawCenterline twig = raw_of({{{0, 0, 0}, 1}, {{0.1, 0.2, 0}, 1}, {{0.5, 0, 0}, 1}}, {{0, 1}, {1, 2}});
  twig.join_ends = {3, 0};
  EXPECT_EQ(clean(twig).centerline.cycle_rank(), 0u);
}

TEST(JoinEnds, ManyEndsInOnePlaceAreRefusedQuickly) {
  RawCenterline raw = raw_of({}, {});
  constexpr Index kBranches = 100000;
  for (Index b = 0; b < kBranches; ++b) {
    raw.nodes.push_back({{0.01 * (b % 317), 0.01 * (b / 317), 0}, 1});
    raw.nodes.push_back({{0.01 * (b % 317), 0.01 * (b / 317), 50}, 1});
    raw.segments.push_back({2 * b, 2 * b + 1});
  }
  raw.join_ends = {10, 0};
  EXPECT_THROW(clean(raw), InvalidInput);
}

TEST(JoinEnds, TolerancesAreMillimetresOrRadii) {
  EXPECT_EQ(parse_end_tolerance(".5mm").mm, 0.5);
  EXPECT_EQ(parse_end_tolerance(".5mm").radii, 0);
  EXPECT_EQ(parse_end_tolerance("0.1").radii, 0.1);
  for (const char* text : {"", "mm", "-1mm", "0", "1cm", "nan", "1e99", "0.5 mm"})
    EXPECT_THROW(parse_end_tolerance(text), InvalidInput) << text;
}

TEST(Clean, LeavesACleanTreeAlone) {
  const auto result = clean(raw_of({node(0, 0, 2), node(5, 0, 1.5), node(9, 3, 1)}, {{0, 1}, {1, 2}}));
  EXPECT_TRUE(result.report.actions.empty());
  EXPECT_EQ(result.centerline.nodes().size(), 3u);
  EXPECT_EQ(result.raw_node, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(result.raw_segment, (std::vector<Index>{0, 1}));
}

TEST(Clean, ContractsSegmentsWithoutLength) {
  const auto result = clean(raw_of({node(0, 0, 1), node(0, 0, 1), node(5, 0, 1), node(5, 1e-4, 1), node(9, 0, 1)},
                                   {{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_EQ(result.centerline.nodes().size(), 3u);
  EXPECT_EQ(result.report.count(Action::contracted_segment), 2u);
  EXPECT_EQ(result.report.actions[0].index, 0u);
  EXPECT_EQ(result.report.actions[1].index, 2u);
}

TEST(Clean, DoesNotCollapseALineOfManyShortSteps) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i <= 10000; ++i) {
    nodes.push_back(node(i * 4e-4, 0, 1));
    if (i > 0) segments.push_back({i - 1, i});
  }
  const auto result = clean(raw_of(nodes, segments));
  EXPECT_GT(result.centerline.nodes().size(), 3000u);
  double length = 0;
  for (Index s = 0; s < result.centerline.segments().size(); ++s) length += result.centerline.length(s);
  EXPECT_NEAR(length, 4, 2e-3);
}

TEST(Clean, RemovesSelfLoopsAndDuplicateSegments) {
  const auto result = clean(raw_of({node(0, 0, 1), node(5, 0, 1)}, {{0, 0}, {0, 1}, {1, 0}, {0, 1}}));
  EXPECT_EQ(result.centerline.segments().size(), 1u);
  EXPECT_EQ(result.report.count(Action::removed_self_loop), 1u);
  ASSERT_EQ(result.report.count(Action::removed_duplicate_segment), 2u);
  EXPECT_EQ(result.report.actions[1].index, 2u);
  EXPECT_EQ(result.report.actions[2].index, 3u);
}

TEST(Clean, JoinsPiecesAtEqualEndsAndClosesRealLoops) {
  // Four sides of a square, each with end points of its own.
  const auto result = clean(raw_of({node(0, 0, 1), node(9, 0, 1), node(9, 0, 1), node(9, 9, 1), node(9, 9, 1),
                                    node(0, 9, 1), node(0, 9, 1), node(0, 0, 1)},
                                   {{0, 1}, {2, 3}, {4, 5}, {6, 7}}));
  EXPECT_EQ(result.centerline.nodes().size(), 4u);
  EXPECT_EQ(result.centerline.cycle_rank(), 1u);
  EXPECT_EQ(result.report.count(Action::merged_node), 4u);
}

TEST(Clean, ClosesNoLoopInATreeFormat) {
  auto raw = raw_of({node(0, 0, 1), node(9, 0, 1), node(9, 9, 1), node(0, 0, 1)}, {{0, 1}, {1, 2}, {2, 3}});
  raw.tree_only = true;
  const auto result = clean(raw);
  EXPECT_EQ(result.centerline.cycle_rank(), 0u);
  EXPECT_EQ(result.report.count(Action::kept_crossing), 1u);
}

TEST(Clean, MergesEndsWithinTheToleranceOnly) {
  const auto join = [](double gap) {
    return clean(raw_of({node(0, 0, 1), node(5, 0, 1), node(5 + gap, 0, 1), node(9, 0, 1)}, {{0, 1}, {2, 3}}))
        .centerline.component_count();
  };
  EXPECT_EQ(join(0.9e-3), 1u);
  EXPECT_EQ(join(1.1e-3), 2u);
}

TEST(Clean, InterpolatesZeroRadiiAlongTheGraph) {
  const auto result =
      clean(raw_of({node(0, 0, 1), node(1, 0, 0), node(3, 0, 0), node(4, 0, 5), node(9, 0, 2), node(12, 0, 0)},
                   {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}));
  std::vector<double> radius(6);
  for (Index n = 0; n < 6; ++n) radius[result.raw_node[n]] = result.centerline.node(n).radius;
  EXPECT_EQ(radius, (std::vector<double>{1, 2, 4, 5, 2, 2}));
  EXPECT_EQ(result.report.count(Action::repaired_radius), 3u);
  EXPECT_NE(result.report.actions[0].message.find("line 1"), std::string::npos) << result.report.actions[0].message;
}

TEST(Clean, RefusesAComponentWithoutAnyRadius) {
  const auto text =
      message_of_failure(raw_of({node(0, 0, 1), node(1, 0, 1), node(7, 0, 0), node(8, 0, 0)}, {{0, 1}, {2, 3}}));
  EXPECT_NE(text.find("test.swc: line 2"), std::string::npos) << text;
}

TEST(Clean, MergesTheTrunkThatVmtkRepeatsForEveryTarget) {
  std::vector<CenterlineNode> trunk, first, second, third;
  for (int i = 0; i <= 50; ++i) trunk.push_back(node(i, 0, 5));
  first = second = third = trunk;
  for (auto& n : second) n.position.z() += 2e-3;  // within 1e-3 of the radius
  for (int i = 1; i <= 20; ++i) {
    first.push_back(node(50 + i, i, 3));
    second.push_back(node(50 + i, -i, 3));
  }
  third.resize(31);
  for (int i = 1; i <= 20; ++i) third.push_back(node(30, -i, 2));
  const auto result = clean(polylines({first, second, third}));
  EXPECT_EQ(result.centerline.nodes().size(), 51u + 20 + 20 + 20);
  EXPECT_EQ(result.centerline.component_count(), 1u);
  EXPECT_EQ(result.centerline.cycle_rank(), 0u);
  EXPECT_EQ(result.report.count(Action::merged_trunk), 2u);
  EXPECT_EQ(result.report.actions.size(), 2u) << "one entry per repeated trunk";
}

TEST(Clean, MakesNoFalseLoopsOfPathsThatMeetAgainAfterParting) {
  // The second path leaves the first by 0.3 radii and then shares single points with it again.
  std::vector<CenterlineNode> first, second;
  for (int i = 0; i <= 30; ++i) {
    first.push_back(node(i, 0, 1));
    second.push_back(node(i, i > 10 && i < 25 && i % 3 != 0 ? 0.3 : 0, 1));
  }
  for (int i = 1; i <= 10; ++i) second.push_back(node(30, -i, 1));
  const auto result = clean(polylines({first, second}));
  EXPECT_EQ(result.centerline.component_count(), 1u);
  EXPECT_LE(result.centerline.cycle_rank(), 1u) << "at most where the end of the first path meets the second";
  EXPECT_GT(result.report.count(Action::kept_crossing), 0u);
}

// Along the axis from x = 0 on, at an angle from x = 40 on; points `step` mm apart, and `beside` mm off the axis up to
// there.
std::vector<CenterlineNode> inlet_to_outlet(double slope, double step, double beside, double radius = 2) {
  std::vector<CenterlineNode> path;
  for (double x = 0; x <= 60; x += step) {
    const double off = beside * std::min(1.0, x / 5);  // all begin in one place
    path.push_back(node(x, x < 40 ? off : off + slope * (x - 40), radius));
  }
  return path;
}

std::vector<double> branch_lengths(const Centerline& centerline) {
  std::vector<double> lengths;
  for (const Branch& branch : find_branches(centerline)) {
    double& length = lengths.emplace_back(0);
    for (const Index s : branch.segments) length += centerline.length(s);
  }
  return lengths;
}

TEST(Clean, MergesPathsFromOneInletThoughTheyDoNotShareTheirPoints) {
  const auto raw =
      polylines({inlet_to_outlet(1, 0.5, 0), inlet_to_outlet(-1, 0.37, 0.1), inlet_to_outlet(0.02, 1.3, -0.1)});
  const auto result = clean(raw);
  EXPECT_EQ(result.report.count(Action::merged_overlap), 2u);
  EXPECT_EQ(result.centerline.component_count(), 1u);
  EXPECT_EQ(result.centerline.cycle_rank(), 0u);
  EXPECT_EQ(std::count_if(result.raw_segment.begin(), result.raw_segment.end(), [](Index s) { return s == kNone; }), 0);
  // The third stays within a tenth of the radius of both others until after the fork.
  const auto lengths = branch_lengths(result.centerline);
  EXPECT_NEAR(*std::max_element(lengths.begin(), lengths.end()), 40, 1.5);
  for (const auto& n : result.centerline.nodes()) {
    if (n.position.x() < 39) {
      EXPECT_LE(std::abs(n.position.y()), 0.1 + 1e-9);
    }
  }
}

TEST(Clean, MergesPathsToOneOutletToo) {
  auto first = inlet_to_outlet(1, 0.5, 0), second = inlet_to_outlet(-1, 0.37, 0.1);
  std::reverse(first.begin(), first.end());
  std::reverse(second.begin(), second.end());
  const auto result = clean(polylines({first, second}));
  EXPECT_EQ(result.report.count(Action::merged_overlap), 1u);
  EXPECT_EQ(result.centerline.component_count(), 1u);
  EXPECT_EQ(result.centerline.cycle_rank(), 0u);
  EXPECT_EQ(find_branches(result.centerline).size(), 3u);
}

TEST(Clean, MergesAPathOntoLongSegments) {
  // The first has a segment of 40 mm there, which the second leaves in its middle.
  std::vector<CenterlineNode> first = {node(0, 0, 2), node(40, 0, 2), node(80, 0, 2)}, second;
  for (int i = 0; i <= 30; ++i) second.push_back(node(2 * i, i < 10 ? 0.05 : i - 10, 2));
  second.front() = node(0, 0, 2);
  const auto result = clean(polylines({first, second}));
  EXPECT_EQ(result.report.count(Action::merged_overlap), 1u);
  ASSERT_EQ(result.centerline.component_count(), 1u);
  const auto lengths = branch_lengths(result.centerline);
  ASSERT_EQ(lengths.size(), 3u);
  std::size_t of_first = 0;
  for (const Index s : result.raw_segment) of_first += s == 0;
  EXPECT_EQ(of_first, 2u) << "divided where the second leaves it";
  EXPECT_NEAR(std::accumulate(lengths.begin(), lengths.end(), 0.0), 80 + 20 * std::sqrt(5.0) + 2, 2.5);
}

TEST(Clean, LeavesPathsApartThatSoonPartOrDifferInRadius) {
  const auto two = [](double slope, double radius) {
    std::vector<CenterlineNode> first, second;
    for (int i = 0; i <= 40; ++i) {
      first.push_back(node(0.5 * i, 0, 2));
      second.push_back(node(0.5 * i, slope * i, i == 0 ? 2 : radius));
    }
    return clean(polylines({first, second})).report.count(Action::merged_overlap);
  };
  EXPECT_EQ(two(0.05, 2), 0u);  // side by side for one radius
  EXPECT_EQ(two(0.01, 1.5), 0u);
  EXPECT_EQ(two(0.001, 2), 1u);
}

TEST(Clean, JoinsABranchThatStopsShortOfItsParent) {
  std::vector<CenterlineNode> parent, child, sibling, far;
  for (int i = 0; i <= 20; ++i) parent.push_back(node(i, 0, 3));
  for (int i = 0; i <= 10; ++i) {
    child.push_back(node(10, 2 + i, 1));
    sibling.push_back(node(10.5, 2 + i, 1));  // starts nearer to the child than to the parent
    far.push_back(node(15, -3.5 - i, 1));     // outside the parent's radius
  }
  const auto raw = polylines({parent, child, sibling, far});
  const auto result = clean(raw);
  EXPECT_EQ(result.centerline.component_count(), 2u);
  EXPECT_EQ(result.centerline.cycle_rank(), 0u);
  ASSERT_EQ(result.report.count(Action::joined_gap), 2u);
  for (const auto& action : result.report.actions) {
    EXPECT_TRUE(action.index == 21 || action.index == 32) << action.message;
    EXPECT_NE(action.message.find("line 10"), std::string::npos) << action.message;
  }
  EXPECT_EQ(std::count(result.raw_segment.begin(), result.raw_segment.end(), kNone), 2);
  CleaningOptions apart;
  apart.join_gaps = false;
  EXPECT_EQ(clean(raw, apart).centerline.component_count(), 4u);
}

TEST(Clean, DoesNotJoinTipsThatOnlyTouchAnotherVessel) {
  std::vector<CenterlineNode> parent, child, other;
  for (int i = 0; i <= 20; ++i) {
    parent.push_back(node(i, 0, 2));
    other.push_back(node(i, 12, 2));
  }
  for (int i = 0; i <= 10; ++i) child.push_back(node(10, 1 + i, 1));  // its tip lies within `other`
  const auto result = clean(polylines({parent, child, other}));
  EXPECT_EQ(result.centerline.component_count(), 2u);
}

TEST(Clean, RoundsSoThatTextAndBinaryGiveTheSameTree) {
  const auto text = clean(raw_of({node(0.123457, 0, 1), node(5, 0.654321, 1)}, {{0, 1}}));
  const auto binary = clean(raw_of({node(0.12345678, 0, 1.0000003), node(5.00000011, 0.65432123, 1)}, {{0, 1}}));
  expect_same(text.centerline, binary.centerline);
  EXPECT_EQ(binary.report.count(Action::rounded), 1u);
  EXPECT_TRUE(text.report.actions.empty());
}

TEST(Clean, KeepsTheDigitsOfTinyVessels) {
  const auto result = clean(raw_of({node(0, 0, 1e-6), node(1.2345678e-4, 0, 1e-6)}, {{0, 1}}));
  EXPECT_NEAR(result.centerline.length(0), 1.2345678e-4, 1e-10);
}

TEST(Clean, KeepsRadiiThatAreNextToNothing) {
  const double least = 5e-324;  // there is no smaller number
  const auto result = clean(raw_of({node(0, 0, least), node(9, 0, 1)}, {{0, 1}}));
  EXPECT_EQ(std::min(result.centerline.node(0).radius, result.centerline.node(1).radius), least);
}

TEST(Clean, RefusesLengthsWhoseSquaresOverflow) {
  for (const double large : {1e31, 1e200, -1e200}) {
    const std::string problem =
        message_of_failure(raw_of({node(0, 0, 1), node(large, 0, 0), node(9, 0, 1)}, {{0, 1}, {1, 2}}));
    EXPECT_NE(problem.find("test.swc: line 1"), std::string::npos) << problem;
    EXPECT_NE(problem.find("check the unit"), std::string::npos) << problem;
  }
  EXPECT_THROW(clean(raw_of({node(0, 0, 1e31), node(9, 0, 1)}, {{0, 1}})), InvalidInput);
}

TEST(Clean, OrdersByGeometryNotByFile) {
  std::mt19937 random(7);
  std::vector<CenterlineNode> nodes = {node(0, 0, 4)};
  std::vector<CenterlineSegment> segments;
  for (Index i = 1; i < 200; ++i) {
    const Index parent = static_cast<Index>(random() % i);
    const auto offset = [&] { return static_cast<double>(random() % 1000) / 100 + 0.5; };
    nodes.push_back(
        {nodes[parent].position + Vec3(offset(), offset(), -offset()), 0.5 + static_cast<double>(random() % 5) * 0.25});
    segments.push_back({parent, i});
  }
  segments.push_back({17, 150});  // a loop
  const auto reference = clean(raw_of(nodes, segments));
  std::vector<Index> place(nodes.size());
  for (Index i = 0; i < place.size(); ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), random);
  std::vector<CenterlineNode> shuffled(nodes.size());
  for (Index i = 0; i < nodes.size(); ++i) shuffled[place[i]] = nodes[i];
  for (auto& s : segments)
    s = random() % 2 ? CenterlineSegment{place[s.a], place[s.b]} : CenterlineSegment{place[s.b], place[s.a]};
  std::shuffle(segments.begin(), segments.end(), random);
  const auto other = clean(raw_of(shuffled, segments));
  expect_same(reference.centerline, other.centerline);
  for (Index n = 0; n < nodes.size(); ++n) {
    EXPECT_LT((other.centerline.node(n).position - shuffled[other.raw_node[n]].position).norm(), 1e-6);
  }
  const auto& first = reference.centerline;
  for (Index n = 1; n < nodes.size(); ++n) {
    if (first.degree(n) == 1) {
      EXPECT_LE(first.node(n).radius, first.node(0).radius) << "it starts at the thickest end";
    }
  }
  for (const auto& s : first.segments()) EXPECT_LT(s.a, s.b);
}

TEST(Clean, KeepsTheOrderOfTheFileWhenAsked) {
  CleaningOptions options;
  options.canonical_order = false;
  const auto result = clean(raw_of({node(9, 0, 1), node(5, 0, 3), node(0, 0, 2)}, {{2, 1}, {1, 0}}), options);
  EXPECT_EQ(result.raw_node, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(result.centerline.segment(0).a, 2u);
}

TEST(Clean, IsIdempotent) {
  std::vector<CenterlineNode> line, branch;
  for (int i = 0; i <= 20; ++i) line.push_back(node(i * 1.00000012, 0, 2));
  for (int i = 0; i <= 10; ++i) branch.push_back(node(10, 1 + i, i == 3 ? 0 : 1));
  const auto once = clean(polylines({line, line, branch}));
  const auto twice = clean(raw_of(once.centerline.nodes(), once.centerline.segments()));
  EXPECT_FALSE(once.report.actions.empty());
  EXPECT_TRUE(twice.report.actions.empty());
  expect_same(once.centerline, twice.centerline);
}

TEST(Clean, NamesFileAndLineOfWhatItCannotMend) {
  const double nan = std::nan("");
  EXPECT_NE(message_of_failure(raw_of({node(0, 0, 1), node(nan, 0, 1)}, {})).find("test.swc: line 1: the position"),
            std::string::npos);
  EXPECT_NE(message_of_failure(raw_of({node(0, 0, HUGE_VAL)}, {})).find("test.swc: line 0: the radius"),
            std::string::npos);
  EXPECT_NE(message_of_failure(raw_of({node(0, 0, -2)}, {})).find("-2 is negative"), std::string::npos);
  EXPECT_NE(message_of_failure(raw_of({node(0, 0, 1)}, {{0, 4}})).find("segment 0"), std::string::npos);
  EXPECT_NE(message_of_failure(raw_of({}, {})).find("no point"), std::string::npos);
  auto unconverted = raw_of({node(0, 0, 1)}, {});
  unconverted.unit = LengthUnit::cm;
  EXPECT_NE(message_of_failure(unconverted).find("mm and LPS"), std::string::npos);
}

TEST(Clean, SummarizesWithOneLinePerKind) {
  const auto result = clean(raw_of({node(0, 0, 1), node(5, 0, 1)}, {{0, 0}, {1, 1}, {0, 1}}));
  const auto lines = result.report.summary();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("1 more"), std::string::npos) << lines[0];
}

// Every one of these would take hours at quadratic cost; the test's time limit is the check.
TEST(CleanAtScale, AMillionNodesInALine) {
  std::vector<CenterlineNode> line;
  for (int i = 0; i < 1000000; ++i) line.push_back(node(i, 0, i % 7 == 0 ? 0 : 2));
  const auto result = clean(polylines({line, line}));
  EXPECT_EQ(result.centerline.nodes().size(), 1000000u);
}

TEST(CleanAtScale, AMillionNodesAtOnePlace) {
  std::vector<CenterlineNode> nodes(1000000, node(1, 1, 1));
  EXPECT_EQ(clean(raw_of(nodes, {})).centerline.nodes().size(), 1u);
}

TEST(CleanAtScale, AStarOfLooseBranches) {
  std::vector<std::vector<CenterlineNode>> lines;
  for (int i = 0; i < 100000; ++i) {
    const double x = std::cos(i), y = std::sin(i);
    lines.push_back({{{0, 0, 0}, 5}, {{9 * x, 9 * y, 0}, 1}, {{20 * x, 20 * y, i * 1e-3}, 1}});
  }
  EXPECT_EQ(clean(polylines(lines)).centerline.component_count(), 1u);
}

TEST(CleanAtScale, ScatteredSpheresUnderOneHugeOne) {
  std::mt19937 random(1);
  std::vector<std::vector<CenterlineNode>> lines;
  const auto coordinate = [&] { return static_cast<double>(random() % 1000000) / 10; };
  for (int i = 0; i < 100000; ++i) {
    const double x = coordinate(), y = coordinate();
    lines.push_back({node(x, y, 1e-3), node(x + 0.1, y, 1e-3)});
  }
  lines.push_back({node(0, 0, 1e4), node(1, 0, 1e4)});
  CleaningOptions options;
  options.join_gaps = true;
  EXPECT_LT(clean(polylines(lines), options).centerline.component_count(), 100000u);
}

EndSection flat_end(Index n, const Vec3& center, double area = 3) { return {n, center, {2, 0, 0}, area, {}, true}; }

TEST(CleanFlatEnds, FollowTheirNodes) {
  // Node 3 is where node 2 is, and merged into it; the thickest end comes first.
  RawCenterline raw = raw_of({node(0, 0, 1), node(4, 0, 1), node(8, 0, 2), node(8, 0, 2)}, {{0, 1}, {1, 2}, {2, 3}});
  raw.end_sections = {flat_end(0, {0, 0.1, 0}), flat_end(3, {8, 0, 0})};
  const CleanedCenterline cleaned = clean(raw);
  EXPECT_EQ(cleaned.report.count(Action::dropped_end_section), 0u);
  ASSERT_EQ(cleaned.end_sections.size(), 2u);
  EXPECT_EQ(cleaned.end_sections[0].node, 0u);
  EXPECT_EQ(cleaned.end_sections[0].center, Vec3(8, 0, 0));
  EXPECT_EQ(cleaned.end_sections[0].normal, Vec3(1, 0, 0));
  EXPECT_EQ(cleaned.end_sections[1].node, 2u);
  EXPECT_EQ(cleaned.end_sections[1].center, Vec3(0, 0.1, 0));
}

TEST(CleanFlatEnds, AreDroppedWhereNoVesselEnds) {
  RawCenterline raw = raw_of({node(0, 0, 1), node(4, 0, 1), node(8, 0, 1)}, {{0, 1}, {1, 2}});
  raw.end_sections = {flat_end(1, {4, 0, 0}), flat_end(2, {8, 0, 0}), flat_end(2, {8, 0.1, 0}), flat_end(0, {0, 2, 0})};
  const CleanedCenterline cleaned = clean(raw);
  ASSERT_EQ(cleaned.end_sections.size(), 1u);
  EXPECT_EQ(cleaned.end_sections[0].center, Vec3(8, 0, 0));
  ASSERT_EQ(cleaned.report.count(Action::dropped_end_section), 3u);
  EXPECT_EQ(cleaned.report.actions[0].message, "test.swc: line 1: its flat end was dropped: no vessel ends there");
  EXPECT_EQ(cleaned.report.actions[1].index, 2u);
  EXPECT_EQ(to_string(cleaned.report.actions[2].kind), "dropped_end_section");
  EXPECT_NE(cleaned.report.summary().back().find("and 2 more"), std::string::npos);
}

TEST(CleanFlatEnds, ThatAreWrongAreRefused) {
  RawCenterline raw = raw_of({node(0, 0, 1), node(4, 0, 1)}, {{0, 1}});
  for (const EndSection& section : {flat_end(2, {0, 0, 0}), flat_end(0, {0, 0, 0}, -1), flat_end(0, {0, 0, 1e40})}) {
    raw.end_sections = {section};
    EXPECT_NE(message_of_failure(raw).find("test.swc: flat end 0: "), std::string::npos) << message_of_failure(raw);
  }
}

}  // namespace
}  // namespace vmesh
