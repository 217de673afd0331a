// Whether --max-error holds on real trees, by an independent measurement: dense points of the surface against the
// volume, and dense points of the volume's boundary against the surface.
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "vmesh/core/box_tree.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "random_vessels.h"
#include "shared_data.h"

namespace vmesh {
namespace {

constexpr int kAround = 24;     // sample points around a vessel, and four times closer than faces are wide along it
constexpr double kStep = 0.15;  // radii

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

double distance_to_face(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const auto left_of = [&](const Vec3& from, const Vec3& to) { return (to - from).cross(p - from).dot(n) >= 0; };
  if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::abs((p - a).dot(n));
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

// How far a point is from a surface, in the limits of its faces: 1 where the nearest face by that measure is just as
// far as it may be.
class SurfaceDistance {
 public:
  SurfaceDistance(const GenerateResult& result, const ErrorLimit& limit) : mesh_(result.mesh) {
    std::vector<Vec3> low, high;
    for (const auto& [a, b, c] : mesh_.faces) {
      const Vec3 &p = mesh_.vertices[a], &q = mesh_.vertices[b], &r = mesh_.vertices[c];
      low.push_back(p.cwiseMin(q).cwiseMin(r));
      high.push_back(p.cwiseMax(q).cwiseMax(r));
      allowed_.push_back(limit.at(std::max({result.radius[a], result.radius[b], result.radius[c]})));
    }
    largest_ = *std::max_element(allowed_.begin(), allowed_.end());
    tree_ = BoxTree(low, high);
  }

  double operator()(const Vec3& p) const {
    double least = 1e6, reach = least * largest_;
    tree_.visit(p, reach, [&](Index f) {
      const auto& [a, b, c] = mesh_.faces[f];
      const double distance = distance_to_face(p, mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
      least = std::min(least, distance / allowed_[f]);
      reach = least * largest_;
    });
    return least;
  }

 private:
  const TriMesh& mesh_;
  std::vector<double> allowed_;
  double largest_ = 0;
  BoxTree tree_;
};

// The least distance from `x`, up to `reach`, at which the field changes its sign in one of many directions.
double distance_all_around(const VesselField& field, const Vec3& x, Index hint, double reach) {
  constexpr int kDirections = 400, kSteps = 64;
  const bool outside = field.sample(x, hint).distance > 0;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2.0 * i + 1) / kDirections, angle = i * std::numbers::pi * (3 - std::sqrt(5));
    const double across = std::sqrt(1 - z * z);
    const Vec3 way(across * std::cos(angle), across * std::sin(angle), z);
    for (int k = 1; k <= kSteps; ++k) {
      const double distance = reach * k / kSteps;
      if ((field.sample(x + distance * way, hint).distance > 0) == outside) continue;
      double low = reach * (k - 1) / kSteps, high = distance;  // it changes between these
      for (int halving = 0; halving < 20; ++halving) {
        const double middle = (low + high) / 2;
        ((field.sample(x + middle * way, hint).distance > 0) == outside ? low : high) = middle;
      }
      reach = high;
      break;
    }
  }
  return reach;
}

// The distance of `x` from the boundary point that follows from it along the gradient: no less than that to the
// boundary. (The field itself is not quite a distance where it is blended, and where the walls of two vessels blend
// its gradient nearly vanishes and leads astray: there one looks all around.)
double distance_to_boundary(const VesselField& field, const Vec3& x, Index hint) {
  constexpr double kShallow = 0.3;
  Vec3 p = x;
  FieldSample s = field.sample(p, hint);
  const bool shallow = s.gradient.norm() < kShallow;
  for (int step = 0; step < 20 && s.gradient.squaredNorm() > 0.01; ++step) {
    p -= s.distance / s.gradient.squaredNorm() * s.gradient;
    s = field.sample(p, s.cone);
  }
  const double distance = (p - x).norm() + std::abs(s.distance);
  return shallow ? distance_all_around(field, x, hint, distance) : distance;
}

// Calls visit(distance in limits) for 28 points of every face.
template <class Visit>
void for_surface_points(const GenerateResult& result, const VesselField& field, const ErrorLimit& limit,
                        Visit&& visit) {
  for (const auto& [a, b, c] : result.mesh.faces) {
    const Vec3 &p = result.mesh.vertices[a], &q = result.mesh.vertices[b], &r = result.mesh.vertices[c];
    const double allowed = limit.at(std::max({result.radius[a], result.radius[b], result.radius[c]}));
    for (int i = 0; i <= 6; ++i) {
      for (int j = 0; i + j <= 6; ++j) {
        const Vec3 x = (i * p + j * q + (6 - i - j) * r) / 6;
        const Index hint = result.binding[a].segment;
        double distance = distance_to_boundary(field, x, hint);  // at most
        if (distance > allowed) distance = distance_all_around(field, x, hint, distance);
        visit(distance / allowed);
      }
    }
  }
}

// Points of the boundary around every cone and over both its ends, mapped onto the boundary where they are next to it.
template <class Visit>
void for_boundary_points(const VesselField& field, Visit&& visit) {
  for (Index cone = 0; cone < field.relations().cone_count(); ++cone) {
    const Vec3 axis = field.relations().axis_point(cone, 1) - field.relations().axis_point(cone, 0);
    const Vec3 along = axis.normalized(), side = along.unitOrthogonal(), up = along.cross(side);
    const double radius = field.relations().radius_at(cone, 0.5), reach = radius / axis.norm();
    for (double t = -reach; t <= 1 + reach; t += kStep * reach) {
      for (int k = 0; k < kAround; ++k) {
        const double angle = 2 * std::numbers::pi * k / kAround, beyond = std::max({0.0, -t, t - 1}) / reach;
        const double r =
            field.relations().radius_at(cone, std::clamp(t, 0.0, 1.0)) * std::sqrt(std::max(0.0, 1 - beyond * beyond));
        Vec3 p = field.relations().axis_point(cone, t) + r * (std::cos(angle) * side + std::sin(angle) * up);
        FieldSample s = field.sample(p, cone);
        if (s.distance < -0.3 * radius) continue;  // within another vessel
        for (int step = 0; step < 20 && s.gradient.squaredNorm() > 0.01; ++step) {
          p -= s.distance / s.gradient.squaredNorm() * s.gradient;
          s = field.sample(p, s.cone);
        }
        if (std::abs(s.distance) < 1e-9 * radius) visit(p);
      }
    }
  }
}

// The same for both directions.
double worst_deviation(const GenerateResult& result, const VesselField& field, const ErrorLimit& limit) {
  double worst = 0;
  std::size_t points = 0;
  const auto look_at = [&](double distance) {
    ++points;
    worst = std::max(worst, distance);
  };
  for_surface_points(result, field, limit, look_at);
  const SurfaceDistance distance(result, limit);
  for_boundary_points(field, [&](const Vec3& p) { look_at(distance(p)); });
  EXPECT_GT(points, 60 * result.mesh.vertices.size());
  return worst;
}

ErrorLimit limit_of(double relative) {
  ErrorLimit limit;
  limit.relative = relative;
  return limit;
}

GenerateResult generate(const Centerline& centerline, double relative, double blend = GenerateOptions().blend) {
  GenerateOptions options;
  options.blend = blend;
  options.max_error = limit_of(relative);
  return generate_surface(centerline, options);
}

class MaxError : public ::testing::TestWithParam<std::tuple<const char*, double>> {};

TEST_P(MaxError, HoldsBothWaysAtDensePoints) {
  const auto& [name, relative] = GetParam();
  const std::string file = name;
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load_centerline(testing::shared_data(file)).cleaned.centerline;
  const GenerateResult result = generate(centerline, relative);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  EXPECT_TRUE(self_intersections(result.mesh).empty());
  EXPECT_EQ(measure_topology(result.mesh).genus, 0);
  EXPECT_LE(worst_deviation(result, VesselField(centerline, GenerateOptions().blend), limit_of(relative)), 1);
}

// Vessels run side by side there, so that the gap between them ends in a notch too narrow for triangles that may be.
class NarrowNotch : public ::testing::TestWithParam<std::tuple<const char*, double, double>> {};

TEST_P(NarrowNotch, IsWithinTheLimit) {
  const auto& [name, blend, relative] = GetParam();
  const std::string file = name;
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load_centerline(testing::shared_data(file)).cleaned.centerline;
  const GenerateResult result = generate(centerline, relative, blend);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  EXPECT_TRUE(result.is_sound());
  EXPECT_LE(worst_deviation(result, VesselField(centerline, blend), limit_of(relative)), 1);
}

// Above half the radius of thin vessels, four faces of these are proven with the shells of refinement alone. All of
// 3,429 vertices were then kept.
TEST(MaxErrorAndElongation, LeaveOutVerticesWhereTheLimitIsAboveHalfTheRadius) {
  const std::string file = "liver_portal_centerlines/liverModelPatient1__hepatic1_1.swc";
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load_centerline(testing::shared_data(file)).cleaned.centerline;
  GenerateOptions options;
  options.blend = 0;
  options.around = 5;
  options.max_error.mm = 0.684656;
  options.elongation = 16;
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  EXPECT_TRUE(result.is_sound());
  EXPECT_LT(result.mesh.vertices.size(), 3 * centerline.nodes().size());
  EXPECT_LE(worst_deviation(result, VesselField(centerline, 0), options.max_error), 1);
}

// Two daughters that part at a small angle, the second thinner.
Centerline narrow_fork(double angle_deg, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  const double half = angle_deg / 2 * std::numbers::pi / 180;
  const double length = 2.4 / std::sin(half);  // to where they are 4.8 apart, three of the first one's radii
  const Vec3 up(std::cos(half), std::sin(half), 0), down(std::cos(half), -std::sin(half), 0);
  return {{{turn * Vec3(-6, 0, 0), 1}, {{0, 0, 0}, 1}, {turn * (length * up), 0.8}, {turn * (length * down), 0.7}},
          {{0, 1}, {1, 2}, {1, 3}}};
}

// Random points on the boundary within a radius of a place, deep in the gap as well: the nearest point of a cone's wall
// is known exactly, and on the boundary of the plain union if no other cone covers it.
template <class Visit>
void for_boundary_points_near(const Vec3& place, const VesselField& field, Visit&& visit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 p = place + Vec3(uniform(random), uniform(random), uniform(random));
    for (Index cone = 0; cone < field.relations().cone_count(); ++cone) {
      const FieldSample s = field.sample_cone(p, cone);
      const Vec3 on_wall = p - s.distance * s.gradient;
      if (std::abs(field.sample(on_wall, cone).distance) < 1e-9) visit(on_wall);
    }
  }
}

// Where the notch is refined for, edges are a tenth of those asked for at least (kFinest in optimize.cpp) and their
// target grows by half the distance from there (kGradation in sweep_state.cpp). The notch is a line as long as a
// diameter at most within a radius of any place, twice: it turns round at its tip. Around it lie two walls. A triangle
// of edges s takes up sqrt(3) / 4 s^2, half a vertex; edges down to four fifths of the target are not collapsed.
double most_vertices_within_a_radius(double around_edge, double relative) {
  const double edge = std::min(around_edge, std::sqrt(16 * relative)), finest = 0.1 * edge, slope = 0.5;
  const double per_length = (1 / finest - 1 / (finest + slope)) / slope;  // of 1 / s^2 over the distance, 0 to 1
  return 2 * 2 * 2 * per_length * 2 / std::sqrt(3) * (1.25 * 1.25);
}

std::size_t vertices_within(const GenerateResult& result, const Vec3& place, double radius) {
  return static_cast<std::size_t>(std::count_if(result.mesh.vertices.begin(), result.mesh.vertices.end(),
                                                [&](const Vec3& p) { return (p - place).norm() <= radius; }));
}

class NarrowFork : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(NarrowFork, IsProvenWithFewVerticesInOnePlace) {
  const auto& [angle, blend, relative] = GetParam();
  const Centerline centerline = narrow_fork(angle);
  const GenerateResult result = generate(centerline, relative, blend);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  EXPECT_TRUE(result.is_sound());
  const double most = most_vertices_within_a_radius(2 * std::sin(std::numbers::pi / 6), relative);
  for (Index v = 0; v < result.mesh.vertices.size(); ++v)
    EXPECT_LE(vertices_within(result, result.mesh.vertices[v], result.radius[v]), most) << "vertex " << v;
  EXPECT_LE(worst_deviation(result, VesselField(centerline, blend), limit_of(relative)), 1);
}

// At the crease, single precision cannot tell which of two vessels is nearer: eight in forty were then not proven.
TEST(NarrowForkAnyhow, IsProvenHoweverItLies) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 8; ++k) {
    Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
    turn.normalize();
    const GenerateResult result = generate(narrow_fork(30, turn.toRotationMatrix()), 0.05, 0);
    EXPECT_EQ(result.error.unproven_faces, 0u) << "turn " << k;
  }
}

