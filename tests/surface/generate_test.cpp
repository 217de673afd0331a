#include "vmesh/surface/generate.h"

#include <array>
#include <limits>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/vessel_field.h"

#include "centerlines.h"
#include "random_vessels.h"

namespace vmesh {
namespace {

using namespace testing;

std::vector<Vec3> node_positions(const Centerline& centerline) {
  std::vector<Vec3> positions;
  for (const auto& node : centerline.nodes()) positions.push_back(node.position);
  return positions;
}

std::size_t nodes_inside(const Centerline& centerline, const TriMesh& mesh) {
  const auto inside = points_inside(mesh, node_positions(centerline));
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), true));
}

void expect_sound(const Centerline& centerline, const GenerateResult& result) {
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, centerline.component_count());
  EXPECT_EQ(topology.genus, static_cast<int>(centerline.cycle_rank()));
  EXPECT_TRUE(self_intersections(result.mesh).empty());
  EXPECT_EQ(nodes_inside(centerline, result.mesh), centerline.nodes().size());
  EXPECT_EQ(result.binding.size(), result.mesh.vertices.size());
  EXPECT_EQ(result.radius.size(), result.mesh.vertices.size());
}

// The paper's low-resolution row of Table 2.
void expect_paper_quality(const TriMesh& mesh) {
  const SkewnessSummary skewness = summarize_skewness(mesh);
  EXPECT_LE(skewness.mean, 0.23);
  EXPECT_LE(skewness.max, 0.70);
}

std::string bytes_of(const GenerateResult& result) {
  std::string bytes(reinterpret_cast<const char*>(result.mesh.vertices.data()),
                    result.mesh.vertices.size() * sizeof(Vec3));
  bytes.append(reinterpret_cast<const char*>(result.mesh.faces.data()), result.mesh.faces.size() * sizeof(Triangle));
  return bytes;
}

GenerateOptions single_seed() {
  GenerateOptions options;
  options.growth = GrowthMethod::paper;
  return options;
}

TEST(Generate, MakesASphereOfASingleNode) {
  const Centerline centerline = single_node();
  GenerateOptions options;
  options.placement = Placement::inscribed;
  const GenerateResult result = generate_surface(centerline, options);
  expect_sound(centerline, result);
  expect_paper_quality(result.mesh);
  for (const Vec3& v : result.mesh.vertices) EXPECT_NEAR((v - Vec3(1, 2, 3)).norm(), 2, 2e-3);  // 1e-3 r: projection
}

TEST(Generate, MakesACappedTube) {
  const Centerline centerline = straight_tube();
  const GenerateResult result = generate_surface(centerline);
  expect_sound(centerline, result);
  expect_paper_quality(result.mesh);
}

TEST(Generate, MakesForksOfManyAngles) {
  for (const double angle : {30.0, 45.0, 70.0, 110.0, 150.0}) {
    SCOPED_TRACE(angle);
    const Centerline centerline = fork(angle);
    const GenerateResult result = generate_surface(centerline);
    expect_sound(centerline, result);
    expect_paper_quality(result.mesh);
  }
}

// Measured on seeds 11 to 20: .241 to .258; .311 to .316 if the worst triangles are polished, but not improved.
TEST(Generate, LeavesNoTriangleOfATreeSkew) {
  SyntheticTreeOptions tree;
  tree.vertices = 400;
  for (tree.seed = 11; tree.seed < 15; ++tree.seed) {
    const SkewnessSummary skewness = summarize_skewness(generate_surface(synthetic_tree(tree)).mesh);
    EXPECT_LE(skewness.max, 0.27) << tree.seed;
    EXPECT_LE(skewness.mean, 0.09) << tree.seed;
  }
}

TEST(Generate, MakesStars) {
  for (const int arms : {12, 20}) {
    SCOPED_TRACE(arms);
    const Centerline centerline = star(arms);
    const GenerateResult result = generate_surface(centerline);
    expect_sound(centerline, result);
    expect_paper_quality(result.mesh);
  }
}

