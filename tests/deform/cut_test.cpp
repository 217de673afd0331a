#include "vmesh/centerline/cut.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

Centerline small_tree(std::uint64_t seed = 1) {
  SyntheticTreeOptions shape;
  shape.vertices = 120;
  shape.seed = seed;
  return synthetic_tree(shape);
}

Centerline circle(int count) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    nodes.push_back({10 * Vec3(std::cos(angle), std::sin(angle), 0), 1});
    segments.push_back({static_cast<Index>(i), static_cast<Index>((i + 1) % count)});
  }
  return {std::move(nodes), std::move(segments)};
}

std::vector<Vec3> positions_of(const CenterlineSimulation& simulation) { return simulation.pose().position; }

double farthest(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  double most = 0;
  for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, (to[i] - from[i]).norm());
  return most;
}

std::vector<double> segment_masses(const Centerline& centerline, const Material& material) {
  std::vector<double> mass;
  for (const SegmentProperties& p : segment_properties(centerline, material)) mass.push_back(p.mass_kg);
  return mass;
}

/// The mass of the segment cut is divided as its length is.
std::vector<double> masses_after(std::vector<double> mass, const CenterlineCut& cut) {
  mass.push_back((1 - cut.at.t) * mass[cut.at.segment]);
  mass[cut.at.segment] *= cut.at.t;
  return mass;
}

/// Mean momentum over the next step, kg mm/s: half of each segment's mass at either end.
Vec3 next_momentum(CenterlineSimulation& simulation, const std::vector<double>& mass, double step_s) {
  const std::vector<Vec3> before = positions_of(simulation);
  simulation.step();
  const std::vector<Vec3>& after = simulation.pose().position;
  const RodTree& tree = simulation.tree();
  Vec3 momentum = Vec3::Zero();
  for (Index j = 0; j < tree.size(); ++j) {
    if (tree.parent[j] == kNone) continue;
    const Index p = tree.parent[j];
    momentum += mass[tree.segment[j]] / 2 / step_s * (after[j] - before[j] + after[p] - before[p]);
  }
  return momentum;
}

TEST(Cut, PlacesGoThereAndBack) {
  const Centerline rod = straight_rod(4, 8, 1);
  const CenterlineCut cut = cut_centerline(rod, {1, 0.25});
  EXPECT_EQ(cut.centerline.nodes().size(), 7);
  EXPECT_EQ(cut.centerline.component_count(), 2);
  Draw draw(1);
  for (int i = 0; i < 100; ++i) {
    const SegmentPlace place{draw.below(4), draw.uniform(0, 1)}, after = cut.after(place), back = cut.before(after);
    EXPECT_LT((cut.centerline.point_at(after.segment, after.t) - rod.point_at(place.segment, place.t)).norm(), 1e-14);
    EXPECT_EQ(back.segment, place.segment);
    EXPECT_NEAR(back.t, place.t, 1e-15);
  }
}

TEST(Cut, IsRefusedWhereNothingIsAcross) {
  const Centerline rod = straight_rod(4, 8, 1);
  EXPECT_THROW(cut_at_node(rod, 0), InvalidInput);
  EXPECT_THROW(cut_at_node(rod, 5), InvalidInput);
  EXPECT_THROW(cut_centerline(rod, {0, 1e-5}), InvalidInput);
  EXPECT_THROW(cut_centerline(rod, {4, 0.5}), InvalidInput);
  EXPECT_THROW(cut_centerline(rod, {0, 1.5}), InvalidInput);
  const Centerline star({{{0, 0, 0}, 1}, {{5, 0, 0}, 1}, {{0, 5, 0}, 1}, {{-5, 0, 0}, 1}}, {{0, 1}, {0, 2}, {0, 3}});
  EXPECT_THROW(cut_at_node(star, 0), InvalidInput);
  // Once cut, the vessel ends there.
  const CenterlineCut once = cut_centerline(rod, {1, 0.5});
  EXPECT_THROW(cut_centerline(once.centerline, {once.end_segment[0], 1}), InvalidInput);
  EXPECT_THROW(cut_at_node(once.centerline, once.end[1]), InvalidInput);
  CenterlineSimulation simulation = simulate(rod, {}, {});
  simulation.fix(2);
  EXPECT_THROW(simulation.cut(cut_at_node(rod, 2)), InvalidInput);
  EXPECT_THROW(simulation.cut(cut_centerline(star, {0, 0.5})), InvalidInput);
}

