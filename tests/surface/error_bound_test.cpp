#include "vmesh/surface/error_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "centerlines.h"
#include "surface/check/error_limit.h"
#include "surface/check/surface_proof.h"

namespace vmesh {
namespace {

using ProofFace = ErrorProof::Face;
using Side = ErrorProof::Side;

// A face across a tube of radius 1 along x, at `height` above the axis: `half` to either side of the plane y = 0.
ProofFace face_over_tube(double height, double half) {
  const Vec3 up(0, 0, 1);
  return {{{{3.5, -half, height}, up, 1, 0}, {{4.5, -half, height}, up, 1, 0}, {{4, half, height}, up, 1, 0}}};
}

Centerline short_tube() { return {{{{0, 0, 0}, 1}, {{8, 0, 0}, 1}}, {{0, 1}}}; }

TEST(ErrorProof, KnowsWhereACopyOfAFaceLeavesATube) {
  const Centerline tube = short_tube();
  const VesselField field(tube);
  const ErrorProof proof(field);
  const ProofFace face = face_over_tube(0.9, 0.3);
  // The nearest point of the copy to the axis lies at y = 0: it is outside from a height of 1 on.
  EXPECT_TRUE(proof.holds(face, {0.101, 0.101, 0.101}, Side::outer));
  EXPECT_FALSE(proof.holds(face, {0.099, 0.099, 0.099}, Side::outer));
  // The farthest points are the corners, at sqrt(0.9^2 + 0.3^2) = 0.949 < 1.
  EXPECT_TRUE(proof.holds(face, {0, 0, 0}, Side::inner));
  const ProofFace high = face_over_tube(0.97, 0.3);  // corners at 1.015; down by 0.021 they are at 0.9954
  EXPECT_FALSE(proof.holds(high, {0.015, 0.015, 0.015}, Side::inner));
  EXPECT_TRUE(proof.holds(high, {0.021, 0.021, 0.021}, Side::inner));
}

TEST(ErrorProof, TriesLowerShellsWhereTheNextWallIsNear) {
  // Two daughters whose walls are about 1 apart there: a shell as high as the limit of 1.3 reaches into the other one.
  const Centerline fork({{{-5, 0, 0}, 1}, {{0, 0, 0}, 1}, {{8, 1.6, 0}, 0.7}, {{8, -1.6, 0}, 0.7}},
                        {{0, 1}, {1, 2}, {1, 3}});
  const VesselField field(fork);
  const ErrorProof proof(field);
  const Vec3 along = Vec3(8, 1.6, 0).normalized(), inward = Vec3(1.6, -8, 0).normalized();
  const Vec3 wall = Vec3(0, 0, 0) + 0.8 * Vec3(8, 1.6, 0) + 0.76 * inward;
  const Vec3 up(0, 0, 1);
  const ProofFace face = {
      {{wall - 0.1 * up, inward, 1.3, 1}, {wall + 0.1 * along, inward, 1.3, 1}, {wall + 0.1 * up, inward, 1.3, 1}}};
  EXPECT_FALSE(proof.holds(face, {1.3, 1.3, 1.3}, Side::outer));
  const ErrorProof::Shares shares = proof.shares(face);
  EXPECT_GT(shares.outer, 0);
  EXPECT_LT(shares.outer, 1);
}

// How far a face reaches to the wrong side of the boundary, mm, at dense points.
double farthest_on_wrong_side(const ProofFace& face, const VesselField& field, Side side) {
  constexpr int kSteps = 16;
  double worst = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const Vec3 p = (i * face[0].position + j * face[1].position + (kSteps - i - j) * face[2].position) / kSteps;
      const double distance = field.sample(p, face[0].cone).distance;
      worst = std::max(worst, side == Side::inner ? distance : -distance);
    }
  }
  return worst;
}

struct Outcome {
  int proven = 0;
  int clear = 0, clear_and_proven = 0;  // true with a margin of 0.05 mm
};

// What is proven must be true: dense points of the copies are on their sides of the boundary. `draw()` returns faces.
template <class Draw>
Outcome try_to_prove(const VesselField& field, int trials, const Draw& draw) {
  const ErrorProof proof(field);
  Outcome outcome;
  for (int trial = 0; trial < trials; ++trial) {
    const ProofFace face = draw();
    for (const Side side : {Side::inner, Side::outer}) {
      const bool holds = proof.holds(face, {0, 0, 0}, side);
      const double worst = farthest_on_wrong_side(face, field, side);
      if (holds) {
        EXPECT_LE(worst, 1e-12) << "trial " << trial;
      }
      outcome.proven += holds;
      outcome.clear += worst < -0.05;
      outcome.clear_and_proven += holds && worst < -0.05;
    }
  }
  return outcome;
}

