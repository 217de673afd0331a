#include "vmesh/deform/surface_binding.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/deform/linear_skin.h"
#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "deform/synchronise.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

Centerline synthetic_tree_of(std::size_t vertices) {
  SyntheticTreeOptions shape;
  shape.vertices = vertices;
  return synthetic_tree(shape);
}

/// Points on the walls of a tree's vessels, with their normals and places.
struct Wall {
  std::vector<Vec3> points, normals;
  std::vector<SurfacePlace> places;

  Wall(const Centerline& tree, int per_segment) {
    Draw draw(3);
    for (Index s = 0; s < tree.segments().size(); ++s)
      for (int i = 0; i < per_segment; ++i) {
        const double t = draw.uniform(0, 1);
        const Vec3 across = draw.across(tree.node(tree.segment(s).b).position - tree.node(tree.segment(s).a).position);
        points.push_back(tree.point_at(s, t) + tree.radius_at(s, t) * across);
        normals.push_back(across);
        places.push_back({s, t});
      }
  }
};

/// Eqs. 1, 2, 9 and 10 as they are written.
Vec3 by_the_paper(const Centerline& centerline, const RodTree& tree, const Pose& pose, const SurfacePlace& place,
                  const Vec3& vertex) {
  const Index slot = tree.slot_of_segment[place.segment], parent = tree.parent[slot];
  const auto& [a, b] = centerline.segment(place.segment);
  const Index slot_a = tree.node[slot] == a ? slot : parent, slot_b = slot_a == slot ? parent : slot;
  EXPECT_EQ(tree.node[slot_b], b);
  const auto axis = [&](const std::vector<Vec3>& p) -> Vec3 { return (1 - place.t) * p[slot_a] + place.t * p[slot_b]; };
  const Vec3 v = vertex - axis(tree.position);
  const Vec3 in_own = tree.frame[slot].transpose() * v, in_parent = tree.frame[parent].transpose() * v;
  return axis(pose.position) + 0.5 * (pose.frame[slot] * in_own + pose.frame[parent] * in_parent);
}

Pose bent_pose(const Centerline& tree) {
  SimulationOptions options;
  options.gravity_mm_s2 = Vec3(5000, -3000, 9810);
  CenterlineSimulation simulation = simulate(tree, {.young_Pa = 3e4}, options);
  simulation.clamp(0);
  for (int i = 0; i < 30; ++i) simulation.step();
  return simulation.pose();
}

/// The accuracy of apply() for a vertex at `arm` from its place: single precision of arms and of coordinates.
double precision(const DeformedSurface& surface, const Vec3& arm) {
  double largest = 0;
  for (const std::vector<float>* values : {&surface.x, &surface.y, &surface.z})
    for (const float x : *values) largest = std::max(largest, std::abs(static_cast<double>(x)));
  return 1e-6 * arm.norm() + 2e-7 * largest;
}

TEST(SurfaceBinding, IsEquation10) {
  const Centerline tree = synthetic_tree_of(300);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 7);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  const Pose pose = bent_pose(tree);
  DeformedSurface surface = binding.make_surface(SurfaceBinding::Normals::with);
  binding.apply(pose, surface);
  double farthest = 0;
  for (Index v = 0; v < wall.points.size(); ++v) {
    const SurfacePlace& place = wall.places[v];
    const Vec3 p = surface.position(binding.lane_of_vertex()[v]);
    EXPECT_LE((p - by_the_paper(tree, rods, pose, place, wall.points[v])).norm(),
              precision(surface, wall.points[v] - tree.point_at(place.segment, place.t)))
        << v;
    EXPECT_NEAR(surface.normal(binding.lane_of_vertex()[v]).norm(), 1, 1e-6) << v;
    farthest = std::max(farthest, (p - wall.points[v]).norm());
  }
  EXPECT_GT(farthest, 10) << "the pose is to be bent";
}

TEST(SurfaceBinding, FollowsARigidMotionExactly) {
  const Centerline tree = synthetic_tree_of(119);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 5);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  const Mat3 turn = Eigen::AngleAxisd(2.3, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Vec3 shift(40, -70, 15);
  Pose pose = rest_pose(rods);
  for (Vec3& p : pose.position) p = turn * p + shift;
  for (Mat3& frame : pose.frame) frame = turn * frame;
  DeformedSurface surface = binding.make_surface(SurfaceBinding::Normals::with);
  binding.apply(pose, surface);
  for (Index v = 0; v < wall.points.size(); ++v) {
    const Index lane = binding.lane_of_vertex()[v];
    const double radius = tree.radius_at(wall.places[v].segment, wall.places[v].t);
    EXPECT_LE((surface.position(lane) - turn * wall.points[v] - shift).norm(), precision(surface, Vec3(radius, 0, 0)))
        << v;
    // Three products of single precision.
    EXPECT_LE((surface.normal(lane) - turn * wall.normals[v]).norm(), 5e-7) << v;
  }
}

