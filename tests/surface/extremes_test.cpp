// The ends of every scale: a valid surface within its stated error, or a refusal with a reason.
#include "extremes.h"

#include <limits>

#include <Eigen/Geometry>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/core/error.h"
#include "vmesh/quality/hausdorff.h"

#include "centerlines.h"

namespace vmesh {
namespace {

using namespace testing;

using Nodes = std::vector<CenterlineNode>;

Centerline chain(Nodes nodes) {
  std::vector<CenterlineSegment> segments;
  for (Index n = 1; n < nodes.size(); ++n) segments.push_back({n - 1, n});
  return {std::move(nodes), std::move(segments)};
}

Centerline scaled(const Centerline& centerline, double scale, const Vec3& shift = Vec3::Zero()) {
  Nodes nodes = centerline.nodes();
  for (auto& node : nodes) node = {scale * node.position + shift, scale * node.radius};
  return {std::move(nodes), centerline.segments()};
}

// From a radius of 1000 down to 1e-6, each a tenth of the one before.
Centerline nine_decades() {
  Nodes nodes;
  double x = 0;
  for (double radius = 1e3; radius > 0.9e-6; radius /= 10) {
    nodes.push_back({{x, 0, 0}, radius});
    x += 3 * radius;
  }
  return chain(nodes);
}

Centerline thousandfold(double length) { return chain({{{0, 0, 0}, 1}, {{length, 0, 0}, 1e-3}}); }

std::string refusal(const Centerline& centerline, const GenerateOptions& options = {}) {
  try {
    generate_surface(centerline, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  ADD_FAILURE() << "was not refused";
  return {};
}

TEST(Extremes, CoordinatesFromMicrometresToMetres) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    SCOPED_TRACE(scale);
    expect_valid_within_a_fifth(scaled(fork(), scale));
  }
}

TEST(Extremes, CoordinatesFarFromTheOrigin) {
  const Vec3 far(1e7, -1e7, 1e7);
  for (const double radius : {1e3, 1.0, 1e-3, 1e-5}) {
    SCOPED_TRACE(radius);
    expect_valid_within_a_fifth(scaled(fork(), radius, far));
  }
  // A thousand roundings of a coordinate of 1e7 are 2.2e-6.
  for (const double radius : {1e-6, 1e-8}) {
    EXPECT_NE(refusal(scaled(fork(), radius, far)).find("far from the origin"), std::string::npos);
  }
}

TEST(Extremes, RadiiOfNineDecades) {
  for (const double radius : {1e-6, 1e3})
    expect_valid_within_a_fifth(scaled(chain({{{0, 0, 0}, 1}, {{1, 2, 3}, 1}}), radius));
  expect_valid_within_a_fifth(nine_decades());
}

TEST(Extremes, NeighboursOfAThousandthOfTheRadius) {
  for (const double length : {0.5, 1.0, 1.5, 3.0, 30.0}) {
    SCOPED_TRACE(length);
    expect_valid_within_a_fifth(thousandfold(length));
  }
  expect_valid_within_a_fifth(chain({{{0, 0, 0}, 1}, {{3, 0, 0}, 1e-3}, {{6, 0, 0}, 1}}));
}

TEST(Extremes, SegmentsMuchShorterThanTheirRadius) {
  expect_valid_within_a_fifth(chain({{{0, 0, 0}, 1}, {{5, 0, 0}, 1}, {{5 + 1e-9, 0, 0}, 1}, {{10, 0, 0}, 1}}));
  expect_valid_within_a_fifth(chain({{{0, 0, 0}, 1}, {{1e-9, 0, 0}, 1}}));
}

TEST(Extremes, SegmentsMuchLongerThanTheirRadius) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{1e4, 1e3, 77}, 1}, {{1.01e4, 1e3, 0}, 0.5}, {{1e4, 1.1e3, 0}, 0.5}},
                              {{0, 1}, {1, 2}, {1, 3}});
  expect_valid_within_a_fifth(centerline);
}