// The fifth node's sphere contains that of the sixth, where a thin vessel goes on.
Centerline vessel_with_knob() {
  const std::vector<CenterlineNode> nodes = {{{0, 0, 0}, 1.5},
                                             {{-1.03, -3.87, -1.23}, 1.54},
                                             {{-0.09, -7.1, -1.95}, 0.78},
                                             {{0.09, -7.47, -2.12}, 0.85},
                                             {{0.37, -7.79, -2.4}, 0.985},
                                             {{0.55, -7.84, -2.31}, 0.24},
                                             {{1.16, -8, -2}, 0.26},
                                             {{1.57, -8.08, -1.84}, 0.25}};
  std::vector<CenterlineSegment> segments;
  for (Index n = 1; n < nodes.size(); ++n) segments.push_back({n - 1, n});
  return {nodes, segments};
}

// What is true with a margin should be proven.
void expect_confirmed_and_proven(const Centerline& centerline) {
  for (const double blend : {0.0, 0.5}) {
    const VesselField field(centerline, blend);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto direction = [&] { return Vec3(uniform(random), uniform(random), uniform(random)).normalized(); };
    const Outcome outcome = try_to_prove(field, 3000, [&] {
      const Index cone = static_cast<Index>(random() % field.relations().cone_count());
      const Vec3 on_axis = field.relations().axis_point(cone, 0.5 * (1 + uniform(random)));
      const Vec3 out = direction(),
                 middle = on_axis + field.relations().radius_at(cone, 0.5) * (1 + 0.4 * uniform(random)) * out;
      const double size = 0.1 + 0.5 * std::abs(uniform(random));
      ProofFace face;
      for (auto& corner : face) corner = {middle + size * direction(), out, 1, cone};
      return face;
    });
    EXPECT_GT(outcome.proven, 500);
    EXPECT_GT(outcome.clear_and_proven, 0.95 * outcome.clear) << "of " << outcome.clear;
  }
}

TEST(ErrorProof, HoldsOnlyWhatDensePointsConfirm) { expect_confirmed_and_proven(testing::fork(50)); }

TEST(ErrorProof, HoldsOnlyWhatDensePointsConfirmAtAKnob) { expect_confirmed_and_proven(vessel_with_knob()); }

// A vessel that bends by up to `bend` at every node, and widens and narrows.
Centerline bent_vessel(double bend, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<CenterlineNode> nodes = {{{0, 0, 0}, 1}};
  std::vector<CenterlineSegment> segments;
  Vec3 way(1, 0, 0);
  for (Index n = 1; n < 8; ++n) {
    const double length = 1 + 0.8 * uniform(random);
    way = (way + std::tan(bend) * Vec3(0, uniform(random), uniform(random))).normalized();
    nodes.push_back({nodes.back().position + length * way,
                     std::clamp(nodes.back().radius + 0.5 * length * uniform(random), 0.6, 1.6)});
    segments.push_back({n - 1, n});
  }
  return {nodes, segments};
}

// Such triangles lie over several cones, and at a bend they dip into the fold where two of them are blended.
TEST(ErrorProof, HoldsOnlyWhatDensePointsConfirmOfLongTriangles) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double blend : {0.5, 0.9}) {
    Outcome all;
    for (int vessel = 0; vessel < 60; ++vessel) {
      const Centerline centerline = bent_vessel(vessel % 2 == 0 ? 0.2 : 0.8, random);
      const VesselField field(centerline, blend);
      const Outcome outcome = try_to_prove(field, 60, [&] {
        const Index cone = 1 + static_cast<Index>(random() % (field.relations().cone_count() - 2));
        const Vec3 along = (field.relations().axis_point(cone, 1) - field.relations().axis_point(cone, 0)).normalized();
        const Vec3 out = along.cross(Vec3(uniform(random), uniform(random), uniform(random))).normalized();
        const Vec3 start = field.relations().axis_point(cone, 0.5 * (1 + uniform(random)));
        const Vec3 wall = start + field.relations().radius_at(cone, 0.5) * out;
        const double above = 0.15 * std::abs(uniform(random));
        ProofFace face;
        for (auto& corner : face) {
          const Vec3 p = wall + 2 * uniform(random) * along + 0.2 * uniform(random) * along.cross(out);
          const FieldSample sample = field.sample(p, cone);
          corner = {p + (above - sample.distance) * sample.gradient, out, 1, cone};
        }
        return face;
      });
      all.proven += outcome.proven;
      all.clear += outcome.clear;
      all.clear_and_proven += outcome.clear_and_proven;
    }
    EXPECT_GT(all.proven, 500);
    EXPECT_GT(all.clear_and_proven, 0.95 * all.clear) << "of " << all.clear;
  }
}

