// Triangles longer along vessels than around them.
#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/error_bound.h"
#include "vmesh/surface/metric_skewness.h"
#include "vmesh/synth/synthetic_tree.h"

#include "centerlines.h"
#include "surface/tubes/growth_skeleton.h"

namespace vmesh {
namespace {

constexpr double kRounding = 1e-9;

Centerline long_tube() { return {{{{0, 0, 0}, 1}, {{100, 0, 0}, 1}}, {{0, 1}}}; }

// A quarter of a circle of radius 20 between two straight arms, in `steps` segments.
Centerline bow(int steps) {
  std::vector<CenterlineNode> nodes = {{{-30, 20, 0}, 1}};
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i <= steps; ++i) {
    const double angle = M_PI / 2 * i / steps;
    nodes.push_back({{20 * std::sin(angle), 20 * std::cos(angle), 0}, 1});
  }
  nodes.push_back({{20, -30, 0}, 1});
  for (Index n = 0; n + 1 < nodes.size(); ++n) segments.push_back({n, static_cast<Index>(n + 1)});
  return {std::move(nodes), std::move(segments)};
}

struct Laid {
  Laid(Centerline c, const RingOptions& options)
      : centerline(std::move(c)), field(centerline, 0.5), tubes(field, options) {}

  // Ways from each ring of the first branch to the next.
  std::vector<double> pitches() const {
    std::vector<double> result;
    const auto& rings = tubes.rings(0);
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) result.push_back(rings[k + 1].place - rings[k].place);
    return result;
  }

  Centerline centerline;
  VesselField field;
  VesselRings tubes;
};

RingOptions elongated(double elongation) {
  RingOptions options{6};
  options.elongation = elongation;
  return options;
}

TEST(Elongation, RingsAreEvenWithout) {
  const Laid laid(long_tube(), elongated(1));
  for (const double pitch : laid.pitches()) EXPECT_NEAR(pitch, laid.pitches().front(), kRounding);
  EXPECT_EQ(laid.tubes.elongation_field(), nullptr);
}

TEST(Elongation, RingsOfAStraightTubeAreGraded) {
  for (const double elongation : {2.0, 4.0, 16.0}) {
    SCOPED_TRACE(elongation);
    const Laid laid(long_tube(), elongated(elongation));
    const std::vector<double> pitches = laid.pitches();
    const double even = 100 / std::round(100 / ring_pitch(6));
    // That a whole number of rings fits takes half a ring of all at most.
    const double fit = 1 + 0.5 / static_cast<double>(pitches.size() - 1);
    for (std::size_t k = 0; k < pitches.size(); ++k) {
      EXPECT_LE(pitches[k], fit * elongation * even);
      if (k > 0) {
        // Within one ring the elongation grows by a half at most, so that its mean does over two.
        EXPECT_LE(pitches[k], 1.55 * pitches[k - 1]);
        EXPECT_LE(pitches[k - 1], 1.55 * pitches[k]);
      }
    }
    EXPECT_LT(pitches.front(), 1.5 * even);
    EXPECT_LT(pitches.back(), 1.5 * even);
    EXPECT_GT(*std::max_element(pitches.begin(), pitches.end()), 0.9 * elongation * even);
    for (const Ring& ring : laid.tubes.rings(0)) EXPECT_TRUE(ring.free);
  }
}

TEST(Elongation, RingsOfABowAreCloserThanOfItsArms) {
  const Laid laid(bow(16), elongated(16));
  double on_bow = 0, on_arms = 0;
  const auto& rings = laid.tubes.rings(0);
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    const double from = rings[k].place, to = rings[k + 1].place;
    double& longest = from > 30 && to < 30 + 10 * M_PI ? on_bow : on_arms;
    longest = std::max(longest, to - from);
    // The chord's distance from the axis: no more than edges across cut off. Rings are elsewhere than where that was
    // found, next to where it may be a quarter more.
    const Vec3 middle = laid.tubes.axes()[0].at(0.5 * (from + to)).position;
    EXPECT_LT((0.5 * (rings[k].center + rings[k + 1].center) - middle).norm(), 1.25 * 0.149);
  }
  EXPECT_LT(1.5 * on_bow, on_arms);
}

