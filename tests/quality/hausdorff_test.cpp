#include "vmesh/quality/hausdorff.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/quality/closest_point.h"

#include "soups.h"

namespace vmesh {
namespace {

using testing::Draw, testing::cube, testing::icosphere, testing::moved;
using testing::operator+;

// What is set aside for rounding is 2^-46 of coordinates and extents, below 10 here.
constexpr double kDistanceRounding = 1e-12;

HausdorffOptions to(double tolerance) {
  HausdorffOptions options;
  options.tolerance = tolerance;
  return options;
}

template <class Interval>
void expect_interval(const Interval& found, double exact, double tolerance) {
  EXPECT_LE(found.lower, exact + kDistanceRounding);
  EXPECT_GE(found.upper, exact - kDistanceRounding);
  EXPECT_LE(found.upper - found.lower, tolerance);
  EXPECT_LE(found.lower, found.upper);
}

TriMesh scaled(TriMesh mesh, double by) {
  for (Vec3& v : mesh.vertices) v *= by;
  return mesh;
}

// Every face in four; the same set of points.
TriMesh subdivided(const TriMesh& mesh) {
  TriMesh fine;
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const auto v = static_cast<Index>(fine.vertices.size());
    fine.vertices.insert(fine.vertices.end(), {p, q, r, 0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)});
    fine.faces.insert(fine.faces.end(),
                      {{v, v + 3, v + 5}, {v + 3, v + 1, v + 4}, {v + 5, v + 4, v + 2}, {v + 3, v + 4, v + 5}});
  }
  return fine;
}

// A pyramid on the square [-1, 1]^2 with its tip at z = 4; with `cut`, flat at z = 3.
TriMesh pyramid(bool cut) {
  TriMesh mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 2, 1}, {0, 3, 2}}};
  if (!cut) {
    mesh.vertices.emplace_back(0, 0, 4);
    mesh.faces.insert(mesh.faces.end(), {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
    return mesh;
  }
  for (Index i = 0; i < 4; ++i) {
    mesh.vertices.push_back(Vec3(mesh.vertices[i] / 4 + Vec3(0, 0, 3)));
    const Index next = (i + 1) % 4;
    mesh.faces.insert(mesh.faces.end(), {{i, next, 4 + i}, {next, 4 + next, 4 + i}});
  }
  mesh.faces.insert(mesh.faces.end(), {{4, 5, 6}, {4, 6, 7}});
  return mesh;
}

TEST(Hausdorff, OfAMeshFromItselfAndItsSubdivisionIsZero) {
  for (const TriMesh& mesh : {cube(), icosphere(3), testing::torus(3, 1, 20, 12)}) {
    for (const TriMesh& other : {mesh, subdivided(mesh), subdivided(subdivided(mesh)), testing::exploded(mesh)}) {
      const Hausdorff found = hausdorff(mesh, other);
      for (const OneSidedHausdorff& side : {found.forward, found.backward}) {
        EXPECT_EQ(side.lower, 0);
        EXPECT_LE(side.upper, 1e-4);
        EXPECT_NE(side.witness.from_face, kNone);
      }
    }
  }
}

TEST(Hausdorff, OfCoplanarAndParallelGridsIsFoundAlthoughNoCornersMeet) {
  const auto grid = [](Index n, double z) {
    TriMesh mesh;
    for (Index i = 0; i <= n; ++i) {
      for (Index j = 0; j <= n; ++j) mesh.vertices.emplace_back(4.0 * i / n, 4.0 * j / n, z);
    }
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        const Index a = i * (n + 1) + j, b = a + n + 1;
        mesh.faces.insert(mesh.faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
      }
    }
    return mesh;
  };
  for (const double apart : {0.0, 1e-3, 1.0}) {
    const Hausdorff found = hausdorff(grid(12, 0), grid(17, apart), to(1e-6));
    expect_interval(found.forward, apart, 1e-6);
    expect_interval(found.backward, apart, 1e-6);
  }
}

TEST(Hausdorff, OfShiftedBoxesIsTheShift) {
  for (const Vec3& by : {Vec3(0.25, 0, 0), Vec3(3, 4, 0), Vec3(-7, 0, 0)}) {
    for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
      const Hausdorff found = hausdorff(cube(), moved(cube(), by), to(tolerance));
      expect_interval(found.forward, by.norm(), tolerance);
      expect_interval(found.backward, by.norm(), tolerance);
    }
  }
}

