#include "vmesh/tuning/budget.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/synth/synthetic_tree.h"

#include "centerlines.h"
#include "shared_data.h"

namespace vmesh {
namespace {

std::string message_for(const std::string& text) {
  try {
    parse_budget(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

bool same_surface(const TriMesh& a, const TriMesh& b) { return a.vertices == b.vertices && a.faces == b.faces; }

TEST(ParseBudget, TakesWhatItPrints) {
  EXPECT_EQ(parse_budget("vertices=5000").vertices, 5000u);
  EXPECT_EQ(parse_budget("time=50ms").kind, Budget::Kind::time);
  EXPECT_DOUBLE_EQ(parse_budget("time=50ms").seconds, 0.05);
  EXPECT_DOUBLE_EQ(parse_budget("time=2s").seconds, 2);
  EXPECT_EQ(parse_budget("error=0.2mm").error.mm, 0.2);
  EXPECT_EQ(parse_budget("error=5%").error.relative, 0.05);
  for (const char* text : {"vertices=5000", "time=50ms", "error=0.2mm", "error=5%", "error=0.1mm,12.345678901%"})
    EXPECT_EQ(to_string(parse_budget(text)), text);
}

TEST(ParseBudget, RefusesTheRest) {
  for (const char* text : {"", "vertices", "vertices=", "vertices=-5", "vertices=0", "vertices=5mm", "vertices=nan",
                           "time=5", "time=0ms", "time=1h", "error=", "error=5", "error=-1mm", "faces=100", "=5"}) {
    EXPECT_NE(message_for(text), "") << text;
  }
  EXPECT_NE(message_for("faces=100").find("vertices=5000"), std::string::npos);  // says what would do
}

class VertexBudget : public ::testing::TestWithParam<std::size_t> {};

TEST_P(VertexBudget, GivesTheFinestSurfaceWithin) {
  Budget budget;
  budget.vertices = GetParam();
  const Centerline fork = testing::fork();
  const BudgetedSurface surface = generate_within(budget, fork);
  ASSERT_TRUE(surface.met());
  EXPECT_LE(surface.result.mesh.vertices.size(), budget.vertices);
  EXPECT_EQ(surface.result.mesh.vertices.size(), surface.choice().vertices);
  EXPECT_GE(surface.result.mesh.vertices.size(), 0.95 * static_cast<double>(budget.vertices));
  EXPECT_TRUE(surface.result.is_sound());
  EXPECT_TRUE(same_surface(generate_surface(fork, surface.choice().options).mesh, surface.result.mesh));
}

TEST(BudgetOfVertices, WithLongTrianglesLeavesVerticesOutOfAFinerSurface) {
  Budget budget;
  budget.vertices = 120;
  const Centerline fork = testing::fork();
  const BudgetedSurface even = generate_within(budget, fork);
  GenerateOptions options;
  options.elongation = 16;
  const BudgetedSurface surface = generate_within(budget, fork, options);
  ASSERT_TRUE(surface.met());
  EXPECT_TRUE(surface.result.is_sound());
  EXPECT_EQ(surface.result.error.unproven_faces, 0u);
  EXPECT_LE(surface.result.mesh.vertices.size(), budget.vertices);
  EXPECT_LT(2 * surface.choice().error.mean_mm, even.choice().error.mean_mm);
  EXPECT_TRUE(same_surface(generate_surface(fork, surface.choice().options).mesh, surface.result.mesh));
  options.deformable = true;  // the finest with a ring at every node
  const BudgetedSurface deformable = generate_within(budget, fork, options);
  EXPECT_EQ(deformable.choice().options.least_vertices, 0u);
  EXPECT_LE(deformable.result.mesh.vertices.size(), budget.vertices);
}

INSTANTIATE_TEST_SUITE_P(Budget, VertexBudget, ::testing::Values(90, 200, 1000, 10'000));

TEST(BudgetOfVertices, TellsTheNeighboursToo) {
  Budget budget;
  budget.vertices = 500;
  const BudgetedSurface surface = generate_within(budget, testing::fork());
  std::vector<OperatingPoint> even;
  for (const OperatingPoint& point : surface.tried) {
    if (point.options.ring_spacing == 1) even.push_back(point);
  }
  const auto beyond = std::find_if(even.begin(), even.end(), [](const auto& point) { return !point.within_budget; });
  ASSERT_NE(beyond, even.begin());
  ASSERT_NE(beyond, even.end());
  EXPECT_EQ(beyond->options.around, (beyond - 1)->options.around + 1);
  EXPECT_GE(beyond->options.around, surface.choice().options.around);
  EXPECT_LE((beyond - 1)->options.around, surface.choice().options.around);
}

// Above what even triangles need, any number is met within 5 %, whatever the tree.
TEST(BudgetOfVertices, IsMetBetweenWholeNumbersAround) {
  for (const Index vertices : {200, 400}) {
    SyntheticTreeOptions tree;
    tree.vertices = vertices;
    tree.seed = vertices;
    const Centerline centerline = synthetic_tree(tree);
    GenerateOptions even;
    even.around = 3;
    const std::size_t least = generate_surface(centerline, even).mesh.vertices.size();
    for (const double times : {0.95, 1.05, 1.15, 1.25, 1.6, 2.5}) {
      Budget budget;
      budget.vertices = static_cast<std::size_t>(times * static_cast<double>(least));
      const BudgetedSurface surface = generate_within(budget, centerline);
      EXPECT_TRUE(surface.met()) << times;
      EXPECT_TRUE(surface.result.is_sound()) << times;
      EXPECT_GE(surface.result.mesh.vertices.size(), 0.95 * static_cast<double>(budget.vertices)) << times;
      EXPECT_LT(surface.choice().skewness.mean, 0.173) << times;  // of triangles stretched by 1.25
    }
  }
}

TEST(BudgetOfVertices, ThatNothingKeepsIsNotMet) {
  Budget budget;
  budget.vertices = 10;
  const BudgetedSurface surface = generate_within(budget, testing::fork());
  EXPECT_FALSE(surface.met());
  EXPECT_EQ(surface.choice().options.around, 3);
  EXPECT_FALSE(surface.result.mesh.faces.empty());
}

TEST(BudgetOfVertices, IsBoundByMaxVerticesInsteadOfRefused) {
  Budget budget;
  budget.vertices = 1'000'000'000;
  GenerateOptions options;
  options.max_vertices = 3000;
  const BudgetedSurface surface = generate_within(budget, testing::fork(), options);
  EXPECT_TRUE(surface.met());
  EXPECT_LE(surface.result.mesh.vertices.size(), 3000u);
}

TEST(BudgetOfError, IsKeptWithTheFewestVertices) {
  const Budget budget = parse_budget("error=0.1mm");
  const BudgetedSurface surface = generate_within(budget, testing::fork());
  ASSERT_TRUE(surface.met());
  EXPECT_EQ(surface.result.error.unproven_faces, 0u);
  EXPECT_LE(surface.choice().error.max_mm, 0.1);
  EXPECT_EQ(surface.choice().options.max_error.mm, 0.1);
  for (const OperatingPoint& point : surface.tried) {
    EXPECT_TRUE(!point.within_budget || point.vertices >= surface.choice().vertices);
  }
  EXPECT_TRUE(same_surface(generate_surface(testing::fork(), surface.choice().options).mesh, surface.result.mesh));
}

TEST(BudgetOfTime, IsMetOrNot) {
  // An hour is enough for what may be refined 200 vertices around at most; a nanosecond is not enough for anything.
  GenerateOptions options;
  options.max_vertices = 2000;
  const BudgetedSurface ample = generate_within(parse_budget("time=3600s"), testing::straight_tube(), options);
  EXPECT_TRUE(ample.met());
  EXPECT_GT(ample.choice().options.around, 6);
  const BudgetedSurface none = generate_within(parse_budget("time=0.000001ms"), testing::fork());
  EXPECT_FALSE(none.met());
  EXPECT_FALSE(none.result.mesh.faces.empty());
}

class BudgetOfRealTree : public ::testing::TestWithParam<const char*> {};

TEST_P(BudgetOfRealTree, IsMetOrSaidNotToBe) {
  const std::string file = std::string("liver_portal_centerlines/liverModelPatient1__") + GetParam() + "_1.swc";
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load_centerline(testing::shared_data(file)).cleaned.centerline;
  Budget budget;
  budget.vertices = 5000;
  const BudgetedSurface surface = generate_within(budget, centerline);
  EXPECT_EQ(surface.met(), surface.result.mesh.vertices.size() <= budget.vertices);
  EXPECT_TRUE(surface.met() || surface.choice().options.around == 3);
}

INSTANTIATE_TEST_SUITE_P(TenTrees, BudgetOfRealTree,
                         ::testing::Values("portal1", "portal3", "portal15", "hepatic1", "hepatic3", "hepatic15",
                                           "arterial15", "vessel_portal", "vessel_hepatic", "vessel_arterial"));

}  // namespace
}  // namespace vmesh
