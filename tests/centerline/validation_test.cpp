#include "vmesh/centerline/validation.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

using Kind = CenterlineProblem::Kind;
using Element = CenterlineProblem::Element;

CenterlineNode node(double x, double r) { return {{x, 0, 0}, r}; }

TEST(Validate, FindsNothingWrongWithAValidGraph) {
  EXPECT_TRUE(validate({node(0, 1), node(1, 1)}, {{0, 1}}).empty());
  EXPECT_TRUE(validate({node(0, 1)}, {}).empty());
}

TEST(Validate, ListsEveryProblemWithItsElement) {
  const double nan = std::nan(""), inf = HUGE_VAL;
  const auto problems = validate({node(0, 1), node(nan, 1), node(2, inf), node(3, 0), node(4, -1), node(0, 1)},
                                 {{0, 9}, {3, 3}, {0, 5}, {2, 3}, {3, 2}, {9, 9}});
  const std::vector<std::tuple<Kind, Element, Index>> expected = {
      {Kind::non_finite_position, Element::node, 1},    {Kind::non_finite_radius, Element::node, 2},
      {Kind::non_positive_radius, Element::node, 3},    {Kind::non_positive_radius, Element::node, 4},
      {Kind::unknown_node, Element::segment, 0},        {Kind::self_loop, Element::segment, 1},
      {Kind::zero_length_segment, Element::segment, 2}, {Kind::duplicate_segment, Element::segment, 4},
      {Kind::unknown_node, Element::segment, 5}};
  ASSERT_EQ(problems.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::tuple(problems[i].kind, problems[i].element, problems[i].index), expected[i]) << i;
    const std::string name =
        (problems[i].element == Element::node ? "node " : "segment ") + std::to_string(problems[i].index);
    EXPECT_EQ(problems[i].message.find(name), 0u) << problems[i].message;
  }
  EXPECT_NE(problems[7].message.find("segment 3"), std::string::npos) << problems[7].message;
}

TEST(Validate, AsksForAtLeastOneNode) {
  const auto problems = validate({}, {});
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].kind, Kind::no_nodes);
  EXPECT_EQ(problems[0].index, kNone);
}

}  // namespace
}  // namespace vmesh