/// Any number of cuts, wherever they are, of what is at rest: nothing moves, to rounding.
void expect_still(Centerline centerline, Integrator integrator, int cuts, std::uint32_t seed) {
  SimulationOptions options;
  options.integrator = integrator;
  CenterlineSimulation simulation = simulate(centerline, {}, options);
  Draw draw(seed);
  for (int i = 0; i < cuts; ++i) {
    const SegmentPlace place{draw.below(static_cast<Index>(centerline.segments().size())), draw.uniform(0.01, 0.99)};
    CenterlineCut cut = cut_centerline(centerline, place);
    simulation.cut(cut);
    centerline = std::move(cut.centerline);
    for (Index n = 0; n < centerline.nodes().size(); ++n)
      EXPECT_LT((simulation.position(n) - centerline.node(n).position).norm(), 1e-10);
    const std::vector<Vec3> before = positions_of(simulation);
    for (int k = 0; k < 3; ++k) simulation.step();
    EXPECT_LT(farthest(before, positions_of(simulation)), 1e-10);
    EXPECT_LT(energy_J(simulation), 1e-20);
  }
  std::size_t roots = 0;
  for (const Index parent : simulation.tree().parent) roots += parent == kNone;
  EXPECT_EQ(roots, centerline.component_count());
}

TEST(Cut, OfATreeAtRestMovesNothing) {
  for (std::uint32_t seed = 1; seed < 6; ++seed) expect_still(small_tree(seed), Integrator::implicit, 20, seed);
}

TEST(Cut, OfATreeAtRestMovesNothingByThePapersProcedure) {
  expect_still(straight_rod(12, 24, 1), Integrator::paper, 5, 3);
}

TEST(Cut, OfALoopLeavesATreeWithoutATie) {
  for (Index s = 0; s < 12; ++s) {
    const Centerline loop = circle(12);
    CenterlineSimulation simulation = simulate(loop, {}, {});
    ASSERT_EQ(simulation.tree().ties.size(), 1);
    const std::vector<Vec3> before = positions_of(simulation);
    simulation.cut(s % 2 == 0 ? cut_centerline(loop, {s, 0.4}) : cut_at_node(loop, s));
    EXPECT_TRUE(simulation.tree().ties.empty());
    simulation.step();
    for (Index n = 0; n < 12; ++n) EXPECT_LT((simulation.position(n) - loop.node(n).position).norm(), 1e-10);
  }
}

/// Two rails and rungs between them: as many loops as there are rungs, less one.
Centerline ladder(int rungs) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i < rungs; ++i) {
    for (const double y : {0, 8}) nodes.push_back({Vec3(6 * i, y, i % 3), 1});
    const auto first = static_cast<Index>(2 * i);
    segments.push_back({first, first + 1});
    if (i > 0) segments.insert(segments.end(), {{first - 2, first}, {first + 1, first - 1}});
  }
  return {std::move(nodes), std::move(segments)};
}

TEST(Cut, OfManyLoopsMovesNothing) {
  for (std::uint32_t seed = 1; seed < 10; ++seed) expect_still(ladder(5), Integrator::implicit, 15, seed);
}

TEST(Cut, OfAMovingLoopKeepsMomentum) {
  const Centerline loops = ladder(4);
  const Material soft{.young_Pa = 3e4, .damping_s = 0};
  SimulationOptions options;
  options.step_s = 1e-5;
  options.iterations = 4;
  Draw draw(8);
  for (Index s = 0; s < loops.segments().size(); ++s) {
    CenterlineSimulation simulation = simulate(loops, soft, options);
    for (Index n = 0; n < loops.nodes().size(); ++n) simulation.set_velocity(n, draw.in_cube(300));
    for (int k = 0; k < 5; ++k) simulation.step();
    const CenterlineCut cut = cut_centerline(loops, {s, 0.3});
    const Vec3 momentum = next_momentum(simulation, segment_masses(loops, soft), options.step_s);
    simulation.cut(cut);
    const Vec3 after = next_momentum(simulation, masses_after(segment_masses(loops, soft), cut), options.step_s);
    EXPECT_LT((after - momentum).norm(), 1e-6 * momentum.norm()) << s;
  }
}