TEST(Extremes, TurnsOf180Degrees) {
  const Vec3 tip(10, 0, 0);
  const std::pair<const char*, Nodes> turns[] = {
      {"onto itself", {{{0, 0, 0}, 1}, {tip, 1}, {{4, 0, 0}, 1}}},
      {"thinner, onto itself", {{{0, 0, 0}, 1}, {tip, 1}, {{4, 0, 0}, 0.5}}},
      {"past its start", {{{0, 0, 0}, 1}, {tip, 1}, {{-10, 0, 0}, 1}}},
      {"a hair beside", {{{0, 0, 0}, 1}, {tip, 1}, {{0, 1e-3, 0}, 1}}},
      {"half a radius apart", {{{0, 0, 0}, 1}, {tip, 1}, {{0, 2.5, 0}, 1}}},
      {"to and fro", {{{0, 0, 0}, 1}, {tip, 1}, {{0, 0, 0.1}, 1}, {{10, 0, 0.2}, 1}, {{0, 0, 0.3}, 1}}}};
  for (const auto& [name, nodes] : turns) {
    SCOPED_TRACE(name);
    expect_valid(chain(nodes), generate_surface(chain(nodes)));
  }
}

TEST(Extremes, FiftyBranchesInOneNode) {
  const Centerline centerline = star(50);
  expect_valid(centerline, generate_surface(centerline));
}

TEST(Extremes, CoincidentNodesAndDuplicateSegments) {
  RawCenterline raw;
  raw.nodes = {{{0, 0, 0}, 1}, {{5, 0, 0}, 1}, {{5, 0, 0}, 1}, {{9, 3, 0}, 1}, {{9, -3, 0}, 1}, {{9, 3, 0}, 1}};
  raw.segments = {{0, 1}, {1, 0}, {0, 1}, {1, 2}, {2, 2}, {2, 3}, {1, 4}, {2, 5}};
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  const Centerline centerline = clean(raw).centerline;
  EXPECT_EQ(centerline.nodes().size(), 4u);
  EXPECT_EQ(centerline.segments().size(), 3u);
  expect_valid_within_a_fifth(centerline);
}

TEST(Extremes, AsLittleAsThereCanBe) {
  expect_valid_within_a_fifth(single_node());
  expect_valid_within_a_fifth(chain({{{0, 0, 0}, 1}, {{3, 0, 0}, 1}}));
  expect_valid_within_a_fifth(chain({{{0, 0, 0}, 3}, {{1, 0, 0}, 1}}));  // one ball within the other
}

TEST(Extremes, NumbersThatAreNone) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(chain({{{bad, 0, 0}, 1}, {{3, 0, 0}, 1}}), InvalidInput);
    EXPECT_THROW(chain({{{0, 0, 0}, bad}, {{3, 0, 0}, 1}}), InvalidInput);
  }
  EXPECT_THROW(chain({{{0, 0, 0}, -1}, {{3, 0, 0}, 1}}), InvalidInput);
}

TEST(Extremes, NumbersWhosePowersAreNone) {
  constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
  for (const double scale : {1e-310, 1e-200, 1e-31, 1e31, 1e150, 1e300}) {
    EXPECT_NE(refusal(scaled(fork(), scale)).find("1e-30"), std::string::npos) << scale;
  }
  EXPECT_NE(refusal(chain({{{0, 0, 0}, 1}, {{3, 0, 0}, kDenormal}})).find("node 1"), std::string::npos);
  expect_valid_within_a_fifth(chain({{{kDenormal, 0, -kDenormal}, 1}, {{3, kDenormal, 0}, 1}}));
}

