#include "vmesh/tuning/tradeoff.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/reference/cones.h"
#include "vmesh/tuning/plot.h"

#include "centerlines.h"
#include "tuning/decimation.h"

namespace vmesh {
namespace {

TradeoffPoint point(const std::string& curve, double seconds, std::size_t vertices, double mean, double max) {
  TradeoffPoint p;
  p.curve = curve;
  p.seconds = seconds;
  p.vertices = vertices;
  p.error_mean_mm = mean;
  p.error_max_mm = max;
  p.skewness_mean = mean;
  return p;
}

TEST(MarkBest, LeavesOutWhatAnotherPointBeats) {
  std::vector<TradeoffPoint> points = {point("a", 1, 100, 0.1, 1), point("a", 2, 90, 0.2, 1),
                                       point("b", 2, 400, 0.05, 1), point("b", 1, 100, 0.1, 1)};
  mark_best(points);
  EXPECT_TRUE(points[0].best_for_time);
  EXPECT_FALSE(points[1].best_for_time);  // slower and worse than the first
  EXPECT_TRUE(points[1].best_for_vertices);
  EXPECT_TRUE(points[2].best_for_time);
  EXPECT_TRUE(points[3].best_for_time && points[3].best_for_vertices);  // equal ones are both best
}

TEST(CompareCurves, ReadsBetweenPointsOnLogarithmicScales) {
  const std::vector<TradeoffPoint> points = {point("ours", 1, 100, 0.4, 0.8), point("ours", 1, 10'000, 0.004, 0.008),
                                             point("theirs", 1, 1000, 0.1, 0.08), point("theirs", 1, 50, 1, 10)};
  const std::vector<CurveComparison> read = compare_curves(points, "ours", "theirs");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_NEAR(read[0].our_error_mean_mm, 0.04, 1e-12);  // half way, each a hundredfold
  EXPECT_NEAR(read[0].our_vertices, 1000, 1e-9);
  EXPECT_TRUE(std::isnan(read[1].our_error_mean_mm));  // fewer vertices than any of ours
  EXPECT_TRUE(std::isnan(read[1].our_vertices));
}

TEST(Decimated, KeepsTheSurfaceWithFewerVertices) {
  const Centerline tube = testing::straight_tube();
  GenerateOptions fine;
  fine.around = 24;
  const TriMesh mesh = generate_surface(tube, fine).mesh;
  // Volume is what the first is to keep. Quadrics put vertices where planes meet: a hexagon around a circle has 1.10 of
  // its area.
  for (const auto& [order, tolerance] : {std::pair(Decimation::volume, 0.01), {Decimation::quadrics, 0.1}}) {
    const TriMesh coarse = decimated(mesh, 300, order);
    EXPECT_NEAR(static_cast<double>(coarse.vertices.size()), 300, 5);
    const Topology topology = measure_topology(coarse);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
    EXPECT_NEAR(enclosed_volume(coarse), enclosed_volume(mesh), tolerance * enclosed_volume(mesh));
  }
}

class SweptTube : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    TradeoffOptions options;
    options.samples = 2000;
    points_ = sweep_tradeoff(testing::straight_tube(), options, [](std::string_view stage, double fraction) {
      stages_.emplace(stage);
      fractions_.push_back(fraction);
      return true;
    });
  }
  static std::vector<TradeoffPoint> curve(const std::string& name) {
    std::vector<TradeoffPoint> points;
    std::copy_if(points_.begin(), points_.end(), std::back_inserter(points),
                 [&](const TradeoffPoint& p) { return p.curve == name; });
    return points;
  }
  static inline std::vector<TradeoffPoint> points_;
  static inline std::set<std::string> stages_;
  static inline std::vector<double> fractions_;
};

TEST_F(SweptTube, HasOneProgressFromBeginToEnd) {
  EXPECT_EQ(stages_.size(), 1u);
  EXPECT_EQ(fractions_.front(), 0);
  EXPECT_EQ(fractions_.back(), 1);
  for (std::size_t i = 1; i < fractions_.size(); ++i) {
    EXPECT_GE(fractions_[i], fractions_[i - 1]);
    EXPECT_LT(fractions_[i], fractions_[i - 1] + 0.05);  // about a hundred cases
  }
}

TEST_F(SweptTube, FinerIsCloser) {
  const std::vector<TradeoffPoint> around = curve("around");
  ASSERT_EQ(around.size(), 9u);
  for (std::size_t i = 1; i < around.size(); ++i) {
    EXPECT_GT(around[i].vertices, around[i - 1].vertices);
    EXPECT_LT(around[i].error_mean_mm, around[i - 1].error_mean_mm);
    EXPECT_TRUE(around[i].sound);
  }
}

// From 12 to 24 to 48 to 96, each doubling divides the mean distance by about four, as what edges cut off.
TEST(Sweep, HasAnAccurateEndOnRequest) {
  TradeoffOptions options;
  options.samples = 2000;
  options.beta = options.max_error = options.blend = options.effort = options.marching_cubes = options.cones = false;
  options.fine = true;
  const std::vector<TradeoffPoint> points = sweep_tradeoff(testing::straight_tube(), options);
  ASSERT_EQ(points.size(), 2 * 14u);
  const auto at = [&](const std::string& setting) {
    return std::find_if(points.begin(), points.end(),
                        [&](const TradeoffPoint& p) { return p.curve == "around" && p.setting == setting; })
        ->error_mean_mm;
  };
  EXPECT_GT(at("12") / at("24"), 3);
  EXPECT_GT(at("24") / at("48"), 3);
  EXPECT_GT(at("48") / at("96"), 3);
}

TEST_F(SweptTube, LimitsHold) {
  const double limits[] = {0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05};
  const std::vector<TradeoffPoint> points = curve("max-error");
  ASSERT_EQ(points.size(), std::size(limits));
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LE(points[i].error_max_relative, limits[i]);
}

TEST_F(SweptTube, ConesAreThereAndNotSound) {
  ASSERT_EQ(curve("truncated cones").size(), 3u);
  EXPECT_EQ(curve("truncated cones").front().vertices,
            truncated_cones(testing::straight_tube(), 6).mesh.vertices.size());
  EXPECT_FALSE(curve("truncated cones").front().sound);  // they pierce each other
}

TEST_F(SweptTube, ABestPointHasAllBetterOnesAtAPrice) {
  for (const TradeoffPoint& best : points_) {
    if (!best.best_for_vertices) continue;
    for (const TradeoffPoint& other : points_) {
      EXPECT_TRUE(other.error_mean_mm >= best.error_mean_mm || other.vertices > best.vertices);
    }
  }
}

TEST(LogPlots, AreDrawnWithEveryPointThatALogarithmHas) {
  const LogPlot plot{"A <b> & c", "x", "y", {{"first", {{1, 10}, {10, 100}, {0, 5}}}, {"second", {{3, 30}}}}};
  const std::string svg = svg_of({plot, plot});
  const auto count = [&svg](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<circle"), 2u * 3 + 2);  // three points in each of two plots, two names in one legend
  EXPECT_EQ(count("<polyline"), 4u);
  EXPECT_NE(svg.find("A &lt;b> &amp; c"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg, svg_of({plot, plot}));
  EXPECT_EQ(svg_of({}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace vmesh