TEST(SurfaceBinding, IsAsPreciseFarFromTheOrigin) {
  const Centerline near = synthetic_tree_of(119);
  std::vector<CenterlineNode> nodes = near.nodes();
  for (CenterlineNode& node : nodes) node.position += Vec3(1e5, -2e5, 3e5);
  const Centerline tree(nodes, near.segments());
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 5);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  const DeformedSurface surface = binding.make_surface();
  for (Index v = 0; v < wall.points.size(); ++v)
    // Single precision would be 0.03 mm there.
    EXPECT_LE((surface.position(binding.lane_of_vertex()[v]) - wall.points[v]).norm(), 1e-4) << v;
}

TEST(SurfaceBinding, NormalsAreForWhoAsks) {
  const Centerline tree = synthetic_tree_of(119);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 5);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  const Pose pose = bent_pose(tree);
  DeformedSurface plain = binding.make_surface(), with = binding.make_surface(SurfaceBinding::Normals::with);
  binding.apply(pose, plain);
  binding.apply(pose, with);
  EXPECT_TRUE(plain.normal_x.empty() && plain.normal_y.empty() && plain.normal_z.empty());
  EXPECT_EQ(plain.x, with.x);
  EXPECT_EQ(plain.y, with.y);
  EXPECT_EQ(plain.z, with.z);
}

TEST(SurfaceBinding, SameBytesOnEveryMachine) {
  const Centerline tree = synthetic_tree_of(300);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 7);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  Pose pose = bent_pose(tree);
  Draw draw(4);
  std::vector<char> moved(rods.size());
  for (char& m : moved) m = draw.chance(0.8);
  for (const bool scaled : {false, true}) {
    if (scaled)
      for (std::size_t j = 0; j < rods.size(); ++j) pose.radial_scale.push_back(draw.uniform(0.5, 2));
    for (const auto normals : {SurfaceBinding::Normals::without, SurfaceBinding::Normals::with}) {
      DeformedSurface plain = binding.make_surface(normals), best = plain;
      for (const std::span<const char> some : {std::span<const char>(moved), std::span<const char>()}) {
        binding.apply(pose, some, plain, InstructionSet::plain);
        binding.apply(pose, some, best);
        EXPECT_EQ(plain.x, best.x);
        EXPECT_EQ(plain.y, best.y);
        EXPECT_EQ(plain.z, best.z);
        EXPECT_EQ(plain.normal_x, best.normal_x);
        EXPECT_EQ(plain.normal_y, best.normal_y);
        EXPECT_EQ(plain.normal_z, best.normal_z);
      }
    }
  }
}

TEST(SurfaceBinding, NearestPlacesAreThoseOfASearchThroughAll) {
  const Centerline tree = synthetic_tree_of(119);
  const Wall wall(tree, 3);
  const std::vector<SurfacePlace> found = nearest_places(tree, wall.points);
  for (std::size_t v = 0; v < wall.points.size(); ++v) {
    double nearest = 1e9;
    for (Index s = 0; s < tree.segments().size(); ++s) {
      const Vec3 a = tree.point_at(s, 0), along = tree.point_at(s, 1) - a;
      const double t = std::clamp(along.dot(wall.points[v] - a) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (wall.points[v] - a - t * along).norm());
    }
    EXPECT_NEAR((wall.points[v] - tree.point_at(found[v].segment, found[v].t)).norm(), nearest, 1e-12) << v;
  }
}

TEST(SurfaceBinding, LeavesAloneWhatDidNotMove) {
  const Centerline tree = synthetic_tree_of(119);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 5);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  Pose pose = rest_pose(rods);
  std::vector<char> moved(rods.size(), 0);
  pose.position[50] += Vec3(1, 0, 0);
  moved[50] = 1;
  DeformedSurface all = binding.make_surface(), some = binding.make_surface();
  for (float& x : some.x) x += 1000;
  binding.apply(pose, all);
  binding.apply(pose, moved, some);
  std::size_t written = 0;
  for (std::size_t v = 0; v < wall.points.size(); ++v) {
    const Index lane = binding.lane_of_vertex()[v], slot = rods.slot_of_segment[wall.places[v].segment];
    const bool touched = slot == 50 || rods.parent[slot] == 50;
    EXPECT_EQ(some.x[lane] == all.x[lane], touched) << v;
    written += touched;
  }
  EXPECT_GT(written, 0u);
}