TEST_P(NarrowFork, KeepsWhatItClosesWithinTheLimit) {
  const auto& [angle, blend, relative] = GetParam();
  const Centerline centerline = narrow_fork(angle);
  const GenerateResult result = generate(centerline, relative, blend);
  const VesselField field(centerline, blend);
  if (blend > 0) {
    EXPECT_TRUE(result.error.closed_notches.empty());  // rounded, it is wide enough
  }
  const SurfaceDistance distance(result, limit_of(relative));
  for (const ClosedNotch& notch : result.error.closed_notches) {
    EXPECT_GT(notch.depth, 0);
    EXPECT_LT(notch.depth, relative);  // radii are 1 at most
    std::size_t points = 0;
    double worst = 0;
    for_boundary_points_near(notch.position, field, [&](const Vec3& p) {
      ++points;
      worst = std::max(worst, distance(p));
    });
    EXPECT_GT(points, 10000u);
    EXPECT_LE(worst, 1);
  }
}

// Corners out of a notch lead different ways: a wall's along its normal, that at the end up the middle. In between, the
// shell must not cross to the other wall.
TEST(NarrowNotches, OfVesselsThatHardlyPartAreProven) {
  const Centerline centerline = narrow_fork(22);
  for (const double relative : {0.05, 0.02}) {
    const GenerateResult result = generate(centerline, relative, 0);
    EXPECT_EQ(result.error.unproven_faces, 0u) << relative;
    EXPECT_TRUE(result.is_sound());
    // At 2 % triangles are smaller than what is measured with.
    if (relative == 0.05) {
      EXPECT_LE(worst_deviation(result, VesselField(centerline, 0), limit_of(relative)), 1);
    }
  }
}