TEST(Generate, MakesEveryComponentOfAForest) {
  const Centerline centerline = two_forks();
  const GenerateResult result = generate_surface(centerline);
  expect_sound(centerline, result);
  expect_paper_quality(result.mesh);
}

TEST(Generate, GrowsFromASingleSeedAsPublished) {
  for (const Centerline& centerline : {single_node(), straight_tube(), fork(), star(12), two_forks()}) {
    const GenerateResult result = generate_surface(centerline, single_seed());
    expect_sound(centerline, result);
    expect_paper_quality(result.mesh);
  }
}

TEST(Generate, ClosesARing) {
  const Centerline centerline = ring(24);
  const GenerateResult result = generate_surface(centerline);
  expect_sound(centerline, result);
  expect_paper_quality(result.mesh);
}

TEST(Generate, SaysThatASingleSeedDoesNotCloseALoop) {
  const GenerateResult result = generate_surface(ring(24), single_seed());
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.genus, 0);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings[0].message.find("close a loop"), std::string::npos) << result.warnings[0].message;
}

TEST(Generate, LeavesASmallDeviation) {
  const Centerline centerline = fork();
  GenerateOptions options;
  options.placement = Placement::inscribed;
  const GenerateResult result = generate_surface(centerline, options);
  const Deviation deviation = measure_deviation(result.mesh, result.binding, VesselField(centerline, options.blend));
  // Six chords round a circle lie 1 - cos 30 = 0.134 r inside at their middles; a third of that on average over an
  // inscribed triangulation, and no point of a face with edges up to 1.5 r lies deeper than 0.5 r on a sphere of r.
  EXPECT_LT(deviation.mean_relative, 0.134);
  EXPECT_GT(deviation.mean_relative, 0.134 / 4);
  EXPECT_LT(deviation.max_relative, 0.5);
}

// Six chords round a circle lie between 0 and 0.134 r inside; balanced they lie within half of that, and what they are
// off on average is a quarter of it (the mean of |x^2 - 1/3| over [0, 1] is 0.26).
TEST(Generate, HalvesTheDeviationInBalancedPlacement) {
  const Centerline centerline = fork();
  const GenerateResult result = generate_surface(centerline);
  const Deviation deviation = measure_deviation(result.mesh, result.binding, VesselField(centerline, 0.5));
  EXPECT_LT(deviation.mean_relative, 0.134 * 0.26);
  EXPECT_GT(deviation.mean_relative, 0.134 / 16);
}

double volume_of(const TriMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.faces) volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  return volume;
}

TEST(Generate, KeepsTheVolumeInBalancedPlacement) {
  const Centerline centerline({{{0, 0, 0}, 1.5}, {{30, 0, 0}, 1.5}}, {{0, 1}});
  const double exact = M_PI * 1.5 * 1.5 * (30 + 4.0 / 3 * 1.5);
  GenerateOptions options;
  // A step along the normal by the mean signed distance leaves an error of second order in it: (0.07 r / r)^2, twice.
  EXPECT_NEAR(volume_of(generate_surface(centerline, options).mesh) / exact, 1, 0.01);
  options.placement = Placement::inscribed;
  // An inscribed hexagon has 0.827 of the circle's area, a heptagon 0.871.
  EXPECT_LT(volume_of(generate_surface(centerline, options).mesh) / exact, 0.9);
}

TEST(Generate, PutsItsVerticesOnTheBoundaryTheyAreBoundTo) {
  const Centerline centerline = fork();
  GenerateOptions options;
  options.blend = 0;
  options.placement = Placement::inscribed;
  const GenerateResult result = generate_surface(centerline, options);
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    const auto [segment, t] = result.binding[v];
    ASSERT_LT(segment, centerline.segments().size());
    ASSERT_GE(t, 0);
    ASSERT_LE(t, 1);
    EXPECT_DOUBLE_EQ(result.radius[v], centerline.radius_at(segment, t));
    const double distance = (result.mesh.vertices[v] - centerline.point_at(segment, t)).norm();
    EXPECT_NEAR(distance, result.radius[v], 0.01 * result.radius[v]);  // kOffBoundary of the optimiser
  }
}