TEST(Extremes, AnyWeightOfTheBoundary) {
  for (const double beta : {0.0, 1.0}) {
    GenerateOptions options;
    options.beta = beta;
    for (const Centerline& centerline : {fork(), star(12), ring(24)}) expect_valid_within_a_fifth(centerline, options);
    // The published growth works without attraction, and with attraction alone reports that it fails.
    options.growth = GrowthMethod::paper;
    const GenerateResult result = generate_surface(fork(), options);
    const Topology topology = measure_topology(result.mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
    EXPECT_TRUE(self_intersections(result.mesh).empty() || !result.warnings.empty());
  }
}

TEST(Extremes, ThreeVerticesAround) {
  GenerateOptions options;
  options.around = 3;
  for (const Centerline& centerline : {single_node(), straight_tube(), fork(), star(12), ring(24)}) {
    expect_valid(centerline, generate_surface(centerline, options));
  }
}

TEST(Extremes, TwoHundredVerticesAround) {
  GenerateOptions options;
  options.around = 200;
  const Centerline ball = single_node(), tube = chain({{{0, 0, 0}, 1}, {{0.5, 0, 0}, 1}});
  for (const Centerline& centerline : {ball, tube}) {
    const GenerateResult result = generate_surface(centerline, options);
    expect_valid(centerline, result);
    // Vertices are put onto the boundary to 1e-3 r. A chord between neighbours lies 1 - cos(pi / 200) = 1.2e-4 r off at
    // its middle, a face's centre a third more; edges get up to 1.4 times as long as intended before they are split.
    const Deviation deviation = measure_deviation(result.mesh, result.binding, VesselField(centerline, options.blend));
    EXPECT_LT(deviation.max_relative, 1e-3 + 1.2e-4 * 4 / 3 * 1.4 * 1.4);
  }
}

TEST(Extremes, ErrorsFarBelowWhatADoubleTells) {
  for (const double mm : {1e-18, 1e-300}) {
    GenerateOptions options;
    options.max_error.mm = mm;
    for (const Centerline& centerline : {single_node(), fork()}) {
      EXPECT_NE(refusal(centerline, options).find("larger error"), std::string::npos);
    }
  }
}

TEST(Extremes, ScaleByPowersOfTwoToTheBit) {
  for (const Centerline& centerline : {nine_decades(), thousandfold(0.5), thousandfold(3), star(50),
                                       chain({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, 2.5, 0}, 1}})}) {
    const GenerateResult original = generate_surface(centerline);
    for (const int exponent : {-1, -75, 75}) {  // radii from 2.6e-29 to 3.8e25
      const double scale = std::ldexp(1.0, exponent);
      const GenerateResult result = generate_surface(scaled(centerline, scale));
      ASSERT_EQ(result.mesh.faces, original.mesh.faces);
      for (std::size_t v = 0; v < original.mesh.vertices.size(); ++v) {
        ASSERT_EQ(result.mesh.vertices[v], scale * original.mesh.vertices[v]) << "vertex " << v;
      }
    }
  }
}

// Where rounding flips a decision, or turns a ring about a vessel that looks the same from all sides, the surface is
// another one, and as good: both are within 0.2 of the local radius of the boundary, and so within 0.4 of each other.
TEST(Extremes, MoveWithTheirCenterline) {
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(500, -300, 200);
  for (const Centerline& centerline :
       {thousandfold(3), fork(), star(12), ring(24), chain({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, 2.5, 0}, 1}})}) {
    TriMesh original = expect_valid_within_a_fifth(centerline).mesh;
    const GenerateResult moved = expect_valid_within_a_fifth(transformed(centerline, rotation, shift, 1));
    for (Vec3& v : original.vertices) v = rotation * v + shift;
    double widest = 0;
    for (const auto& node : centerline.nodes()) widest = std::max(widest, node.radius);
    EXPECT_LT(hausdorff(moved.mesh, original).upper(), 0.4 * widest);
  }
}

// A thirtieth to a hundredth of the radius: faces folded before they were as small as the limit asks for.
TEST(Extremes, LimitsFarBelowTheResolutionDoNotFoldTheSurface) {
  const Centerline fork({{{0, 0, 0}, 1}, {{0, 0, 3}, 1}, {{0, 3, 5}, 0.6}, {{0, -3, 5}, 0.7}},
                        {{0, 1}, {1, 2}, {1, 3}});
  for (const double limit : {0.02, 0.01}) {
    GenerateOptions options;
    options.max_error.mm = limit;
    const GenerateResult surface = generate_surface(fork, options);
    EXPECT_EQ(surface.error.unproven_faces, 0u) << limit;
    EXPECT_TRUE(self_intersections(surface.mesh).empty()) << limit;
  }
}

}  // namespace
}  // namespace vmesh
