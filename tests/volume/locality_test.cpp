// Which cones are local to each other.
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

#include "hard_vessels.h"
#include "random_centerline.h"
#include "random_vessels.h"

namespace vmesh {
namespace {

using testing::CenterlineBuilder;
using testing::Draw;

bool is_local(const VesselField& field, Index i, Index j) {
  const auto cones = field.relations().local_cones(i);
  return std::find(cones.begin(), cones.end(), j) != cones.end();
}

double max_radius(const VesselField& field, Index c) {
  return std::max(field.relations().radius_at(c, 0), field.relations().radius_at(c, 1));
}

double distance_to_axis(const VesselField& field, const Vec3& p, Index c) {
  const Vec3 a = field.relations().axis_point(c, 0), axis = field.relations().axis_point(c, 1) - a;
  return (p - a - std::clamp(axis.dot(p - a) / axis.squaredNorm(), 0.0, 1.0) * axis).norm();
}

// The distance from a point of one axis to the other axis is convex in the point: bisection by thirds.
double axis_distance(const VesselField& field, Index i, Index j) {
  double low = 0, high = 1;
  for (int k = 0; k < 90; ++k) {
    const double u = low + (high - low) / 3, v = high - (high - low) / 3;
    if (distance_to_axis(field, field.relations().axis_point(i, u), j) <
        distance_to_axis(field, field.relations().axis_point(i, v), j)) {
      high = v;
    } else {
      low = u;
    }
  }
  double least = distance_to_axis(field, field.relations().axis_point(i, low), j);
  for (const double t : {0.0, 1.0})
    least = std::min(least, distance_to_axis(field, field.relations().axis_point(i, t), j));
  return least;
}

// The definition, by brute force: spheres half a mean radius apart, or less if gaps are smaller, stand for a cone. Two
// of them touch where no more is between them than the rounding fills, half of the smaller radius at most and a tenth
// at least, apart from what spheres lack of a cone. Pairs of touching spheres are connected where one sphere stays and
// the other moves on to its neighbour along the centerline; cones are local to each other where a pair of their spheres
// is connected to a sphere paired with itself.
class Locality {
 public:
  explicit Locality(const VesselField& field) : Locality(field, std::clamp(field.relations().blend(), 0.1, 0.5)) {}
  /// Up to another gap.
  Locality(const VesselField& field, double gap)
      : count_(field.relations().centerline().segments().size()), gap_(gap), local_(count_ * count_, 0) {
    place_spheres(field.relations().centerline());
    const std::size_t n = spheres_.size();
    std::vector<char> touching(n * n, 0), reached(n * n, 0);
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = 0; q < n; ++q) {
        const auto [small, large] = std::minmax(spheres_[p].radius, spheres_[q].radius);
        const double reach = small + large + std::max(gap_ * small, (gap_ - 0.1) * small + 0.08 * gap_ * large);
        const double apart = (spheres_[p].position - spheres_[q].position).norm();
        touching[p * n + q] = apart < reach;
        note(apart, reach);
      }
      reached[p * n + p] = 1;
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t p = 0; p < n; ++p) {
        for (std::size_t q = 0; q < n; ++q) {
          if (!reached[p * n + q]) continue;
          for (const Index next : next_[p]) {
            if (!touching[next * n + q] || reached[next * n + q]) continue;
            reached[next * n + q] = reached[q * n + next] = changed = true;
          }
        }
      }
    }
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = 0; q < n; ++q) {
        if (!reached[p * n + q]) continue;
        for (const Index i : cones_[p]) {
          for (const Index j : cones_[q]) local_[i * count_ + j] = 1;
        }
      }
    }
  }

  bool operator()(Index i, Index j) const { return local_[i * count_ + j]; }
  /// Some decision was so close that rounding takes it.
  bool undecided() const { return undecided_; }

 private:
  void note(double value, double limit) { undecided_ |= std::abs(value - limit) < 1e-9; }

  void place_spheres(const Centerline& centerline) {
    spheres_ = centerline.nodes();
    next_.resize(spheres_.size());
    cones_.resize(spheres_.size());
    for (Index s = 0; s < count_; ++s) {
      const double spacing = 0.5 * std::sqrt(gap_ / 0.5);
      const double steps = centerline.length(s) / (spacing * centerline.radius_at(s, 0.5));
      note(steps, std::round(steps));
      Index last = centerline.segment(s).a;
      cones_[last].push_back(s);
      for (int k = 1; k < steps; ++k) {
        const double t = k / std::ceil(steps);
        spheres_.push_back({centerline.point_at(s, t), centerline.radius_at(s, t)});
        next_.emplace_back();
        cones_.push_back({s});
        const auto sphere = static_cast<Index>(spheres_.size() - 1);
        connect(last, sphere);
        last = sphere;
      }
      connect(last, centerline.segment(s).b);
      cones_[centerline.segment(s).b].push_back(s);
    }
  }

  void connect(Index p, Index q) {
    next_[p].push_back(q);
    next_[q].push_back(p);
  }

  std::size_t count_;
  double gap_;  // smaller radii
  std::vector<char> local_;
  std::vector<CenterlineNode> spheres_;
  std::vector<std::vector<Index>> next_, cones_;
  bool undecided_ = false;
};