TEST(Generate, FollowsTheResolutionAskedFor) {
  const Centerline centerline = fork();
  std::size_t previous = 0;
  for (const int around : {6, 9, 12, 18}) {
    SCOPED_TRACE(around);
    GenerateOptions options;
    options.around = around;
    const GenerateResult result = generate_surface(centerline, options);
    expect_sound(centerline, result);
    EXPECT_GT(result.mesh.vertices.size(), previous);
    previous = result.mesh.vertices.size();
    // Equilateral triangles of edge L = 2 r sin(pi / N) cover a tube with 4 pi / (sqrt 3 (L / r)^2) vertices per r;
    // the optimiser works towards 1.08 L, and the caps add about one length of r an end.
    const double edge = 2 * 1.08 * std::sin(M_PI / around);
    const double expected = 4 * M_PI / (std::sqrt(3.0) * edge * edge) * (centerline.length_in_radii() + 3);
    EXPECT_NEAR(static_cast<double>(previous) / expected, 1, 0.3);
  }
}

TEST(Generate, SplitsFacesWhoseCenterIsTooFar) {
  const Centerline centerline = fork();
  GenerateOptions loose, strict;
  loose.max_center_distance = 10;
  strict.max_center_distance = 0.08;
  EXPECT_GT(generate_surface(centerline, strict).mesh.vertices.size(),
            1.1 * static_cast<double>(generate_surface(centerline, loose).mesh.vertices.size()));
}

TEST(Generate, CanLeaveTheSurfaceAsGrown) {
  const Centerline centerline = fork();
  GenerateOptions options;
  options.sweeps = 0;
  const GenerateResult result = generate_surface(centerline, options);
  expect_sound(centerline, result);
  EXPECT_GT(summarize_skewness(result.mesh).mean, summarize_skewness(generate_surface(centerline).mesh).mean);
}

TEST(Generate, GrowsForAnyBeta) {
  for (const double beta : {0.0, 0.1, 0.3, 0.6, 1.0}) {
    SCOPED_TRACE(beta);
    GenerateOptions options = single_seed();
    options.beta = beta;
    const GenerateResult result = generate_surface(fork(), options);
    const Topology topology = measure_topology(result.mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
    EXPECT_EQ(topology.euler_characteristic, 2);
  }
}

TEST(Generate, GivesTheSameBytesTwice) {
  SyntheticTreeOptions tree;
  tree.vertices = 119;
  const Centerline centerline = synthetic_tree(tree);
  EXPECT_EQ(bytes_of(generate_surface(centerline)), bytes_of(generate_surface(centerline)));
}

TEST(Generate, ScalesBitForBitByPowersOfTwo) {
  SyntheticTreeOptions tree;
  tree.vertices = 119;
  const Centerline centerline = synthetic_tree(tree);
  const GenerateResult original = generate_surface(centerline);
  for (const double scale : {std::ldexp(1.0, -20), 0.5, 64.0, std::ldexp(1.0, 20)}) {
    SCOPED_TRACE(scale);
    const GenerateResult scaled =
        generate_surface(transformed(centerline, Eigen::Matrix3d::Identity(), Vec3::Zero(), scale));
    ASSERT_EQ(scaled.mesh.faces, original.mesh.faces);
    for (std::size_t v = 0; v < original.mesh.vertices.size(); ++v) {
      ASSERT_EQ(scaled.mesh.vertices[v], scale * original.mesh.vertices[v]) << "vertex " << v;
    }
  }
}

TEST(Generate, MovesWithTheCenterline) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(5, -3, 2);
  SyntheticTreeOptions tree;  // no symmetry, so that no decision hangs on rounding
  tree.vertices = 12;
  const Centerline centerline = synthetic_tree(tree);
  const GenerateResult original = generate_surface(centerline);
  const GenerateResult moved = generate_surface(transformed(centerline, rotation, shift, 1));
  ASSERT_EQ(moved.mesh.faces, original.mesh.faces);
  for (std::size_t v = 0; v < original.mesh.vertices.size(); ++v) {
    const Vec3 expected = rotation * original.mesh.vertices[v] + shift;
    // The field is asked in single precision: rounding is 6e-8 of the distance from the middle of a cone, some mm; the
    // iteration from the lattice to the last sweep may amplify it, observed below 1e-6.
    EXPECT_LT((moved.mesh.vertices[v] - expected).norm(), 1e-4) << "vertex " << v;
  }
}

