// A fitted surface moves with its centerline: its profile is part of the binding.
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/deform/surface_binding.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/quality/sampled_distance.h"

#include "chains.h"

namespace vmesh::testing {
namespace {

Centerline bent_line() {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < 14; ++i) {
    nodes.push_back({{3.0 * i, 4 * std::sin(0.25 * i), 0}, 2});
    if (i > 0) segments.push_back({i - 1, i});
  }
  return {nodes, segments};
}

/// An oval vessel: half as high as wide.
FitResult fitted_to_oval(const Centerline& line) {
  GenerateOptions fine;
  fine.around = 24;
  fine.threads = 1;
  TriMesh oval = generate_surface(line, fine).mesh;
  for (Vec3& v : oval.vertices) v.z() *= 0.6;
  GenerateOptions options;
  options.threads = 1;
  GenerateResult grown = generate_surface(line, options);
  FitOptions fit;
  fit.threads = 1;
  fit.samples = 10'000;
  return fit_surface({grown.mesh, grown.binding, grown.openings}, line, oval, fit);
}

std::vector<SurfacePlace> places_of(const VesselSurface& surface) {
  std::vector<SurfacePlace> places;
  for (const CenterlineBinding& binding : surface.binding) places.push_back({binding.segment, binding.t});
  return places;
}

TEST(DeformedFit, KeepsItsProfileWhereTheCenterlineBends) {
  const Centerline line = bent_line();
  const FitResult fitted = fitted_to_oval(line);
  const std::vector<Vec3>& vertices = fitted.surface.mesh.vertices;
  const std::vector<SurfacePlace> places = places_of(fitted.surface);
  const RodTree rods = make_rod_tree(line);
  const SurfaceBinding binding(line, rods, vertices, std::vector<Vec3>(vertices.size(), Vec3::UnitX()), places);
  SimulationOptions options;
  options.gravity_mm_s2 = Vec3(0, -9810, 4000);
  CenterlineSimulation simulation = simulate(line, {.young_Pa = 2e5}, options);
  simulation.clamp(0);
  for (int i = 0; i < 20; ++i) simulation.step();
  const Pose& pose = simulation.pose();
  DeformedSurface surface = binding.make_surface();
  binding.apply(pose, surface);

  TriMesh moved = fitted.surface.mesh;
  double farthest = 0, flattest = 2, widest = 0;
  for (Index v = 0; v < vertices.size(); ++v) {
    moved.vertices[v] = surface.position(binding.lane_of_vertex()[v]);
    farthest = std::max(farthest, (moved.vertices[v] - vertices[v]).norm());
    const auto& [segment, t] = places[v];
    const Index slot = rods.slot_of_segment[segment], parent = rods.parent[slot];
    const double along = rods.node[slot] == line.segment(segment).b ? t : 1 - t;
    const Vec3 axis = (1 - along) * pose.position[parent] + along * pose.position[slot];
    const double rest = (vertices[v] - line.point_at(segment, t)).norm(), arm = (moved.vertices[v] - axis).norm();
    // The mean of two vectors of one length, turned against each other as the frames have turned.
    const Mat3 turn = (pose.frame[slot] * rods.frame[slot].transpose()).transpose() * pose.frame[parent] *
                      rods.frame[parent].transpose();
    const double half = Eigen::AngleAxisd(turn).angle() / 2;
    EXPECT_LE(arm, rest + 1e-4) << v;
    EXPECT_GE(arm, std::cos(half) * rest - 1e-4) << v;
    if (t > 0.2 && t < 0.8 && segment > 1 && segment < 11)
      flattest = std::min(flattest, arm), widest = std::max(widest, arm);
  }
  EXPECT_GT(farthest, 2) << "the pose is to be bent";
  EXPECT_LT(flattest, 1.35);  // of 1.2 and of 2, less what triangles cut off and more where these are balanced
  EXPECT_GT(widest, 1.85);
  EXPECT_TRUE(self_intersections(moved).empty());
}

/// Where the vertices go when the vessel bends under its weight, held at one end.
TriMesh bent(const Centerline& line, const VesselSurface& surface) {
  const RodTree rods = make_rod_tree(line);
  const std::vector<Vec3>& vertices = surface.mesh.vertices;
  const SurfaceBinding binding(line, rods, vertices, vertex_normals(surface.mesh), places_of(surface));
  SimulationOptions options;
  options.gravity_mm_s2 = Vec3(0, -9810, 4000);
  CenterlineSimulation simulation = simulate(line, {.young_Pa = 5e4}, options);
  simulation.clamp(0);
  for (int i = 0; i < 20; ++i) simulation.step();
  DeformedSurface moved = binding.make_surface();
  binding.apply(simulation.pose(), moved);
  TriMesh mesh = surface.mesh;
  for (Index v = 0; v < vertices.size(); ++v) mesh.vertices[v] = moved.position(binding.lane_of_vertex()[v]);
  return mesh;
}

VesselSurface grown_oval(const Centerline& line, int around) {
  GenerateOptions options;
  options.around = around;
  options.threads = 1;
  GenerateResult grown = generate_surface(line, options);
  for (Vec3& v : grown.mesh.vertices) v.z() *= 0.6;
  return {grown.mesh, grown.binding, grown.openings};
}

/// The largest distance of the reference from a fit of long triangles, and when both are bent, mm.
struct BentFit {
  double at_rest, when_bent;
};

BentFit long_triangles_bent(const Centerline& line, bool deformable) {
  const VesselSurface oval = grown_oval(line, 24);
  FitOptions fit;
  fit.threads = 1;
  fit.samples = 10'000;
  fit.elongation = 16;
  fit.deformable = deformable;
  fit.max_vertices = 300;  // fourteen to a node
  GenerateOptions growth;
  growth.threads = 1;
  const GenerateResult grown = generate_surface(line, growth);
  const FitResult fitted = fit_surface({grown.mesh, grown.binding, grown.openings}, line, oval.mesh, fit);
  const TriMesh bent_fit = bent(line, fitted.surface);
  EXPECT_TRUE(self_intersections(bent_fit).empty());
  const auto farthest = [](const TriMesh& reference, const TriMesh& mesh) {
    return sample_distance(reference, ClosestPointIndex(mesh), 20'000).distance.max;
  };
  return {farthest(oval.mesh, fitted.surface.mesh), farthest(bent(line, oval), bent_fit)};
}

TEST(DeformedFit, OfLongTrianglesBendsAtEveryNode) {
  const Centerline line = straight_rod(20, 50, 2);  // its tip sinks by 40 mm
  const BentFit deformable = long_triangles_bent(line, true), rigid = long_triangles_bent(line, false);
  EXPECT_LT(rigid.at_rest, deformable.at_rest);  // whose triangles are shorter
  EXPECT_LT(deformable.when_bent, 1.2 * deformable.at_rest);
  EXPECT_GT(rigid.when_bent, 2 * deformable.when_bent);
}

}  // namespace
}  // namespace vmesh::testing
