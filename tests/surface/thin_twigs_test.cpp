// Vessels that leave a crowded, wide junction and are far thinner than it.
#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/generate.h"

namespace vmesh {
namespace {

constexpr double kSphere = 3.4;  // radius of the side branch's tip, in a junction of radius 11.7

struct Direction {
  const char* name;
  Vec3 way;
};
void PrintTo(const Direction& direction, std::ostream* out) { *out << direction.name; }

class CenterlineBuilder {
 public:
  Index add(const Vec3& position, double radius) {
    nodes_.push_back({position, radius});
    return static_cast<Index>(nodes_.size() - 1);
  }
  Index add_after(Index last, const Vec3& position, double radius) {
    const Index next = add(position, radius);
    segments_.push_back({last, next});
    return next;
  }
  const Vec3& position(Index node) const { return nodes_[node].position; }
  Centerline build() const { return {nodes_, segments_}; }

 private:
  std::vector<CenterlineNode> nodes_;
  std::vector<CenterlineSegment> segments_;
};

// A wide trunk with a side branch that ends in a sphere close to its wall. Returns the sphere's node.
Index add_crowded_junction(CenterlineBuilder& builder) {
  const Index junction = builder.add_after(builder.add({-40, 0, 0}, 12), {0, 0, 0}, 11.7);
  builder.add_after(junction, {40, 3, 0}, 12);
  return builder.add_after(builder.add_after(junction, {9, 9, 1}, 6), {14, 14, 4}, kSphere);
}

// A straight twig out of the sphere around `from`, in direction `way`.
void add_twig(CenterlineBuilder& builder, Index from, const Vec3& way, double radius) {
  const Vec3 center = builder.position(from), unit = way.normalized();
  const Index inside = builder.add_after(from, center + 0.35 * kSphere * unit, radius);
  const Index outside = builder.add_after(inside, center + (kSphere + 15 * radius) * unit, radius);
  builder.add_after(outside, center + (kSphere + 60 * radius) * unit, 2 * radius);
}

void expect_good_surface(const Centerline& centerline, int around = 6) {
  GenerateOptions options;
  options.around = around;
  const GenerateResult result = generate_surface(centerline, options);
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(self_intersections(result.mesh).size(), 0u);
  EXPECT_LE(summarize_skewness(result.mesh).max, 0.70);  // the paper's low-resolution row
  std::vector<Vec3> positions;
  for (const auto& node : centerline.nodes()) positions.push_back(node.position);
  const auto inside = points_inside(result.mesh, positions);
  EXPECT_EQ(std::count(inside.begin(), inside.end(), false), 0);
}

class TwigTo : public ::testing::TestWithParam<std::tuple<Direction, double>> {};

TEST_P(TwigTo, LeavesTheSphereOfACrowdedJunction) {
  const auto& [direction, ratio] = GetParam();
  CenterlineBuilder builder;
  add_twig(builder, add_crowded_junction(builder), direction.way, kSphere / ratio);
  expect_good_surface(builder.build());
}

constexpr double kRatios[] = {30, 100};

INSTANTIATE_TEST_SUITE_P(
    ThinTwigs, TwigTo,
    ::testing::Combine(::testing::Values(Direction{"Outwards", {5, 5, 3}}, Direction{"AcrossTheTrunk", {0, 1, 0}},
                                         Direction{"Upwards", {0, 0, 1}}, Direction{"Oblique", {-1, 2, -0.4}},
                                         Direction{"PastTheTrunk", {1, 0.4, -1}}),
                       ::testing::ValuesIn(kRatios)),
    [](const auto& test) {
      return std::get<Direction>(test.param).name + std::to_string(static_cast<int>(std::get<double>(test.param)));
    });

TEST(ThinTwigs, LeaveOneSphereSideBySide) {
  CenterlineBuilder builder;
  const Index sphere = add_crowded_junction(builder);
  add_twig(builder, sphere, {5, 5, 3}, kSphere / 40);
  add_twig(builder, sphere, {5, 2, 4}, kSphere / 90);
  add_twig(builder, sphere, {1, 5, 5}, kSphere / 60);
  expect_good_surface(builder.build());
}

// Its radius falls to the twig's while it still is below the wall, as in the vessel this was found at.
TEST(ThinTwigs, TaperBelowTheWallAndBendBeyondIt) {
  CenterlineBuilder builder;
  const Index sphere = add_crowded_junction(builder);
  const Vec3 center = builder.position(sphere), way = Vec3(5, 5, 3).normalized(), aside = way.unitOrthogonal();
  Index last = sphere;
  double along = 1.5;
  for (const double radius : {0.76, 0.41, 0.29, 0.24, 0.19, 0.16, 0.14, 0.12, 0.11, 0.1, 0.09, 0.08}) {
    const double bend = 0.05 * along * along;
    last = builder.add_after(last, center + along * way + bend * aside, radius);
    along += 0.25;
  }
  builder.add_after(last, builder.position(last) + 3 * (way + aside).normalized(), 0.2);
  expect_good_surface(builder.build());
}

TEST(ThinTwigs, LeaveAtOtherResolutions) {
  for (const int around : {4, 9, 12}) {
    SCOPED_TRACE(around);
    CenterlineBuilder builder;
    add_twig(builder, add_crowded_junction(builder), {5, 5, 3}, kSphere / 60);
    expect_good_surface(builder.build(), around);
  }
}

TEST(ThinTwigs, LeaveInTheSameBytesOnAnyNumberOfThreads) {
  CenterlineBuilder builder;
  add_twig(builder, add_crowded_junction(builder), {5, 5, 3}, kSphere / 60);
  const Centerline centerline = builder.build();
  GenerateOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const GenerateResult a = generate_surface(centerline, one), b = generate_surface(centerline, four);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.faces, b.mesh.faces);
}

}  // namespace
}  // namespace vmesh