TEST(Generate, MeshesOurSyntheticTrees) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    SyntheticTreeOptions tree;
    tree.vertices = 119;
    tree.seed = seed;
    const Centerline centerline = synthetic_tree(tree);
    const GenerateResult result = generate_surface(centerline);
    expect_sound(centerline, result);
    expect_paper_quality(result.mesh);
    EXPECT_TRUE(result.warnings.empty());
  }
}

TEST(Generate, TellsTheTimeOfEveryStage) {
  const GenerateResult result = generate_surface(fork());
  std::vector<std::string> names;
  for (const auto& stage : result.stages) {
    names.push_back(stage.stage);
    EXPECT_GE(stage.seconds, 0);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"simplify", "volume", "grow", "check"}));
}

// The fork with a node every twentieth of a millimetre, as centerline programs write it.
Centerline oversampled_fork() {
  const Centerline coarse = fork();
  std::vector<CenterlineNode> nodes = coarse.nodes();
  std::vector<CenterlineSegment> segments;
  for (Index s = 0; s < coarse.segments().size(); ++s) {
    const int count = static_cast<int>(20 * coarse.length(s));
    Index last = coarse.segment(s).a;
    for (int i = 1; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      Index next = coarse.segment(s).b;
      if (i < count) {
        next = static_cast<Index>(nodes.size());
        nodes.push_back({coarse.point_at(s, t), coarse.radius_at(s, t)});
      }
      segments.push_back({last, next});
      last = next;
    }
  }
  return {std::move(nodes), std::move(segments)};
}

TEST(Generate, LeavesOutNodesThatItDoesNotNeed) {
  const Centerline fine = oversampled_fork();
  GenerateOptions options;
  options.open_ends.nodes = {5};
  options.simplification = 1e-6;  // no more than rounding
  const GenerateResult result = generate_surface(fine, options);
  EXPECT_TRUE(result.is_sound());
  EXPECT_EQ(result.simplification.nodes_left_out, fine.nodes().size() - fork().nodes().size());
  EXPECT_LT(result.simplification.max_deviation_relative, 1e-6);
  EXPECT_EQ(result.check.nodes_inside, fine.nodes().size());
  ASSERT_EQ(result.openings.size(), 1u);
  EXPECT_EQ(result.openings[0].node, 5u);
  // The same surface as around the coarse one, but bound to the fine one's segments.
  const GenerateResult coarse = generate_surface(fork(), options);
  EXPECT_EQ(result.mesh.faces, coarse.mesh.faces);
  const Centerline few = fork();
  for (Index v = 0; v < result.mesh.vertices.size(); ++v) {
    ASSERT_LT(result.binding[v].segment, fine.segments().size());
    const Vec3 at = fine.point_at(result.binding[v].segment, result.binding[v].t);
    EXPECT_LT((at - few.point_at(coarse.binding[v].segment, coarse.binding[v].t)).norm(), 1e-6);  // rounding, amplified
  }
}

TEST(Generate, KeepsToTheLimitForTheVesselsAsTheyWere) {
  Centerline wavy = oversampled_fork();
  std::vector<CenterlineNode> nodes = wavy.nodes();
  for (CenterlineNode& node : nodes) node.position.z() += 0.02 * std::sin(node.position.x());
  wavy = {nodes, wavy.segments()};
  GenerateOptions options;
  options.max_error.relative = 0.1;
  const GenerateResult result = generate_surface(wavy, options);
  EXPECT_GT(result.simplification.nodes_left_out, nodes.size() / 2);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  const VesselField field(wavy, options.blend);
  for (const auto& [a, b, c] : result.mesh.faces) {
    for (const Vec3& share : {Vec3(1, 1, 1), Vec3(1, 1, 0), Vec3(0, 1, 1), Vec3(1, 0, 1), Vec3(1, 0, 0)}) {
      const Vec3 p = (share[0] * result.mesh.vertices[a] + share[1] * result.mesh.vertices[b] +
                      share[2] * result.mesh.vertices[c]) /
                     share.sum();
      const FieldSample sample = field.sample(p, result.binding[a].segment);
      EXPECT_LE(std::abs(sample.distance), options.max_error.at(field.relations().radius_at(sample.cone, sample.t)));
    }
  }
}