constexpr double kBlends[] = {0, 0.3, 0.5};

// Compares what the field knows of all pairs of segments with the definition; visits them.
template <class Visit>
void compare_segments(const VesselField& field, const Locality& expected, Index segments, const Visit& visit) {
  // Without rounding, those that part are local to each other up to half a radius. (Spheres are denser there.)
  const bool is_plain = field.relations().blend() == 0;
  const Locality widest(field, 0.55);
  for (Index i = 0; i < segments; ++i) {
    const auto cones = field.relations().local_cones(i);
    EXPECT_TRUE(std::is_sorted(cones.begin(), cones.end(), std::less_equal<>()));  // ascending, none twice
    for (Index j = 0; j < segments; ++j) {
      const bool local = expected(i, j);
      EXPECT_TRUE(!local || is_local(field, i, j)) << "cones " << i << " and " << j;
      EXPECT_TRUE(!is_plain || !is_local(field, i, j) || widest(i, j)) << "cones " << i << " and " << j;
      EXPECT_EQ(field.relations().are_one_volume(i, j), local) << "cones " << i << " and " << j;
      visit(i, j, local);
    }
  }
}

TEST(Locality, IsTouchWithoutABreak) {
  Draw draw(61);
  int tested = 0, local_pairs = 0, far_pairs = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // A random walk that branches and closes loops, tight enough that overlaps spread.
    CenterlineBuilder walk;
    walk.add({0, 0, 0}, 0.5);
    for (int i = 0; i < 30; ++i) {
      const auto count = static_cast<Index>(walk.nodes.size());
      const Index from = draw.chance(0.8) ? count - 1 : draw.below(count);
      const Vec3 place = walk.nodes[from].position + draw.uniform(0.2, 2) * draw.direction();
      walk.add(place, draw.uniform(0.05, 0.6), from);
    }
    walk.segments.push_back({0, 29});
    walk.add({50, 0, 0}, 1);
    const Centerline centerline = walk.build();
    const VesselField field(centerline, kBlends[trial % 3]);
    const Locality expected(field);
    if (expected.undecided()) continue;
    ++tested;
    SCOPED_TRACE("trial " + std::to_string(trial));
    const auto segments = static_cast<Index>(centerline.segments().size());
    compare_segments(field, expected, segments,
                     [&](Index, Index, bool local) { (local ? local_pairs : far_pairs) += 1; });
    const auto ball = field.relations().local_cones(segments);
    EXPECT_EQ(std::vector<Index>(ball.begin(), ball.end()), (std::vector<Index>{segments}));
  }
  EXPECT_GT(tested, 50);
  EXPECT_GT(local_pairs, 5000);
  EXPECT_GT(far_pairs, 5000);
}

// So many branches at one node that no pairs of them are listed: some go on straight, some turn and touch others, some
// are so short that their second segments overlap, and radii differ.
TEST(Locality, IsTouchWithoutABreakAroundANodeOfVeryManyBranchesToo) {
  int tested = 0, own_pairs = 0, far_pairs = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    Draw draw(700 + seed);
    CenterlineBuilder star;
    star.add({0, 0, 0}, draw.uniform(0.2, 1));
    constexpr int kBranches = 66;
    for (int branch = 0; branch < kBranches; ++branch) {
      const Vec3 way = draw.direction();
      const Vec3 first = draw.uniform(0.3, 4) * way;
      const Index middle = star.add(first, draw.uniform(0.1, 0.4), 0);
      if (draw.chance(0.7)) star.add(first + draw.uniform(0.5, 3) * draw.direction(), draw.uniform(0.1, 0.4), middle);
    }
    const Centerline centerline = star.build();
    ASSERT_EQ(centerline.degree(0), kBranches);
    const VesselField field(centerline, kBlends[seed % 3]);
    const Locality expected(field);
    if (expected.undecided()) continue;
    ++tested;
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto segments = static_cast<Index>(centerline.segments().size());
    compare_segments(field, expected, segments, [&](Index i, Index j, bool local) {
      const bool at_hub = centerline.segment(i).a == 0 && centerline.segment(j).a == 0;
      if (!local) ++far_pairs;
      if (local && !at_hub && i != j) ++own_pairs;
    });
  }
  EXPECT_GT(tested, 3);
  EXPECT_GT(own_pairs, 1000);
  EXPECT_GT(far_pairs, 1000);
}