TEST(Elongation, ThereIsARingAtEveryNodeOfWhatIsToMove) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index n = 0; n <= 20; ++n) nodes.push_back({{3.0 * n, 0, 0}, 1});
  for (Index n = 0; n < 20; ++n) segments.push_back({n, static_cast<Index>(n + 1)});
  RingOptions options = elongated(16);
  options.ring_per_node = true;
  const Laid laid({nodes, segments}, options);
  for (const double pitch : laid.pitches()) EXPECT_LT(pitch, 3 * 1.05);  // as many as fit
  EXPECT_GT(laid.pitches()[laid.pitches().size() / 2], 2.5);
}

GenerateOptions with_elongation(double elongation) {
  GenerateOptions options;
  options.elongation = elongation;
  return options;
}

TEST(Elongation, LongTubesTakeFarFewerVertices) {
  const GenerateResult even = generate_surface(long_tube()), result = generate_surface(long_tube(), with_elongation(8));
  ASSERT_TRUE(result.is_sound());
  EXPECT_LT(3 * result.mesh.vertices.size(), even.mesh.vertices.size());
  ASSERT_EQ(result.elongation.size(), result.mesh.vertices.size());
  double most = 0;
  for (const Vec3& e : result.elongation) most = std::max(most, e.norm());
  EXPECT_NEAR(most, 8, kRounding);
  const SkewnessSummary plain = summarize_skewness(result.mesh),
                        metric = summarize_skewness(metric_skewness(result.mesh, result.elongation));
  EXPECT_GT(plain.max, 0.6);   // atan(1 / 8) is 7 degrees: 0.88 where triangles are longest
  EXPECT_LT(metric.max, 0.3);  // the even tube has 0.25
}

TEST(Elongation, TreesStaySoundAndTakeFewerVertices) {
  SyntheticTreeOptions tree;
  tree.vertices = 60;
  for (tree.seed = 1; tree.seed <= 3; ++tree.seed) {
    SCOPED_TRACE(tree.seed);
    const Centerline centerline = synthetic_tree(tree);
    const GenerateResult even = generate_surface(centerline);
    ASSERT_TRUE(even.is_sound());
    GenerateOptions options = with_elongation(4);
    options.threads = 1;
    const GenerateResult result = generate_surface(centerline, options);
    EXPECT_TRUE(result.is_sound());
    EXPECT_LT(result.mesh.vertices.size(), even.mesh.vertices.size());
    EXPECT_LT(summarize_skewness(metric_skewness(result.mesh, result.elongation)).max, 0.5);
    options.threads = 2;
    const GenerateResult again = generate_surface(centerline, options);
    EXPECT_EQ(again.mesh.vertices, result.mesh.vertices);
    EXPECT_EQ(again.mesh.faces, result.mesh.faces);
  }
}

// Vertices are left out, and the limit is proven for what is left.
TEST(Elongation, LimitsOnTheErrorTakeFarFewerVertices) {
  const Centerline fork = testing::fork();
  const VesselField field(fork, GenerateOptions{}.blend);
  for (const bool open : {false, true}) {
    SCOPED_TRACE(open);
    GenerateOptions options = with_elongation(1);
    options.max_error.relative = 0.05;
    options.open_ends.all = open;
    options.threads = 1;
    const GenerateResult even = generate_surface(fork, options);
    options.elongation = 8;
    const GenerateResult result = generate_surface(fork, options);
    EXPECT_TRUE(result.is_sound());
    EXPECT_EQ(result.openings.size(), even.openings.size());
    EXPECT_LT(3 * result.mesh.vertices.size(), 2 * even.mesh.vertices.size());
    const std::size_t unproven = unproven_faces(result.mesh, result.binding, field, options.max_error).size();
    EXPECT_EQ(result.error.unproven_faces, unproven);
    if (open) {
      EXPECT_LE(unproven, even.error.unproven_faces);  // at rims
    } else {
      EXPECT_EQ(unproven, 0u);
    }
    EXPECT_LT(summarize_skewness(metric_skewness(result.mesh, result.elongation)).max, 0.75 + kRounding);
    options.threads = 2;
    const GenerateResult again = generate_surface(fork, options);
    EXPECT_EQ(again.mesh.vertices, result.mesh.vertices);
    EXPECT_EQ(again.mesh.faces, result.mesh.faces);
  }
}