TEST(SurfaceBinding, ProfileScalesTheConnectingVectors) {
  const Centerline rod = straight_rod(4, 40, 2);
  const RodTree rods = make_rod_tree(rod);
  const std::vector<Vec3> points{{5, 2, 0}, {15, 0, 2}}, normals{{0, 1, 0}, {0, 0, 1}};
  const SurfaceBinding binding(rod, rods, points, normals, nearest_places(rod, points));
  Pose pose = rest_pose(rods);
  pose.radial_scale = {1, 0.5, 1, 1, 1};
  DeformedSurface surface = binding.make_surface();
  binding.apply(pose, surface);
  EXPECT_LT((surface.position(binding.lane_of_vertex()[0]) - Vec3(5, 1.5, 0)).norm(), 1e-6);
  EXPECT_LT((surface.position(binding.lane_of_vertex()[1]) - Vec3(15, 0, 1.5)).norm(), 1e-6);
}

TEST(SurfaceBinding, RefusesWhatIsNoPlace) {
  const Centerline rod = straight_rod(2, 10, 1);
  const RodTree rods = make_rod_tree(rod);
  const std::vector<Vec3> one{Vec3(1, 1, 0)};
  for (const SurfacePlace& wrong :
       {SurfacePlace{2, 0.5}, SurfacePlace{0, 1.5}, SurfacePlace{kNone, 0}, SurfacePlace{0, NAN}})
    EXPECT_THROW(SurfaceBinding(rod, rods, one, one, std::vector{wrong}), InvalidInput);
  EXPECT_THROW(SurfaceBinding(rod, rods, one, {}, std::vector{SurfacePlace{0, 0}}), InvalidInput);
}

TEST(LinearSkin, PutsVerticesWhereTheBindingDoes) {
  const Centerline tree = synthetic_tree_of(300);
  const RodTree rods = make_rod_tree(tree);
  const Wall wall(tree, 7);
  const SurfaceBinding binding(tree, rods, wall.points, wall.normals, wall.places);
  const SurfaceSkin skin = make_linear_skin(tree, rods, wall.places);
  const Pose pose = bent_pose(tree);
  const std::vector<JointPose> joints = joint_poses(rods, pose);
  ASSERT_EQ(joints.size(), skin.joints.size());
  ASSERT_EQ(skin.joint_of_vertex.size(), wall.points.size());
  DeformedSurface surface = binding.make_surface();
  binding.apply(pose, surface);
  double farthest = 0;
  for (Index v = 0; v < wall.points.size(); ++v) {
    Vec3 sum = Vec3::Zero();
    float weights = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const JointPose& joint = joints[skin.joint_of_vertex[v][i]];
      const Vec3& rest = skin.joints[skin.joint_of_vertex[v][i]].position;
      sum += skin.weight[v][i] * (joint.rotation * (wall.points[v] - rest) + joint.position);
      weights += skin.weight[v][i];
    }
    EXPECT_NEAR(weights, 1, 1e-6f);
    const auto& [segment, t] = wall.places[v];
    const Vec3 arm = wall.points[v] - tree.point_at(segment, t);
    // The weights have single precision, too: of a segment's length.
    const double allowed = precision(surface, arm) + 1e-7 * tree.length(segment) + 1e-6 * arm.norm();
    EXPECT_LT((sum - surface.position(binding.lane_of_vertex()[v])).norm(), allowed) << v;
    farthest = std::max(farthest, (sum - wall.points[v]).norm());
  }
  EXPECT_GT(farthest, 1);  // it did bend
}

TEST(LinearSkin, HasBonesForIsolatedNodesAndRefusesPlacesThatDoNotExist) {
  const Centerline two({{{0, 0, 0}, 1}, {{5, 0, 0}, 1}, {{0, 9, 0}, 1}}, {{0, 1}});
  const std::vector<SurfacePlace> places = {{0, 0}, {0, 1}, {1, 0}};
  const SurfaceSkin skin = make_linear_skin(two, make_rod_tree(two), places);
  ASSERT_EQ(skin.joints.size(), 5u);
  EXPECT_EQ(skin.joints[skin.joint_of_vertex[2][0]].name, "node 2");
  EXPECT_EQ(skin.weight[2][0], 1);
  for (const SurfacePlace wrong : {SurfacePlace{2, 0}, SurfacePlace{0, 1.5}})
    EXPECT_THROW(make_linear_skin(two, make_rod_tree(two), std::vector{wrong}), InvalidInput);
}

}  // namespace
}  // namespace vmesh::testing