// The second to the fourth only where they are grown finer where they were not proven.
TEST(NarrowNotches, OfVesselsSideBySideAreProven) {
  for (const unsigned seed : {7001u, 7010u, 7018u, 7047u}) {
    const GenerateResult result = generate(testing::plausible_tree(seed), 0.01, 0);
    EXPECT_EQ(result.error.unproven_faces, 0u) << "seed " << seed;
    EXPECT_TRUE(result.is_sound()) << "seed " << seed;
  }
}

// A trunk and two daughters that are thinner, and part farther from it the less their angle is: the even surface spans
// their gap high above its end.
Centerline thin_daughters(double angle_deg, double radius) {
  const double half = angle_deg / 2 * std::numbers::pi / 180, length = 40;
  const Vec3 up(length * std::sin(half), 0, length * std::cos(half)), down(-up.x(), 0, up.z());
  return {{{{0, 0, -12}, 2}, {{0, 0, 0}, 2}, {up, radius}, {down, radius}}, {{0, 1}, {1, 2}, {1, 3}}};
}

// Down edge by edge, 33 to 149 faces were not proven on each of these. (Of 48 such forks of 9 to 24 degrees, 1 is not
// proven now, 22 were not.)
TEST(NarrowNotches, BetweenThinDaughtersAreProven) {
  for (const auto& [angle, radius] : {std::pair(10.0, 1.0), std::pair(12.0, 1.0), std::pair(12.0, 1.5)}) {
    const GenerateResult result = generate(thin_daughters(angle, radius), 0.01, 0);
    EXPECT_EQ(result.error.unproven_faces, 0u) << angle << " degrees, radius " << radius;
    EXPECT_TRUE(result.is_sound());
  }
}

