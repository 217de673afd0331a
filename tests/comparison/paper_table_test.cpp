#include "vmesh/comparison/paper_table.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

using enum SurfaceMethod;

/// A comparison that has the paper's figures.
MethodComparison as_printed() {
  MethodComparison comparison;
  comparison.rows.resize(4);
  for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
    MethodRow& row = comparison.rows[i];
    row.method = static_cast<SurfaceMethod>(i);
    const PaperRow& paper = paper_row(row.method);
    row.mesh.vertices.resize(paper.vertices);
    row.skewness = {paper.skewness_mean, paper.skewness_max};
    if (!paper.hausdorff_mm) continue;
    row.distance.emplace();
    for (OneSidedHausdorff* side : {&row.distance->hausdorff.forward, &row.distance->hausdorff.backward})
      side->lower = side->upper = *paper.hausdorff_mm;
  }
  return comparison;
}

MethodRow& row_of(MethodComparison& comparison, SurfaceMethod method) {
  return comparison.rows[static_cast<std::size_t>(method)];
}

std::vector<bool> met(const MethodComparison& comparison) {
  std::vector<bool> result;
  for (const TableDemand& demand : check_demands(comparison)) result.push_back(demand.met());
  return result;
}

/// A comparison that meets all requirements, exactly at the limit where equality is allowed.
MethodComparison just_good_enough() {
  MethodComparison comparison = as_printed();
  row_of(comparison, marching_cubes).mesh.vertices.resize(10'000);
  row_of(comparison, truncated_cones).mesh.vertices.resize(6'500);
  MethodRow& low = row_of(comparison, low_resolution);
  low.mesh.vertices.resize(1'300);
  low.skewness = {0.1199, 0.4999};
  low.distance = comparison.row(truncated_cones).distance;
  return comparison;
}

TEST(PaperTable, FindsNothingWorseInThePaperItself) {
  const std::vector<PaperFigure> figures = compare_with_paper(as_printed());
  EXPECT_EQ(figures.size(), 4u * 2 + 3 + 2 * 2);
  for (const PaperFigure& figure : figures) EXPECT_FALSE(figure.worse()) << figure.what;
}

TEST(PaperTable, SharesAreThoseThatThePaperStates) {
  // "20% of the vertices are used compared to truncated cones and 13% compared with marching cubes"
  for (const PaperFigure& figure : compare_with_paper(as_printed())) {
    if (figure.method != low_resolution || !figure.what.starts_with("vertices")) continue;
    EXPECT_NEAR(figure.paper, figure.what.ends_with("cones") ? 0.20 : 0.13, 0.005);
  }
}

TEST(PaperTable, NamesWhatIsWorse) {
  MethodComparison comparison = as_printed();
  comparison.rows.push_back(comparison.row(low_resolution));  // the preset is not in the paper
  comparison.rows.back().method = low_preset;
  row_of(comparison, high_resolution).skewness.max = 0.985;
  row_of(comparison, low_resolution).distance->hausdorff.backward.upper = 7.68;
  std::vector<PaperFigure> figures = compare_with_paper(comparison);
  std::erase_if(figures, [](const PaperFigure& figure) { return !figure.worse(); });
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_EQ(figures[0].method, low_resolution);
  EXPECT_EQ(figures[0].ours, 7.68);
  EXPECT_EQ(figures[0].paper, 7.67);
  EXPECT_EQ(figures[1].method, high_resolution);
  EXPECT_EQ(figures[1].what, "maximum skewness");
}

TEST(TableDemands, HoldAtTheirLimitsOrBelow) {
  EXPECT_EQ(met(just_good_enough()), (std::vector<bool>{true, true, true, true, true, true}));
}

TEST(TableDemands, FailOneByOne) {
  MethodComparison comparison = just_good_enough();
  row_of(comparison, marching_cubes).mesh.vertices.resize(9'999);
  EXPECT_EQ(met(comparison), (std::vector<bool>{false, true, true, true, true, true}));
  comparison = just_good_enough();
  row_of(comparison, truncated_cones).mesh.vertices.resize(6'499);
  EXPECT_EQ(met(comparison), (std::vector<bool>{true, false, true, true, true, true}));
  comparison = just_good_enough();
  row_of(comparison, low_resolution).skewness.mean = 0.12;
  EXPECT_EQ(met(comparison), (std::vector<bool>{true, true, false, true, true, true}));
  comparison = just_good_enough();
  row_of(comparison, low_resolution).skewness.max = 0.5;
  EXPECT_EQ(met(comparison), (std::vector<bool>{true, true, true, false, true, true}));
}

TEST(TableDemands, TakeTheUpperBoundAgainstTheLowerOne) {
  MethodComparison comparison = just_good_enough();
  row_of(comparison, low_resolution).distance->hausdorff.forward.upper += 1e-4;
  EXPECT_EQ(met(comparison), (std::vector<bool>{true, true, true, true, false, true}));
  comparison = just_good_enough();
  row_of(comparison, truncated_cones).distance->hausdorff.backward.lower -= 1e-4;
  EXPECT_EQ(met(comparison), (std::vector<bool>{true, true, true, true, true, false}));
}

}  // namespace
}  // namespace vmesh
