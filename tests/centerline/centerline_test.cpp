#include "vmesh/centerline/centerline.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

CenterlineNode node(double x, double y, double z, double r) { return {{x, y, z}, r}; }

TEST(Centerline, KnowsIncidenceComponentsAndLoops) {
  const Centerline c({node(0, 0, 0, 1), node(4, 0, 0, 1), node(4, 3, 0, 2), node(9, 9, 9, 1), node(0, 3, 0, 1)},
                     {{0, 1}, {1, 2}, {2, 4}, {4, 0}});
  EXPECT_EQ(c.degree(0), 2u);
  EXPECT_EQ(c.degree(3), 0u);
  EXPECT_EQ(std::vector<Index>(c.incident_segments(0).begin(), c.incident_segments(0).end()),
            (std::vector<Index>{0, 3}));
  EXPECT_EQ(c.other_node(3, 0), 4u);
  EXPECT_EQ(c.component_count(), 2u);
  EXPECT_EQ(c.component_of_node(), (std::vector<Index>{0, 0, 0, 1, 0}));
  EXPECT_EQ(c.cycle_rank(), 1u);
}

TEST(Centerline, MeasuresSegments) {
  const Centerline c({node(0, 0, 0, 1), node(4, 0, 0, 3)}, {{0, 1}});
  EXPECT_DOUBLE_EQ(c.length(0), 4);
  EXPECT_DOUBLE_EQ(c.radius_at(0, 0.25), 1.5);
  EXPECT_TRUE(c.point_at(0, 0.25).isApprox(Vec3(1, 0, 0)));
  EXPECT_DOUBLE_EQ(c.length_in_radii(), 2);
}

TEST(Centerline, RefusesAnInvalidGraphAndSaysEverythingThatIsWrong) {
  try {
    Centerline({node(0, 0, 0, 0), node(1, 0, 0, 1)}, {{0, 1}, {1, 7}});
    FAIL() << "no exception";
  } catch (const InvalidInput& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("2 problems"), std::string::npos) << text;
    EXPECT_NE(text.find("node 0"), std::string::npos) << text;
    EXPECT_NE(text.find("there is no node 7"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace vmesh
