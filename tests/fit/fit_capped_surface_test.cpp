#include "vmesh/fit/fit_capped_surface.h"

#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/flat_ends.h"

namespace vmesh {
namespace {

/// A trunk that divides; ends at nodes 0, 2 and 3.
Centerline capped_fork() {
  return {{{{0, 0, 0}, 2.5}, {{0, 0, 15}, 2.5}, {{8, 0, 28}, 2}, {{-8, 0, 28}, 1.8}}, {{0, 1}, {1, 2}, {1, 3}}};
}

/// Grown with flat ends but at the nodes given, which are open, and its patches: 1 for the wall, `first_cap` and so on
/// for caps.
struct CappedSurface {
  VesselSurface surface;
  CappedPatches patches;
};

CappedSurface grown_capped(const Centerline& centerline, Index first_cap, double extension = 0,
                           std::vector<Index> left_open = {}) {
  GenerateOptions options;
  options.open_ends.all = true;
  GenerateResult result = generate_surface(centerline, options);
  FlatEndOptions ends;
  ends.extension = extension;
  ends.left_open = std::move(left_open);
  const FlatEnds flat = finish_ends(result, centerline, ends);
  EXPECT_TRUE(result.is_sound());
  CappedSurface capped{{result.mesh, result.binding, result.openings}, {}};
  std::set<Index> caps;
  for (const Index label : flat.cap_label) {
    capped.patches.patch.push_back(label == 0 ? 1 : first_cap + label - 1);
    if (label > 0) caps.insert(capped.patches.patch.back());
  }
  capped.patches.caps.assign(caps.begin(), caps.end());
  return capped;
}

/// Wider across, as from a scan.
TriMesh wider_scan() {
  TriMesh mesh = grown_capped(capped_fork(), 2).surface.mesh;
  for (Vec3& p : mesh.vertices) p = Vec3(p.x() * 1.02, 1.15 * p.y(), p.z());
  return mesh;
}

struct PatchFigures {
  std::size_t faces = 0;
  Vec3 area = Vec3::Zero();
  double sum_of_areas = 0;
  Vec3 middle = Vec3::Zero();
};

PatchFigures patch_of(const TriMesh& mesh, const std::vector<Index>& patch, Index wanted) {
  PatchFigures found;
  for (Index f = 0; f < patch.size(); ++f) {
    if (patch[f] != wanted) continue;
    ++found.faces;
    found.area += area_normal(mesh, f) / 2;
    found.sum_of_areas += area_normal(mesh, f).norm() / 2;
    found.middle += area_normal(mesh, f).norm() / 2 * mesh.vertices[mesh.faces[f][0]];
  }
  found.middle /= found.sum_of_areas;
  return found;
}

TEST(FitCappedSurface, CapsStayFlatAndKeepTheirNumbers) {
  const Centerline centerline = capped_fork();
  const CappedSurface capped = grown_capped(centerline, 5);
  const TriMesh reference = wider_scan();
  const CappedFit fitted = fit_capped_surface(capped.surface, capped.patches, centerline, reference);
  const TriMesh& mesh = fitted.fit.surface.mesh;
  ASSERT_EQ(fitted.patch.size(), mesh.faces.size());
  ASSERT_EQ(fitted.fit.surface.binding.size(), mesh.vertices.size());
  ASSERT_EQ(fitted.fit.radius.size(), mesh.vertices.size());
  const Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_TRUE(self_intersections(mesh).empty());
  EXPECT_LT(fitted.fit.report.after.p95(), 0.5 * fitted.fit.report.before.p95());
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(reference), 0.03 * enclosed_volume(reference));
  EXPECT_EQ(std::set<Index>(fitted.patch.begin(), fitted.patch.end()), (std::set<Index>{1, 5, 6, 7}));
  const std::vector<Index> nodes = {0, 2, 3};
  for (Index cap = 5; cap <= 7; ++cap) {
    const PatchFigures patch = patch_of(mesh, fitted.patch, cap);
    // Flat: the area of the sum is the sum of the areas. The caps of the reference are, which is 1.02 by 1.15 wider.
    EXPECT_NEAR(patch.area.norm(), patch.sum_of_areas, 1e-6 * patch.sum_of_areas) << cap;
    const Vec3& end = centerline.node(nodes[cap - 5]).position;
    EXPECT_LT((patch.middle - end).norm(), centerline.node(nodes[cap - 5]).radius) << cap;
    const double round = std::numbers::pi * std::pow(centerline.node(nodes[cap - 5]).radius, 2);
    EXPECT_GT(patch.sum_of_areas, 1.02 * round) << cap;
    EXPECT_LT(patch.sum_of_areas, 1.25 * round) << cap;
  }
}

TEST(FitCappedSurface, EndsThatWereOpenStayOpen) {
  const Centerline centerline = capped_fork();
  const CappedSurface capped = grown_capped(centerline, 2, 0, {2});
  const CappedFit fitted = fit_capped_surface(capped.surface, capped.patches, centerline, wider_scan());
  const Topology topology = measure_topology(fitted.fit.surface.mesh);
  EXPECT_EQ(topology.boundary_loops, 1u);
  ASSERT_EQ(fitted.fit.surface.openings.size(), 1u);
  EXPECT_EQ(fitted.fit.surface.openings[0].node, 2u);
  EXPECT_EQ(std::set<Index>(fitted.patch.begin(), fitted.patch.end()), (std::set<Index>{1, 2, 4}));
}

TEST(FitCappedSurface, ExtensionsStay) {
  const Centerline centerline = capped_fork();
  const CappedSurface capped = grown_capped(centerline, 2, 4);
  const CappedFit fitted = fit_capped_surface(capped.surface, capped.patches, centerline, wider_scan());
  EXPECT_EQ(std::set<Index>(fitted.patch.begin(), fitted.patch.end()), (std::set<Index>{1, 2, 3, 4}));
  const PatchFigures before = patch_of(capped.surface.mesh, capped.patches.patch, 2);
  const PatchFigures after = patch_of(fitted.fit.surface.mesh, fitted.patch, 2);
  ASSERT_LT(before.middle.z(), -9);  // four radii below node 0
  EXPECT_NEAR(after.middle.z(), before.middle.z(), 0.5);
}

TEST(FitCappedSurface, PatchesOfTheWallAreThoseOfTheirBranches) {
  const Centerline centerline = capped_fork();
  CappedSurface capped = grown_capped(centerline, 5);
  const std::vector<Index> wall_of_cap = {11, 12, 13};
  for (Index f = 0; f < capped.patches.patch.size(); ++f) {
    if (capped.patches.patch[f] != 1) continue;
    // By most corners, as the faces of branches are.
    std::vector<Index> segments;
    for (const Index v : capped.surface.mesh.faces[f]) segments.push_back(capped.surface.binding[v].segment);
    std::sort(segments.begin(), segments.end());
    const bool differ = segments[0] != segments[1] && segments[1] != segments[2];
    capped.patches.patch[f] = wall_of_cap[differ ? segments[0] : segments[1]];
  }
  const CappedFit fitted = fit_capped_surface(capped.surface, capped.patches, centerline, wider_scan());
  EXPECT_EQ(std::set<Index>(fitted.patch.begin(), fitted.patch.end()), (std::set<Index>{5, 6, 7, 11, 12, 13}));
  for (Index f = 0; f < fitted.patch.size(); ++f) {
    const Vec3& p = fitted.fit.surface.mesh.vertices[fitted.fit.surface.mesh.faces[f][0]];
    if (fitted.patch[f] == 11) {
      EXPECT_LT(p.z(), 20);
    }
    if (fitted.patch[f] == 12) {
      EXPECT_GT(p.x(), -3);
    }
    if (fitted.patch[f] == 13) {
      EXPECT_LT(p.x(), 3);
    }
  }
}

TEST(FitCappedSurface, RefusesWhatIsNoCap) {
  const Centerline centerline = capped_fork();
  const CappedSurface good = grown_capped(centerline, 2);
  const TriMesh reference = wider_scan();
  const auto message = [&](const CappedSurface& capped) -> std::string {
    try {
      fit_capped_surface(capped.surface, capped.patches, centerline, reference);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  CappedSurface two = good;  // two caps with one number
  for (Index& patch : two.patches.patch) patch = patch == 4 ? 3 : patch;
  two.patches.caps = {2, 3};
  EXPECT_NE(message(two).find("ModelFaceID 3 is not one disc"), std::string::npos) << message(two);
  CappedSurface all = good;
  all.patches.caps = {1, 2, 3, 4};
  EXPECT_NE(message(all).find("ModelFaceID 1 is not one disc"), std::string::npos) << message(all);
  CappedSurface halves = good;  // one cap in two parts
  bool first = true;
  for (Index& patch : halves.patches.patch) {
    if (patch != 2) continue;
    if (first) patch = 9;
    first = false;
  }
  halves.patches.caps = {2, 3, 4, 9};
  EXPECT_NE(message(halves), "");
  CappedSurface elsewhere = good;  // bound as if two ends were one
  for (CenterlineBinding& place : elsewhere.surface.binding)
    if (place.segment == 2) place.segment = 1;
  EXPECT_NE(message(elsewhere).find("both at the end of the centerline at node 2"), std::string::npos)
      << message(elsewhere);
}

}  // namespace
}  // namespace vmesh