// As many vertices as asked for, proven or not, and a smaller mean error than that of an even surface of as many.
TEST(Elongation, LeavesAsManyVerticesAsAskedForWhereTheyReduceTheError) {
  const Centerline fork = testing::fork();
  const VesselField field(fork, GenerateOptions{}.blend);
  GenerateOptions options = with_elongation(1);
  const GenerateResult even = generate_surface(fork, options);
  options = with_elongation(16);
  options.around = 20;
  options.threads = 1;
  options.least_vertices = even.mesh.vertices.size();
  for (const auto& [proven, open] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    SCOPED_TRACE(::testing::Message() << "proven " << proven << " open " << open);
    options.max_error.relative = proven ? 0.5 : ErrorLimit{}.relative;
    options.open_ends.all = open;
    const GenerateResult result = generate_surface(fork, options);
    EXPECT_TRUE(result.is_sound());
    EXPECT_EQ(result.error.unproven_faces, 0u);
    EXPECT_LT(summarize_skewness(metric_skewness(result.mesh, result.elongation)).max,
              (proven ? 0.75 : 0.86) + kRounding);
    options.threads = 3 - options.threads;
    const GenerateResult again = generate_surface(fork, options);
    EXPECT_EQ(again.mesh.vertices, result.mesh.vertices);
    EXPECT_EQ(again.mesh.faces, result.mesh.faces);
    if (open) continue;  // rims keep their vertices
    EXPECT_EQ(result.mesh.vertices.size(), options.least_vertices);
    const double mean = measure_deviation(result.mesh, result.binding, field).mean_mm;
    EXPECT_LT(2 * mean, measure_deviation(even.mesh, even.binding, field).mean_mm);
  }
  options.elongation = 1;
  EXPECT_THROW(generate_surface(fork, options), InvalidInput);
}

TEST(Elongation, IsRefusedOutOfRangeAndWithPaperGrowth) {
  for (const double elongation : {0.5, 16.5, std::nan("")})
    EXPECT_THROW(generate_surface(long_tube(), with_elongation(elongation)), InvalidInput);
  GenerateOptions paper = with_elongation(2);
  paper.growth = GrowthMethod::paper;
  EXPECT_THROW(generate_surface(long_tube(), paper), InvalidInput);
}

TEST(MetricSkewness, TellsLongTrianglesFromBadOnes) {
  // Equilateral once lengths along x are a quarter.
  const TriMesh mesh{{{0, 0, 0}, {4, 0, 0}, {2, std::sqrt(3.0) / 2, 0}}, {{0, 1, 2}}};
  EXPECT_GT(metric_skewness(mesh, {})[0], 0.6);
  EXPECT_EQ(metric_skewness(mesh, {}), equiangle_skewness(mesh));
  const std::vector<Vec3> along(3, 4 * Vec3::UnitX()), across(3, 4 * Vec3::UnitY()), shorter(3, 2 * Vec3::UnitX());
  EXPECT_NEAR(metric_skewness(mesh, along)[0], 0, kRounding);
  EXPECT_EQ(metric_skewness(mesh, across)[0], metric_skewness(mesh, {})[0]);
  EXPECT_GT(metric_skewness(mesh, shorter)[0], 0.2);
}

// At a junction, where the vessels at the corners have far different directions.
TEST(MetricSkewness, DoesNotDependOnTheOrderOfCorners) {
  const std::vector<Vec3> vertices{{0, 0, 0}, {4, 0, 0}, {2, 1.2, 0}};
  std::vector<Vec3> elongation;
  for (const double degrees : {0, 58, 124})
    elongation.push_back(4 * Vec3(std::cos(degrees * M_PI / 180), std::sin(degrees * M_PI / 180), 0));
  const TriMesh mesh{vertices, {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const std::vector<double> skewness = metric_skewness(mesh, elongation);
  for (const double s : skewness) EXPECT_NEAR(s, skewness[0], kRounding);
}

}  // namespace
}  // namespace vmesh
