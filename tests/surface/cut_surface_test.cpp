#include "vmesh/surface/cut_surface.h"

#include <cstdio>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/soundness.h"
#include "vmesh/surface/surface_attributes.h"
#include "vmesh/synth/synthetic_tree.h"

#include "centerlines.h"
#include "draw.h"
#include "random_graphs.h"

namespace vmesh::testing {
namespace {

struct Bound {
  Centerline centerline;
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;
  std::vector<CenterlineCut> cuts = {};  // so far
};

Bound grown(const Centerline& centerline, const GenerateOptions& options = {}) {
  GenerateResult result = generate_surface(centerline, options);
  return {centerline, std::move(result.mesh), std::move(result.binding)};
}

Bound after(const Bound& before, const CenterlineCut& cut, const CutSurface& surface) {
  Bound result{cut.centerline, surface.mesh, surface.binding, before.cuts};
  result.cuts.push_back(cut);
  return result;
}

/// Whether two faces touch in a plane, one from behind, one from before.
bool touch_from_both_sides(const TriMesh& mesh, Index f, Index g, const CenterlineCut& cut) {
  const double tolerance = 1e-12 * (cut.radius + cut.position.norm());
  for (const auto& [behind, before] : {std::pair(f, g), std::pair(g, f)}) {
    double highest = -1e300, lowest = 1e300;
    for (const Index v : mesh.faces[behind])
      highest = std::max(highest, (mesh.vertices[v] - cut.position).dot(cut.direction));
    for (const Index v : mesh.faces[before])
      lowest = std::min(lowest, (mesh.vertices[v] - cut.position).dot(cut.direction));
    if (std::abs(highest) <= tolerance && std::abs(lowest) <= tolerance) return true;
  }
  return false;
}

/// No faces cross, but that the sides of cuts touch until they move apart.
bool only_sides_touch(const TriMesh& mesh, const std::vector<CenterlineCut>& cuts) {
  const auto pairs = self_intersections(mesh);
  return std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return std::any_of(cuts.begin(), cuts.end(), [&](const CenterlineCut& cut) {
      return touch_from_both_sides(mesh, pair.first, pair.second, cut);
    });
  });
}

/// Checks everything that a cut promises, in ways of its own.
void expect_good_cut(const Bound& before, const CenterlineCut& cut, const CutSurface& surface) {
  const TriMesh& mesh = surface.mesh;
  const Topology old = measure_topology(before.mesh), now = measure_topology(mesh);
  EXPECT_TRUE(now.closed && now.manifold && now.oriented && now.outward);
  const bool falls_apart = cut.centerline.component_count() > before.centerline.component_count();
  EXPECT_EQ(now.components, old.components + (falls_apart ? 1 : 0));
  EXPECT_EQ(now.genus, old.genus - (falls_apart ? 0 : 1));
  std::vector<CenterlineCut> cuts = before.cuts;
  cuts.push_back(cut);
  EXPECT_TRUE(only_sides_touch(mesh, cuts));
  EXPECT_TRUE(degenerate_faces(mesh).empty());
  EXPECT_LE(summarize_skewness(mesh).max, std::max(kWorstSkewness, summarize_skewness(before.mesh).max));
  const double volume = enclosed_volume(before.mesh);
  EXPECT_NEAR(enclosed_volume(mesh), volume, 1e-12 * std::abs(volume) + 1e-15);
  double area = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const CutSurface::Cap& cap = surface.cap[side];
    const Vec3 outward = side == 0 ? cut.direction : Vec3(-cut.direction);
    for (Index f = cap.first_face; f < cap.first_face + cap.face_count; ++f) {
      const Vec3 normal = area_normal(mesh, f);
      EXPECT_GT(normal.dot(outward), 0.999 * normal.norm());
      area += normal.norm() / 2;
      for (const Index v : mesh.faces[f]) {
        const auto& [segment, t] = surface.binding[v];
        EXPECT_EQ(segment, cut.end_segment[side]);
        EXPECT_EQ(t == 0 ? cut.centerline.segment(segment).a : cut.centerline.segment(segment).b, cut.end[side]);
        EXPECT_NEAR((mesh.vertices[v] - cut.position).dot(cut.direction), 0,
                    1e-12 * cut.radius + 1e-13 * mesh.vertices[v].norm());
      }
    }
  }
  EXPECT_NEAR(area, 2 * surface.cap_area_mm2, 1e-9 * area);
  std::size_t touched = 0;
  for (Index v = 0; v < before.mesh.vertices.size(); ++v) touched += mesh.vertices[v] != before.mesh.vertices[v];
  EXPECT_EQ(touched, [&] {
    std::size_t moved = 0;
    for (const Index v : surface.moved) moved += mesh.vertices[v] != before.mesh.vertices[v];
    return moved;
  }());
  for (const CenterlineBinding& b : surface.binding) {
    ASSERT_LT(b.segment, cut.centerline.segments().size() + before.centerline.component_count());
    EXPECT_TRUE(b.t >= 0 && b.t <= 1);
  }
}