// Where vertices on the crease are not enough, the end of the gap is closed, by no more than the limit. On which of
// these forks that is depends on last bits.
TEST(NarrowNotches, AreClosedWithinTheLimit) {
  std::size_t closed = 0;
  for (const auto& [angle, radius, limit] :
       {std::tuple(26.0, 0.5, 0.05), std::tuple(26.0, 1.0, 0.05), std::tuple(32.0, 1.0, 0.1),
        std::tuple(18.0, 1.5, 0.2), std::tuple(24.0, 1.8, 0.2), std::tuple(34.0, 0.5, 0.2)}) {
    const GenerateResult result = generate(thin_daughters(angle, radius), limit, 0);
    EXPECT_EQ(result.error.unproven_faces, 0u) << angle << " degrees, radius " << radius;
    EXPECT_TRUE(result.is_sound());
    closed += result.error.closed_notches.size();
    // None of these vessels has a radius above 2.
    for (const ClosedNotch& notch : result.error.closed_notches) EXPECT_LE(notch.depth, 2 * limit);
  }
  EXPECT_GT(closed, 0u);
}

// Between rounded vessels that are nearly parallel, the boundary is many times as far as the field's distance tells.
TEST(NarrowNotches, WhereRoundedVesselsAreNearlyParallelAreProven) {
  for (const unsigned seed : {7023u, 7026u}) {
    const GenerateResult result = generate(testing::plausible_tree(seed), 0.01, 0.5);
    EXPECT_EQ(result.error.unproven_faces, 0u) << "seed " << seed;
    EXPECT_TRUE(result.is_sound());
  }
}