TEST(Cut, OfAMovingTreeKeepsMomentumAndAddsNoEnergy) {
  const Centerline tree = small_tree();
  const Material soft{.young_Pa = 3e4, .damping_s = 0};
  SimulationOptions options;
  options.step_s = 1e-5;  // so that a step's mean is the momentum at its start
  options.iterations = 4;
  Draw draw(5);
  for (int i = 0; i < 20; ++i) {
    CenterlineSimulation simulation = simulate(tree, soft, options);
    for (Index n = 0; n < tree.nodes().size(); ++n) simulation.set_velocity(n, draw.in_cube(300));
    for (int k = 0; k < 5; ++k) simulation.step();
    const SegmentPlace place{draw.below(static_cast<Index>(tree.segments().size())), draw.uniform(0.05, 0.95)};
    const CenterlineCut cut = cut_centerline(tree, place);
    std::vector<double> mass = segment_masses(tree, soft);
    const Vec3 momentum = next_momentum(simulation, mass, options.step_s);
    const double energy = energy_J(simulation);
    std::vector<Vec3> before;
    for (Index n = 0; n < tree.nodes().size(); ++n) before.push_back(simulation.position(n));
    simulation.cut(cut);
    EXPECT_LE(energy_J(simulation), energy * (1 + 1e-12));
    for (Index n = 0; n < tree.nodes().size(); ++n) EXPECT_EQ(simulation.position(n), before[n]);
    mass = masses_after(mass, cut);
    const Vec3 after = next_momentum(simulation, mass, options.step_s);
    EXPECT_LT((after - momentum).norm(), 1e-6 * momentum.norm());
    EXPECT_LE(energy_J(simulation), energy * (1 + 1e-9));
  }
}

TEST(Cut, OfAStretchedRodSpringsBackBothWays) {
  const Centerline rod = straight_rod(10, 100, 2);
  const Material soft{.young_Pa = 1e5};
  SimulationOptions options;
  options.step_s = 1e-3;
  CenterlineSimulation simulation = simulate(rod, soft, options);
  simulation.drag(0, Vec3(-10, 0, 0));
  simulation.drag(10, Vec3(110, 0, 0));
  for (int i = 0; i < 2000; ++i) simulation.step();
  const double stretched = simulation.elastic_energy_J();
  const CenterlineCut cut = cut_centerline(rod, {4, 0.5});
  simulation.cut(cut);
  // The two new ends are where the rod was, half way between nodes 4 and 5.
  const Vec3 place = (simulation.position(4) + simulation.position(5)) / 2;
  EXPECT_LT((simulation.position(cut.end[0]) - place).norm(), 1e-12);
  EXPECT_EQ(simulation.position(cut.end[0]), simulation.position(cut.end[1]));
  EXPECT_NEAR(simulation.elastic_energy_J(), stretched, 1e-9 * stretched);
  simulation.release(0);
  simulation.release(10);
  const std::vector<double> mass = masses_after(segment_masses(rod, soft), cut);
  double speed_sum = 0;
  for (const double m : mass) speed_sum += m * 1e3;  // of all at 1 m/s
  for (int i = 0; i < 50; ++i) EXPECT_LT(next_momentum(simulation, mass, options.step_s).norm(), 1e-9 * speed_sum);
  for (int i = 0; i < 5000; ++i) simulation.step();
  // Either half is as long as it was at rest, and they have parted by what they were stretched.
  EXPECT_NEAR((simulation.position(cut.end[0]) - simulation.position(0)).norm(), 45, 1e-4);
  EXPECT_NEAR((simulation.position(cut.end[1]) - simulation.position(10)).norm(), 55, 1e-4);
  EXPECT_GT(simulation.position(cut.end[1]).x() - simulation.position(cut.end[0]).x(), 5);
}

TEST(Cut, DividingAMovingSegmentChangesNothing) {
  const Centerline tree = small_tree();
  SimulationOptions options;
  options.step_s = 1e-5;
  options.iterations = 4;
  const Material soft{.young_Pa = 3e4, .damping_s = 0};
  Draw draw(4);
  for (int i = 0; i < 10; ++i) {
    CenterlineSimulation simulation = simulate(tree, soft, options);
    for (Index n = 0; n < tree.nodes().size(); ++n) simulation.set_velocity(n, draw.in_cube(300));
    for (int k = 0; k < 5; ++k) simulation.step();
    const SegmentPlace place{draw.below(static_cast<Index>(tree.segments().size())), draw.uniform(0.1, 0.9)};
    const InsertedNode inserted = insert_node(tree, place);
    std::vector<double> mass = segment_masses(tree, soft);
    const Vec3 momentum = next_momentum(simulation, mass, options.step_s);
    const double energy = energy_J(simulation);
    const std::vector<Vec3> before = positions_of(simulation);
    simulation.divide(inserted);
    EXPECT_EQ(positions_of(simulation).size(), before.size() + 1);
    EXPECT_LE(energy_J(simulation), energy * (1 + 1e-12));
    mass.push_back((1 - place.t) * mass[place.segment]);
    mass[place.segment] *= place.t;
    EXPECT_LT((next_momentum(simulation, mass, options.step_s) - momentum).norm(), 1e-6 * momentum.norm());
  }
}