// Where straight vessels part, their walls only move apart: nothing is there that the rounding must not join.
TEST(Locality, LeavesTheRoundingBetweenStraightBranchesOfOneNode) {
  for (const int branches : {40, 100, 250}) {
    const Centerline centerline = testing::star(branches);
    const VesselField field(centerline, 0.5);
    EXPECT_EQ(field.relations().rounding_of(0), 1) << branches << " branches";
  }
}

// An open ring whose ends touch in space.
Centerline open_ring() {
  CenterlineBuilder ring;
  Index last = kNone;
  for (int i = 0; i <= 60; ++i) {
    const double angle = 0.2 + i * (2 * 3.14159265358979 - 0.4) / 60;
    last = ring.add({10 * std::cos(angle), 10 * std::sin(angle), 0}, 2.2, last);
  }
  return ring.build();
}

TEST(Locality, HidesVesselsThatTouchInSpaceButAreFarAlongTheGraph) {
  const Centerline centerline = open_ring();
  const VesselField field(centerline);
  const Index first = 0, last = 59;
  EXPECT_FALSE(is_local(field, first, last));
  // In the gap, beyond the first end and within the last one's sphere.
  const Vec3 p(10 * std::cos(-0.15), 10 * std::sin(-0.15), 0);
  const auto seen_from_first = field.sample(p, first), seen_from_last = field.sample(p, last);
  EXPECT_EQ(seen_from_first.cone, first);
  EXPECT_GT(seen_from_first.distance, 0);
  EXPECT_EQ(seen_from_last.cone, last);
  EXPECT_LT(seen_from_last.distance, 0);
  EXPECT_EQ(field.sample_global(p).cone, last);
  EXPECT_EQ(field.sample_global(p).distance, seen_from_last.distance);
}

TEST(Locality, HidesVesselsOfOtherComponents) {
  const Centerline centerline({{{-5, 0, 0}, 1}, {{5, 0, 0}, 1}, {{0, -5, 1}, 1}, {{0, 5, 1}, 1}, {{0, 0, 0.5}, 1}},
                              {{0, 1}, {2, 3}});
  const VesselField field(centerline, 0.5);
  for (Index c = 0; c < 3; ++c) {
    ASSERT_EQ(field.relations().local_cones(c).size(), 1u);
    const Vec3 p(0.2, 0.3, 1.2);
    EXPECT_EQ(field.sample(p, c).cone, c);
    EXPECT_EQ(field.sample(p, c).distance, field.sample_cone(p, c).distance);
  }
}

// Two vessels from one node, `angle` apart, with steps of their own.
Centerline siblings(Draw& draw, double degrees, double length, double shortest, double longest) {
  CenterlineBuilder tree;
  const Index trunk = tree.add({-6, 0, 0}, 1.2);
  const Index fork = tree.add({0, 0, 0}, 1.2, trunk);
  for (const double side : {-0.5, 0.5}) {
    const double angle = side * degrees * 3.14159265358979 / 180;
    Index last = fork;
    for (double s = 0; s < length;) {
      s += draw.uniform(shortest, longest);
      last = tree.add({s * std::cos(angle), s * std::sin(angle), 0}, 1, last);
    }
  }
  return tree.build();
}