TEST(Hausdorff, OfABoxWithinABoxIsTheWayToItsCorner) {
  const TriMesh outer = moved(scaled(cube(), 4), {-1, -1, -1});
  const Hausdorff found = hausdorff(cube(), outer);
  expect_interval(found.forward, 2, 1e-4);  // (1, 1, 1) is in the middle of the outer box
  expect_interval(found.backward, std::sqrt(12), 1e-4);
  EXPECT_LT((found.backward.witness.from - Vec3(3, 3, 3)).norm(), 1e-3);
  EXPECT_LT((found.backward.witness.to - Vec3(1, 1, 1)).norm(), 1e-3);
  EXPECT_EQ(found.larger().lower, found.backward.lower);
}

TEST(Hausdorff, OfConcentricSpheresIsTheDifferenceOfTheRadii) {
  // A corner at 2 v is 1 away from the corner v; 2 q is no farther from q, and |q| is at most 1.
  const TriMesh inner = icosphere(3), outer = scaled(inner, 2);
  expect_interval(one_sided_hausdorff(outer, inner), 1, 1e-4);
  // Outwards it is the distance of parallel faces, if all faces are alike.
  const TriMesh body = icosphere(0);
  const auto& [a, b, c] = body.faces[0];
  const double parallel = ((body.vertices[a] + body.vertices[b] + body.vertices[c]) / 3).norm();
  expect_interval(one_sided_hausdorff(body, scaled(body, 2)), parallel, 1e-4);
}

TEST(Hausdorff, SeesACutTip) {
  const TriMesh whole = pyramid(false), cut = pyramid(true);
  const Hausdorff found = hausdorff(whole, cut);
  expect_interval(found.forward, 1, 1e-4);
  EXPECT_LT((found.forward.witness.from - Vec3(0, 0, 4)).norm(), 1e-3);
  EXPECT_LT((found.forward.witness.to - Vec3(0, 0, 3)).norm(), 0.02);  // sqrt(2 * 1e-4): the cap is flat
  // The middle of the cap is below the tip, and 1/4 in x away from the side x + z/4 = 1.
  expect_interval(found.backward, 0.25 / std::sqrt(1 + 1.0 / 16), 1e-4);
}