TEST(Generate, RefusesOptionsOutOfRange) {
  const auto refuses = [](auto change) {
    GenerateOptions options;
    change(options);
    EXPECT_THROW(generate_surface(fork(), options), InvalidInput);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-0.1, 1.1, nan}) refuses([&](auto& o) { o.beta = bad; });
  for (const double bad : {-0.1, 2.1, nan}) refuses([&](auto& o) { o.blend = bad; });
  for (const double bad : {0.0, -1.0, nan}) refuses([&](auto& o) { o.max_center_distance = bad; });
  for (const int bad : {2, -6, 201}) refuses([&](auto& o) { o.around = bad; });
  refuses([](auto& o) { o.sweeps = -1; });
  refuses([](auto& o) { o.max_vertices = 0; });
}

TEST(Generate, RefusesAVesselMuchTooThinForItsLength) {
  const Centerline hair({{{0, 0, 0}, 1}, {{5, 0, 0}, 1}, {{10, 0, 0}, 1e-9}, {{13, 0, 0}, 1e-9}},
                        {{0, 1}, {1, 2}, {2, 3}});
  try {
    generate_surface(hair);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("segment 2 at (11.5"), std::string::npos) << error.what();
  }
}

TEST(Generate, RefusesMoreVerticesThanAllowed) {
  GenerateOptions options;
  const auto count = generate_surface(fork(), options).mesh.vertices.size();
  options.max_vertices = static_cast<int>(count / 2);
  EXPECT_THROW(generate_surface(fork(), options), InvalidInput);
}