TEST(Locality, KeepsShallowSiblingsOneUnionUntilTheyPart) {
  Draw draw(62);
  // At 2 degrees spheres of radius 1 part after 57, and count as touching (2.5 apart) until 72. A long segment counts
  // as a whole.
  for (const auto& [shortest, longest] : {std::pair(0.3, 0.3001), {0.2, 3.0}, {4.0, 9.0}}) {
    const Centerline centerline = siblings(draw, 2, 100, shortest, longest);
    const VesselField field(centerline);
    const auto count = static_cast<Index>(centerline.segments().size());
    int overlapping = 0, parted = 0;
    for (Index i = 0; i < count; ++i) {
      for (Index j = 0; j < count; ++j) {
        const double apart = axis_distance(field, i, j), radii = max_radius(field, i) + max_radius(field, j);
        if (apart < radii) {
          ++overlapping;
          EXPECT_TRUE(is_local(field, i, j)) << i << " " << j;
        }
        if (field.relations().axis_point(i, 0).x() > 73 && field.relations().axis_point(j, 0).x() > 73 &&
            field.relations().axis_point(i, 0).y() * field.relations().axis_point(j, 0).y() < 0) {
          ++parted;
          EXPECT_FALSE(is_local(field, i, j)) << i << " " << j;
        }
      }
    }
    EXPECT_GT(overlapping, static_cast<int>(count));
    EXPECT_GT(parted, 0);
    // So a query from either sees the union: on every cross-section until they part, around both.
    for (int k = 0; k < 2000; ++k) {
      const double x = draw.uniform(0, 57);
      const Vec3 p(x, draw.uniform(-2, 2), draw.uniform(-1.2, 1.2));
      const auto global = field.sample_global(p);
      if (global.distance > 0.2) continue;
      for (Index c = 1; c < count; ++c) {
        const double from = std::min(field.relations().axis_point(c, 0).x(), field.relations().axis_point(c, 1).x());
        const double to = std::max(field.relations().axis_point(c, 0).x(), field.relations().axis_point(c, 1).x());
        if (x >= from && x <= to) {
          EXPECT_EQ(field.sample(p, c).distance, global.distance) << p.transpose();
        }
      }
    }
  }
}

// Two parallel legs `gap` apart, joined by a half circle.
Centerline hairpin(double gap) {
  CenterlineBuilder line;
  Index last = kNone;
  for (double x = 30; x > 0; x -= 0.5) last = line.add({x, gap / 2, 0}, 1, last);
  for (int i = 0; i <= 12; ++i) {
    const double angle = 3.14159265358979 * (0.5 + i / 12.0);
    last = line.add({gap / 2 * std::cos(angle), gap / 2 * std::sin(angle), 0}, 1, last);
  }
  for (double x = 0.5; x <= 30; x += 0.5) last = line.add({x, -gap / 2, 0}, 1, last);
  return line.build();
}

TEST(Locality, ZipsUpATightHairpinAndLeavesAWideOneOpen) {
  for (const auto& [gap, zipped] : {std::pair(1.5, true), {2.4, true}, {2.6, false}, {3.0, false}}) {
    const Centerline centerline = hairpin(gap);
    const VesselField field(centerline);
    const auto count = static_cast<Index>(centerline.segments().size());
    for (const Index i : {0u, 10u, 30u}) {  // at x = 30, 25, 15; the opposite cone is as far from the other end
      const Index opposite = count - 1 - i;
      EXPECT_NEAR(axis_distance(field, i, opposite), gap, 0.01);
      EXPECT_EQ(is_local(field, i, opposite), zipped) << "gap " << gap << ", cone " << i;
      const Vec3 wall = field.relations().axis_point(opposite, 0.5) + Vec3(0, 0, 1.01);
      EXPECT_EQ(field.sample(wall, i).cone == field.sample_global(wall).cone, zipped);
    }
    EXPECT_TRUE(is_local(field, count / 2, count / 2 + 1));
  }
}

TEST(Locality, AQueryFollowsTheVesselFromAnyHint) {
  CenterlineBuilder line;
  Index last = line.add({0, 0, 0}, 1);
  for (int i = 1; i <= 400; ++i) last = line.add({0.5 * i, 0, 0}, 1, last);
  const Centerline centerline = line.build();
  const VesselField field(centerline);
  for (const Index hint : {0u, 57u, 200u, 399u}) {
    for (const double x : {0.3, 40.2, 120.7, 199.8}) {
      const auto s = field.sample({x, 1.5, 0}, hint);
      EXPECT_EQ(s.cone, static_cast<Index>(2 * x));
      EXPECT_EQ(s.distance, 0.5);
    }
  }
}

// Otherwise the boundary has a step where it leaves the rounding between two thick ones.
TEST(Locality, AThinVesselSeesTheRoundingThatCoversIt) {
  for (const double blend : {1.0, 1.5, 2.0}) {
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
      SeparationOptions options;
      options.blend = blend;
      const SeparatedCenterline tree = separate_contacts(testing::short_thick_tree(seed), options);
      const VesselField field(tree.centerline, blend);
      for (Index s = 0; s < tree.centerline.segments().size(); ++s) {
        for (const double t : {0.0, 0.5, 1.0}) {
          const Vec3 p = tree.centerline.point_at(s, t);
          EXPECT_NEAR(field.sample(p, s).distance, field.sample_global(p).distance,
                      0.01 * tree.centerline.radius_at(s, t))
              << "blend " << blend << ", seed " << seed << ", segment " << s;
        }
      }
    }
  }
}

}  // namespace
}  // namespace vmesh