TEST(CutSurface, OfATubeHasTheTubesCrossSection) {
  const Bound tube = grown(straight_tube());
  const CenterlineCut cut = cut_centerline(tube.centerline, {0, 0.7});
  const CutSurface surface = cut_surface(tube.mesh, tube.binding, tube.centerline, cut);
  expect_good_cut(tube, cut, surface);
  // Six vertices around, between the inscribed hexagon and the circle.
  const double r2 = cut.radius * cut.radius;
  EXPECT_GT(surface.cap_area_mm2, 2.4 * r2);
  EXPECT_LT(surface.cap_area_mm2, 1.05 * M_PI * r2);
}

TEST(CutSurface, AtANodeAndOnceMoreBesideIt) {
  Bound tube = grown(straight_tube());
  const CenterlineCut first = cut_at_node(tube.centerline, 1);
  const CutSurface surface = cut_surface(tube.mesh, tube.binding, tube.centerline, first);
  expect_good_cut(tube, first, surface);
  tube = after(tube, first, surface);
  const CenterlineCut second = cut_centerline(tube.centerline, {0, 0.6});
  expect_good_cut(tube, second, cut_surface(tube.mesh, tube.binding, tube.centerline, second));
  EXPECT_THROW(cut_at_node(tube.centerline, 1), InvalidInput);
}

TEST(CutSurface, OfALoopLeavesOneTree) {
  Bound loop = grown(ring(12));
  for (const SegmentPlace place : {SegmentPlace{3, 0.4}, SegmentPlace{9, 0.5}}) {
    const CenterlineCut cut = cut_centerline(loop.centerline, place);
    const CutSurface surface = cut_surface(loop.mesh, loop.binding, loop.centerline, cut);
    expect_good_cut(loop, cut, surface);
    loop = after(loop, cut, surface);
  }
  EXPECT_EQ(loop.centerline.component_count(), 2);
}

/// "cut it ... at segment S, parameter T": follows the advice of a refusal.
bool follow_advice(const Bound& bound, const std::string& message) {
  const std::size_t at = message.find(", at segment ");
  if (at == std::string::npos) return false;
  unsigned segment = 0;
  double t = 0;
  EXPECT_EQ(std::sscanf(message.c_str() + at, ", at segment %u, parameter %lf", &segment, &t), 2) << message;
  const CenterlineCut cut = cut_centerline(bound.centerline, {segment, t});
  expect_good_cut(bound, cut, cut_surface(bound.mesh, bound.binding, bound.centerline, cut));
  return true;
}

TEST(CutSurface, BesideABranchingIsRefusedWithAdvice) {
  const Bound tree = grown(fork());
  const CenterlineCut cut = cut_centerline(tree.centerline, {1, 0.05});
  try {
    cut_surface(tree.mesh, tree.binding, tree.centerline, cut);
    FAIL() << "was cut";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("meets another one, segment"), std::string::npos) << error.what();
    EXPECT_TRUE(follow_advice(tree, error.what())) << error.what();
  }
}

#ifndef VMESH_RANDOM_CUTS
#define VMESH_RANDOM_CUTS 60
#endif

Centerline random_vessels(Index seed) {
  if (seed % 4 == 0) {
    SyntheticTreeOptions options;
    options.vertices = 60;
    options.seed = seed;
    return synthetic_tree(options);
  }
  const GraphKind kinds[] = {GraphKind::loose_tree, GraphKind::ring_with_chords, GraphKind::random_loops};
  return RandomGraph(seed, kinds[seed % 4 - 1]).build();
}

TEST(CutSurface, RandomCutsAreSoundOrRefused) {
  int made = 0, refused = 0, advised = 0;
  double worst = 0, mean = 0;
  for (Index seed = 0; made < VMESH_RANDOM_CUTS; ++seed) {
    ASSERT_LT(seed, 20 * VMESH_RANDOM_CUTS);
    SCOPED_TRACE("seed " + std::to_string(seed));
    GenerateOptions options;
    options.threads = 1;
    Draw draw(seed + 1);
    if (draw.chance(0.3)) options.elongation = draw.uniform(1.5, 4);
    options.around = static_cast<int>(6 + draw.below(8));
    const Centerline centerline = random_vessels(seed);
    GenerateResult result;
    try {
      result = generate_surface(centerline, options);
    } catch (const InvalidInput&) {
      continue;
    }
    if (!result.is_sound() || result.growth.cycle_rank != centerline.cycle_rank()) continue;
    Bound vessels{centerline, result.mesh, result.binding};
    for (int i = 0; i < 4; ++i) {  // one after the other
      const Index segment = draw.below(static_cast<Index>(vessels.centerline.segments().size()));
      try {
        const CenterlineCut cut = cut_centerline(vessels.centerline, {segment, draw.uniform(0, 1)});
        try {
          const CutSurface surface = cut_surface(vessels.mesh, vessels.binding, vessels.centerline, cut);
          expect_good_cut(vessels, cut, surface);
          vessels = after(vessels, cut, surface);
          const double skewness = summarize_skewness(vessels.mesh).max;
          worst = std::max(worst, skewness);
          mean += skewness;
          ++made;
        } catch (const InvalidInput& error) {
          ++refused;
          if (follow_advice(vessels, error.what())) ++advised;
        }
      } catch (const InvalidInput& error) {
        // a node
      }
    }
  }
  std::printf("%d cuts, worst skewness %.3f, mean of the largest %.3f; %d refused, %d of them with another place\n",
              made, worst, mean / made, refused, advised);
  EXPECT_LT(refused, made / 2);
}

}  // namespace
}  // namespace vmesh::testing