// Also of versions that differ in some faces: what is known of the first must not be taken for those.
TEST(SurfaceProof, FindsTheSameFacesAsOneThatKnowsNothing) {
  const Centerline centerline = testing::fork(40);
  const VesselField field(centerline);
  GenerateResult result = generate_surface(centerline, {});
  ErrorLimit limit;
  limit.relative = 0.12;
  SurfaceProof proof(field, limit);
  for (const Index v : {0u, 10u, 20u}) {
    const std::vector<Index> unproven = proof.unproven(result.mesh, result.binding);
    EXPECT_EQ(unproven, unproven_faces(result.mesh, result.binding, field, limit)) << "before vertex " << v << " moves";
    EXPECT_LT(unproven.size(), result.mesh.faces.size());
    result.mesh.vertices[v] += Vec3(0, 0.2, 0.1);
    std::rotate(result.mesh.faces.begin(), result.mesh.faces.begin() + 7, result.mesh.faces.end());
  }
  EXPECT_FALSE(proof.unproven(result.mesh, result.binding).empty());
}

TEST(ErrorLimit, IsReadAndWritten) {
  EXPECT_EQ(parse_error_limit("0.3mm").mm, 0.3);
  EXPECT_EQ(parse_error_limit("10%").relative, 0.1);
  EXPECT_EQ(to_string(parse_error_limit("0.25mm,5%")), "0.25mm,5%");
  for (const char* wrong : {"", "10", "-1mm", "0%", "nan%", "1 mm", "5%mm"})
    EXPECT_THROW(parse_error_limit(wrong), InvalidInput) << wrong;
}

TEST(ErrorLimit, IsProvenOnAFork) {
  const Centerline centerline = testing::fork();
  GenerateOptions options;
  options.max_error.relative = 0.1;
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  const VesselField field(centerline, options.blend);
  EXPECT_TRUE(unproven_faces(result.mesh, result.binding, field, options.max_error).empty());
  // The same surface is nowhere near a hundredth of that.
  EXPECT_FALSE(unproven_faces(result.mesh, result.binding, field, parse_error_limit("0.1%")).empty());
}

// The sphere that is nearest does not change there, however steep the segment.
TEST(ErrorLimit, IsProvenAtAKnob) {
  const Centerline centerline = vessel_with_knob();
  GenerateOptions options;
  options.blend = 0.5;
  options.max_error.relative = 0.01;
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  // Not only by dividing faces on and on.
  options.max_error = {};
  options.around = 18;
  EXPECT_LT(result.mesh.vertices.size(), 2 * generate_surface(centerline, options).mesh.vertices.size());
}

// At an open end the surface ends, and the boundary does not.
TEST(ErrorLimit, IsSaidNotToHoldWhereItCannot) {
  GenerateOptions options;
  options.blend = 0;
  options.max_error.relative = 0.02;
  options.open_ends.all = true;
  const GenerateResult result = generate_surface(testing::fork(40), options);
  ASSERT_GT(result.error.unproven_faces, 0u);
  EXPECT_TRUE(result.is_sound());
  std::size_t faces = 0;
  for (const UnprovenPlace& place : result.error.unproven_places) {
    faces += place.faces;
    EXPECT_TRUE(std::any_of(result.openings.begin(), result.openings.end(), [&](const Opening& opening) {
      return (place.position - opening.center).norm() < 2 * opening.radius;
    })) << "beside the openings";
  }
  EXPECT_EQ(faces, result.error.unproven_faces);
}

// A coarse surface is not within a limit that it was not made for.
TEST(ErrorLimit, IsSaidNotToHoldWhereItDoesNot) {
  const Centerline centerline = testing::fork(40);
  GenerateOptions options;
  options.blend = 0;
  const GenerateResult result = generate_surface(centerline, options);
  const VesselField field(centerline, 0);
  ErrorLimit limit;
  limit.relative = 0.02;
  const std::vector<Index> unproven = unproven_faces(result.mesh, result.binding, field, limit);
  ASSERT_GT(unproven.size(), 0u);
  std::size_t faces = 0;
  for (const UnprovenPlace& place : places_of(result.mesh, unproven)) {
    faces += place.faces;
    EXPECT_TRUE(std::any_of(unproven.begin(), unproven.end(),
                            [&](Index f) { return result.mesh.vertices[result.mesh.faces[f][1]] == place.position; }));
  }
  EXPECT_EQ(faces, unproven.size());
}

TEST(ErrorLimit, GivesTheSameSurfaceWhateverTheThreads) {
  const Centerline centerline = testing::fork(40);
  GenerateOptions options;
  options.max_error.relative = 0.08;
  options.threads = 1;
  const TriMesh one = generate_surface(centerline, options).mesh;
  options.threads = 4;
  const TriMesh four = generate_surface(centerline, options).mesh;
  EXPECT_EQ(one.vertices, four.vertices);
  EXPECT_EQ(one.faces, four.faces);
}

}  // namespace
}  // namespace vmesh