TEST(Cut, AClipIsAsWideAsItSays) {
  const Centerline rod = straight_rod(10, 100, 2);
  const ClippedVessel clipped = clip_vessel(rod, {4, 0.5}, {.width_mm = 3, .scale = 0.1});
  EXPECT_EQ(clipped.inserted.size(), 4);
  ASSERT_EQ(clipped.scales.size(), 2);  // where it begins and ends; beyond the slopes all is as it was
  const Centerline& after = clipped.inserted.back().centerline;
  for (const auto& [node, scale] : clipped.scales) {
    EXPECT_NEAR(std::abs(after.node(node).position.x() - 45), 1.5, 1e-9);
    EXPECT_NEAR(scale, 0.1, 1e-9);
  }
  // A node within the slope is between.
  const ClippedVessel beside = clip_vessel(rod, {4, 0.75}, {.width_mm = 3, .scale = 0.1});
  ASSERT_EQ(beside.scales.size(), 3);
  EXPECT_EQ(beside.scales.front().node, 5);
  EXPECT_NEAR(beside.scales.front().scale, 0.1 + 0.9 * (2.5 - 1.5) / 2, 1e-9);
  EXPECT_THROW(clip_vessel(rod, {0, 0.2}, {}), InvalidInput);
  EXPECT_THROW(clip_vessel(rod, {4, 0.5}, {.scale = 0}), InvalidInput);
}

TEST(Cut, KeepsHoldsForcesAndProfiles) {
  const Centerline rod = straight_rod(10, 100, 2);
  CenterlineSimulation simulation = simulate(rod, {.young_Pa = 1e5}, {});
  simulation.clamp(0);
  simulation.drag(10, Vec3(100, 5, 0));
  simulation.set_radial_scale(4, 0.5);
  simulation.step();
  const CenterlineCut cut = cut_centerline(rod, {4, 0.25});
  simulation.cut(cut);
  const auto scale = [&](Index node) { return simulation.pose().radial_scale[simulation.tree().slot_of_node[node]]; };
  EXPECT_EQ(scale(4), 0.5);
  EXPECT_NEAR(scale(cut.end[0]), 0.625, 1e-15);
  EXPECT_EQ(scale(cut.end[1]), scale(cut.end[0]));
  for (int i = 0; i < 200; ++i) simulation.step();
  EXPECT_EQ(simulation.position(0), Vec3::Zero());
  EXPECT_LT((simulation.position(10) - Vec3(100, 5, 0)).norm(), 1e-12);
  simulation.set_force(cut.end[0], Vec3(0, 0, 1e-3));
  for (int i = 0; i < 200; ++i) simulation.step();
  EXPECT_GT(simulation.position(cut.end[0]).z(), 0.1);
  EXPECT_LT(std::abs(simulation.position(cut.end[1]).z()), 1e-6);
}

TEST(Cut, CapsStayFlat) {
  const Centerline rod = straight_rod(10, 100, 2);
  CenterlineSimulation simulation = simulate(rod, {.young_Pa = 3e4}, {});
  simulation.clamp(0);
  const CenterlineCut cut = cut_centerline(rod, {4, 0.25});
  simulation.cut(cut);
  simulation.set_gravity(Vec3(0, 0, -9810));
  std::vector<Vec3> points, normals;
  std::vector<SurfacePlace> places;
  for (int i = 0; i < 12; ++i) {
    const double angle = std::numbers::pi * i / 6;
    points.push_back(cut.position + 2 * Vec3(0, std::cos(angle), std::sin(angle)));
    normals.emplace_back(1, 0, 0);
    places.push_back({cut.end_segment[0], 1});
  }
  const SurfaceBinding binding(cut.centerline, simulation.tree(), points, normals, places);
  DeformedSurface surface = binding.make_surface();
  for (int i = 0; i < 50; ++i) simulation.step();
  binding.apply(simulation.pose(), surface);
  std::vector<Vec3> cap;
  for (const Index lane : binding.lane_of_vertex()) cap.push_back(surface.position(lane));
  EXPECT_GT((cap[0] - points[0]).norm(), 1);  // it has moved
  const Vec3 normal = (cap[4] - cap[0]).cross(cap[8] - cap[0]).normalized();
  for (const Vec3& p : cap) EXPECT_LT(std::abs((p - cap[0]).dot(normal)), 1e-4);  // single precision of 100 mm
}

}  // namespace
}  // namespace vmesh::testing