#define TREE(name) "liver_portal_centerlines/liverModelPatient1__" name "_1.swc"
INSTANTIATE_TEST_SUITE_P(TenPercent, MaxError,
                         ::testing::Combine(::testing::Values(TREE("portal1"), TREE("portal3"), TREE("portal15"),
                                                              TREE("hepatic1"), TREE("hepatic3"), TREE("hepatic15"),
                                                              TREE("arterial15"), TREE("vessel_hepatic"),
                                                              TREE("vessel_portal"), TREE("vessel_arterial"),
                                                              "synthetic_trees/tree1560.swc"),
                                            ::testing::Values(0.1)));
INSTANTIATE_TEST_SUITE_P(FivePercent, MaxError,
                         ::testing::Combine(::testing::Values(TREE("portal1"), TREE("portal3"), TREE("portal15"),
                                                              TREE("hepatic1"), TREE("hepatic3"), TREE("hepatic15"),
                                                              TREE("arterial15"), TREE("vessel_hepatic"),
                                                              TREE("vessel_portal"), TREE("vessel_arterial")),
                                            ::testing::Values(0.05)));
INSTANTIATE_TEST_SUITE_P(Sharp, NarrowNotch,
                         ::testing::Combine(::testing::Values(TREE("vessel_portal"), "synthetic_trees/tree119.swc"),
                                            ::testing::Values(0.0), ::testing::Values(0.1, 0.05)));
INSTANTIATE_TEST_SUITE_P(SharpAndLarge, NarrowNotch,
                         ::testing::Values(std::tuple("synthetic_trees/tree1560.swc", 0.0, 0.1)));
INSTANTIATE_TEST_SUITE_P(Angles, NarrowFork,
                         ::testing::Combine(::testing::Values(30.0, 45.0), ::testing::Values(0.0, 0.5),
                                            ::testing::Values(0.1, 0.05)));

}  // namespace
}  // namespace vmesh