TEST(Generate, StopsWhenAsked) {
  int calls = 0;
  const Progress stop_at_third = [&](std::string_view, double) { return ++calls < 3; };
  EXPECT_THROW(generate_surface(fork(), {}, stop_at_third), Cancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Generate, StopsWithinAJunctionThatIsRefined) {
  GenerateOptions options;
  options.max_error.relative = 0.01;
  int calls = 0;
  const Progress stop_while_growing = [&](std::string_view stage, double) { return stage != "grow" || ++calls < 3; };
  EXPECT_THROW(generate_surface(fork(), options, stop_while_growing), Cancelled);  // it has one junction
}

// An exception in one piece must not leave others half made: they have parallel loops of their own.
TEST(Generate, StopsWhileManyPiecesGrowAtOnce) {
  const Centerline tree = synthetic_tree({600, 1});
  GenerateOptions options;
  options.threads = 4;
  for (int stop = 10; stop < 1000; stop += 30) {
    int calls = 0;
    const Progress stop_there = [&](std::string_view, double) { return ++calls < stop; };
    EXPECT_THROW(generate_surface(tree, options, stop_there), Cancelled) << stop;
  }
}

TEST(Generate, ReportsProgressBetweenZeroAndOne) {
  std::vector<std::string> stages;
  generate_surface(fork(), {}, [&](std::string_view stage, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    return true;
  });
  EXPECT_EQ(stages, (std::vector<std::string>{"grow"}));
}

// As what edges cut off does, without an end: what is left over by balancing and projecting must shrink with them.
TEST(Generate, EachDoublingOfVerticesAroundDividesTheMeanDistance) {
  const Centerline centerline = two_forks();
  for (const double blend : {0.0, 0.5}) {
    const VesselField field(centerline, blend);
    double coarser = 0;
    for (const int around : {12, 24, 48, 96}) {
      GenerateOptions options;
      options.around = around;
      options.blend = blend;
      options.simplification = 0;
      const GenerateResult result = generate_surface(centerline, options);
      ASSERT_TRUE(result.is_sound());
      const double mean = measure_deviation(result.mesh, result.binding, field).mean_relative;
      EXPECT_TRUE(coarser == 0 || 3.5 * mean < coarser) << "blend " << blend << ", " << around << " around: " << mean;
      coarser = mean;
    }
  }
}

TEST(Generate, EachDoublingOfVerticesAroundDividesTheLargestDistanceOfARoundedTree) {
  const Centerline centerline = testing::plausible_tree(8102);  // its valleys are a fifth as wide as its vessels
  const VesselField field(centerline, 0.5);
  double coarser = 0;
  for (const int around : {12, 24, 48, 96}) {
    GenerateOptions options;
    options.around = around;
    options.simplification = 0;
    const GenerateResult result = generate_surface(centerline, options);
    ASSERT_TRUE(result.is_sound());
    const double max = measure_deviation(result.mesh, result.binding, field).max_relative;
    // A quarter where edges resolve a valley; at worst half where three of them meet, as their smooth minima do not.
    EXPECT_TRUE(coarser == 0 || 1.8 * max < coarser) << around << " around: " << max;
    coarser = max;
  }
}

// A half turn with a bend of two radii. Its rings are up to 1.5 times as far apart on the outside; where edges of more
// than 1.6 target lengths are split only, the mean skewness is .108; .076 where what is longer than others split is.
TEST(Generate, BendsDoNotStretchFineTriangles) {
  constexpr int kSteps = 24;
  constexpr double kBend = 2;
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (int k = 0; k < 6; ++k) nodes.push_back({{-4 + 4 * k / 6.0, 0, 0}, 1});
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = std::numbers::pi * k / kSteps;
    nodes.push_back({{kBend * std::sin(angle), kBend * (1 - std::cos(angle)), 0}, 1});
  }
  for (Index n = 1; n < nodes.size(); ++n) segments.push_back({n - 1, n});
  GenerateOptions options;
  options.around = 48;
  options.blend = 0;
  const GenerateResult result = generate_surface({nodes, segments}, options);
  ASSERT_TRUE(result.is_sound());
  const std::vector<double> skewness = equiangle_skewness(result.mesh);
  const double sum = std::accumulate(skewness.begin(), skewness.end(), 0.0);
  EXPECT_LT(sum / static_cast<double>(skewness.size()), 0.09);
}

TEST(MeasureRounding, IsTheDistanceOfTheRoundedBoundaryFromThePlainOne) {
  const Centerline centerline = testing::fork();
  const GenerateResult result = generate_surface(centerline);
  const VesselField rounded(centerline, 0.5), plain(centerline);
  const Deviation measured = measure_rounding(result.mesh, result.binding, rounded, 1);
  // The farthest of the same sample points, found by Newton steps of our own and a query over all cones.
  double farthest = 0;
  for (const auto& [a, b, c] : result.mesh.faces) {
    const auto& p = result.mesh.vertices;
    for (const std::array<double, 3> w :
         {std::array{1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array{2.0 / 3, 1.0 / 6, 1.0 / 6},
          std::array{1.0 / 6, 2.0 / 3, 1.0 / 6}, std::array{1.0 / 6, 1.0 / 6, 2.0 / 3}}) {
      Vec3 at = w[0] * p[a] + w[1] * p[b] + w[2] * p[c];
      for (int step = 0; step < 30; ++step) {
        const FieldSample s = rounded.sample(at, result.binding[a].segment);
        at -= s.distance / s.gradient.squaredNorm() * s.gradient;
      }
      farthest = std::max(farthest, std::abs(plain.sample_global(at).distance));
    }
  }
  EXPECT_GT(farthest, 0.01);                     // the crotch is rounded
  EXPECT_NEAR(measured.max_mm, farthest, 1e-5);  // projections end within 1e-6 radii of the boundary
  const Deviation again = measure_rounding(result.mesh, result.binding, rounded, 2);
  EXPECT_EQ(measured.mean_mm, again.mean_mm);
  EXPECT_EQ(measured.max_mm, again.max_mm);
}

}  // namespace
}  // namespace vmesh