TEST(Hausdorff, HoldsWhatSamplesFindAndProvesItsLowerBound) {
  Draw draw(3);
  for (int trial = 0; trial < 30; ++trial) {
    const TriMesh from = trial % 2 ? testing::random_soup(draw, 20, 0.5) : testing::shaken(icosphere(2), draw, 0.1);
    const TriMesh other = trial % 3 ? testing::random_soup(draw, 30, 0.5) : testing::shaken(icosphere(1), draw, 0.1);
    const double tolerance = std::pow(10, draw.uniform(-7, -1));
    const OneSidedHausdorff found = one_sided_hausdorff(from, other, to(tolerance));
    EXPECT_LE(found.upper - found.lower, tolerance);
    const ClosestPointIndex index(other);
    double sampled = 0;
    for (int i = 0; i < 5000; ++i) {
      const auto& [a, b, c] = from.faces[draw.below(static_cast<Index>(from.faces.size()))];
      double u = draw.uniform(0, 1), v = draw.uniform(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      sampled = std::max(
          sampled,
          index.closest((1 - u - v) * from.vertices[a] + u * from.vertices[b] + v * from.vertices[c]).distance);
    }
    EXPECT_LE(sampled, found.upper);
    EXPECT_GE(sampled, 0.9 * found.lower);  // 5000 points on a few faces come that close
    const DistanceWitness& witness = found.witness;
    EXPECT_GE((witness.from - witness.to).norm(), found.lower);
    EXPECT_NEAR(index.closest(witness.from).distance, (witness.from - witness.to).norm(), kDistanceRounding);
    EXPECT_LT(ClosestPointIndex({from.vertices, {from.faces[witness.from_face]}}).closest(witness.from).distance,
              kDistanceRounding);
    EXPECT_LT(ClosestPointIndex({other.vertices, {other.faces[witness.to_face]}}).closest(witness.to).distance,
              kDistanceRounding);
  }
}

TEST(Hausdorff, SymmetricIsTheLargerDirection) {
  Draw draw(4);
  for (int trial = 0; trial < 20; ++trial) {
    const TriMesh a = testing::shaken(icosphere(2), draw, 0.1), b = testing::random_soup(draw, 20, 1);
    const Hausdorff both = hausdorff(a, b);
    const SymmetricHausdorff found = symmetric_hausdorff(a, b);
    EXPECT_LE(found.upper - found.lower, 1e-4);
    EXPECT_LE(found.lower, both.upper());
    EXPECT_GE(found.upper, both.lower());
    EXPECT_GE((found.witness.from - found.witness.to).norm(), found.lower);
    const TriMesh& from = found.from_second ? b : a;
    EXPECT_LT(ClosestPointIndex(from).closest(found.witness.from).distance, kDistanceRounding);
  }
}

TEST(Hausdorff, AnswersWhetherItIsLarger) {
  const TriMesh a = icosphere(3), b = moved(icosphere(2), {0.1, 0, 0});
  const OneSidedHausdorff known = one_sided_hausdorff(a, b);
  for (const double limit : {0.0, 0.5 * known.lower, known.lower - 1e-5}) {
    const auto witness = hausdorff_exceeds(a, b, limit);
    ASSERT_TRUE(witness.has_value());
    EXPECT_GT((witness->from - witness->to).norm(), limit);
  }
  for (const double limit : {known.upper, 2 * known.upper, 1e6})
    EXPECT_FALSE(hausdorff_exceeds(a, b, limit).has_value());
  EXPECT_FALSE(hausdorff_exceeds(a, a, 0).has_value());
}

TEST(Hausdorff, OfTheSameFacesInAnotherOrderIsTheSame) {
  Draw draw(5);
  const TriMesh a = testing::shaken(icosphere(3), draw, 0.02), b = icosphere(2);
  TriMesh shuffled = testing::exploded(a);
  draw.shuffle(shuffled.faces);
  const Hausdorff x = hausdorff(a, b, to(1e-6)), y = hausdorff(shuffled, b, to(1e-6));
  EXPECT_LE(x.lower(), y.upper());
  EXPECT_LE(y.lower(), x.upper());
  const Hausdorff again = hausdorff(a, b, to(1e-6));
  EXPECT_EQ(x.forward.lower, again.forward.lower);
  EXPECT_EQ(x.forward.upper, again.forward.upper);
  EXPECT_EQ(x.backward.witness.from, again.backward.witness.from);
}

TEST(Hausdorff, OfSegmentsAndPointsIsDefined) {
  const TriMesh point{{{0, 0, 0}}, {{0, 0, 0}}}, segment{{{-3, 4, 0}, {3, 4, 0}}, {{0, 1, 0}}};
  const Hausdorff found = hausdorff(point, segment);
  expect_interval(found.forward, 4, 1e-4);
  expect_interval(found.backward, 5, 1e-4);
}

TEST(Hausdorff, WorksFarFromTheOriginAndAtAnySize) {
  const Vec3 far(1e6, -1e6, 1e6);
  const Hausdorff found = hausdorff(moved(cube(), far), moved(cube(), far + Vec3(0, 0.5, 0)), to(1e-5));
  EXPECT_LE(found.lower(), 0.5);
  EXPECT_GE(found.upper(), 0.5);
  EXPECT_LE(found.upper() - found.lower(), 1e-5);
  for (const double size : {1e-9, 1e9}) {
    const OneSidedHausdorff side =
        one_sided_hausdorff(scaled(icosphere(2), 2 * size), scaled(icosphere(2), size), to(1e-5 * size));
    EXPECT_LE(side.lower, size * (1 + kDistanceRounding));
    EXPECT_GE(side.upper, size * (1 - kDistanceRounding));
    EXPECT_LE(side.upper - side.lower, 1e-5 * size);
  }
}

TEST(Hausdorff, RefusesWhatHasNoDistance) {
  const TriMesh good = cube();
  TriMesh bad_number = good, bad_index = good;
  bad_number.vertices[3].y() = NAN;
  bad_index.faces[2][1] = 8;
  for (const TriMesh& bad : {TriMesh{}, TriMesh{good.vertices, {}}, bad_number, bad_index}) {
    EXPECT_THROW(hausdorff(good, bad), InvalidInput);
    EXPECT_THROW(hausdorff(bad, good), InvalidInput);
    EXPECT_THROW(one_sided_hausdorff(bad, good), InvalidInput);
    EXPECT_THROW(one_sided_hausdorff(good, bad), InvalidInput);
    EXPECT_THROW(symmetric_hausdorff(bad, good), InvalidInput);
    EXPECT_THROW(hausdorff_exceeds(good, bad, 1), InvalidInput);
  }
  for (const double tolerance : {0.0, -1.0, static_cast<double>(NAN), 1e-15}) {
    EXPECT_THROW(hausdorff(good, good, to(tolerance)), InvalidInput) << tolerance;
  }
  for (const double limit : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_THROW(hausdorff_exceeds(good, good, limit), InvalidInput) << limit;
  }
}

TEST(Hausdorff, StopsWhenAsked) {
  HausdorffOptions options;
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_THROW(hausdorff(icosphere(5), scaled(icosphere(5), 1.1), options), Cancelled);
}

}  // namespace
}  // namespace vmesh
