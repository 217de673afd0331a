// Surfaces in parts: the same, to the bit, as in one go.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/part.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

#include "centerlines.h"
#include "random_vessels.h"

namespace vmesh {
namespace {

// Vertices of the seams first, in the order of the seams, then those of the parts in theirs.
struct Joined {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;
  std::vector<double> radius;
  std::vector<Index> first_face = {0};  // of every piece, and the end
  std::size_t faults = 0;

  void set(std::size_t v, const PartSurface& part, std::size_t i) {
    mesh.vertices[v] = part.mesh.vertices[i];
    binding[v] = part.binding[i];
    radius[v] = part.radius[i];
  }
};

Joined join(const std::vector<PartSurface>& parts, std::size_t seams) {
  const std::size_t around = parts.front().around;
  std::size_t count = seams * around;
  for (const PartSurface& part : parts) count += part.mesh.vertices.size() - part.seam_vertex_count();
  Joined whole{TriMesh{std::vector<Vec3>(count), {}}, std::vector<CenterlineBinding>(count),
               std::vector<double>(count)};
  std::size_t begin = seams * around;
  for (const PartSurface& part : parts) {
    const std::size_t of_seams = part.seam_vertex_count();
    const auto number = [&](std::size_t i) {
      return i < of_seams ? part.seams[i / around] * around + i % around : begin + i - of_seams;
    };
    for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) whole.set(number(i), part, i);
    for (const auto& [a, b, c] : part.mesh.faces)
      whole.mesh.faces.push_back(
          {static_cast<Index>(number(a)), static_cast<Index>(number(b)), static_cast<Index>(number(c))});
    begin += part.mesh.vertices.size() - of_seams;
    for (const PartSurface::Piece& piece : part.pieces) {
      whole.first_face.push_back(whole.first_face.back() + piece.face_count);
      whole.faults += piece.faults.size();
    }
  }
  return whole;
}

GenerateOptions all_nodes(GenerateOptions options = {}) {
  options.simplification = 0;
  return options;
}

// Returns the number of parts.
std::size_t expect_same_in_parts(const Centerline& centerline, double vertices, const GenerateOptions& options) {
  const GenerateResult whole = generate_surface(centerline, options);
  std::vector<PartSurface> parts;
  const SplitSummary split = split_surface(centerline, options, vertices, [&](const SurfacePart& part) {
    EXPECT_EQ(part.first_piece, parts.empty() ? 0 : parts.back().first_piece + parts.back().pieces.size());
    parts.push_back(grow_part(part, 1));
  });
  EXPECT_EQ(split.parts, parts.size());
  EXPECT_EQ(split.pieces, whole.growth.pieces);
  EXPECT_EQ(split.components, whole.growth.components);
  const Joined joined = join(parts, split.seams);
  if (joined.faults > 0 || !whole.is_sound()) return 0;  // pieces are made again as one then
  // Walls of different pieces that cross are parted afterwards.
  if (joined.mesh.vertices != whole.mesh.vertices && !intersections_between(joined.mesh, joined.first_face).empty())
    return 0;
  EXPECT_TRUE(joined.mesh.vertices == whole.mesh.vertices);
  EXPECT_TRUE(joined.mesh.faces == whole.mesh.faces);
  EXPECT_TRUE(joined.radius == whole.radius);
  bool same_binding = joined.binding.size() == whole.binding.size();
  for (std::size_t v = 0; same_binding && v < whole.binding.size(); ++v)
    same_binding = joined.binding[v].segment == whole.binding[v].segment && joined.binding[v].t == whole.binding[v].t;
  EXPECT_TRUE(same_binding);
  return parts.size();
}

TEST(Parts, GrowTheSameSurface) {
  const Centerline tree = synthetic_tree({.vertices = 400, .seed = 3});
  EXPECT_GE(expect_same_in_parts(tree, 500, all_nodes()), 8u);
  EXPECT_GE(expect_same_in_parts(tree, 2000, all_nodes()), 3u);
  EXPECT_EQ(expect_same_in_parts(tree, 1e9, all_nodes()), 1u);
  EXPECT_GE(expect_same_in_parts(tree, 1, all_nodes()), 20u);
}

TEST(Parts, GrowTheSameSurfaceUnderOtherOptions) {
  const Centerline tree = synthetic_tree({.vertices = 150, .seed = 5});
  GenerateOptions options = all_nodes();
  options.around = 12;
  EXPECT_GE(expect_same_in_parts(tree, 2000, options), 3u);
  options = all_nodes();
  options.blend = 2;
  options.placement = Placement::inscribed;
  EXPECT_GE(expect_same_in_parts(tree, 250, options), 2u);
  options = all_nodes();
  options.elongation = 4;
  EXPECT_GE(expect_same_in_parts(tree, 250, options), 2u);
}

TEST(Parts, GrowTheSameSurfaceWithLoopsIsolatedNodesAndComponents) {
  const Centerline fork = testing::fork();
  std::vector<CenterlineNode> nodes = testing::ring(40).nodes();
  std::vector<CenterlineSegment> segments = testing::ring(40).segments();
  nodes.push_back({{100, 0, 0}, 2});
  const auto first = static_cast<Index>(nodes.size());
  for (const auto& node : fork.nodes()) nodes.push_back({node.position + Vec3(50, 50, 0), node.radius});
  for (const auto& s : fork.segments()) segments.push_back({s.a + first, s.b + first});
  nodes.push_back({{-100, 0, 0}, 0.5});
  EXPECT_GE(expect_same_in_parts({nodes, segments}, 1, all_nodes()), 3u);
}

// Vessels that come as near as separating allows.
TEST(Parts, GrowTheSameSurfaceOfCrowdedVessels) {
  int compared = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SeparatedCenterline noisy = separate_contacts(testing::noisy_tree(seed));
    compared += expect_same_in_parts(noisy.centerline, 1, all_nodes()) > 1;
    const SeparatedCenterline looped = separate_contacts(testing::plausible_tree(seed, 1));
    compared += expect_same_in_parts(looped.centerline, 1, all_nodes()) > 1;
  }
  EXPECT_GE(compared, 8);
}

TEST(Parts, AreRefusedForWhatIsKnownOfTheWholeOnly) {
  const auto take = [](const SurfacePart&) {};
  GenerateOptions options;
  options.growth = GrowthMethod::paper;
  EXPECT_THROW(split_surface(testing::fork(), options, 100, take), Unsupported);
  options = {};
  options.max_error.relative = 0.1;
  EXPECT_THROW(split_surface(testing::fork(), options, 100, take), Unsupported);
  options = {};
  options.open_ends.all = true;
  EXPECT_THROW(split_surface(testing::fork(), options, 100, take), Unsupported);
  EXPECT_THROW(split_surface(testing::fork(), {}, 0, take), InvalidInput);
}

TEST(Parts, ThatDoNotFitTogetherAreRefused) {
  std::vector<SurfacePart> parts;
  split_surface(synthetic_tree({.vertices = 100, .seed = 1}), all_nodes(), 500,
                [&](SurfacePart part) { parts.push_back(std::move(part)); });
  const auto refused = [&](auto&& damage) {
    SurfacePart part = parts.front();
    damage(part);
    EXPECT_THROW(grow_part(part, 1), InvalidInput);
  };
  refused([](SurfacePart& p) { p.pieces.clear(); });
  refused([](SurfacePart& p) { p.pieces.front().nodes.push_back(1'000'000); });
  refused([](SurfacePart& p) { p.pieces.front().stretches.front().branch = 1'000'000; });
  refused([](SurfacePart& p) { p.pieces.front().stretches.front().count = 1'000'000; });
  refused([](SurfacePart& p) { p.branches.front().segments.front() = 1'000'000; });
  refused([](SurfacePart& p) { p.field.local.front() = 1'000'000; });
  refused([](SurfacePart& p) { p.field.run.pop_back(); });
  refused([](SurfacePart& p) { p.seams.front().place.ring = 1'000'000; });
  refused([](SurfacePart& p) { p.field.nodes.front().radius = -1; });
}

// Queries of an excerpt, where it is complete, and the refusal of others.
TEST(Parts, ExcerptsAnswerAsTheWholeFieldDoes) {
  const Centerline tree = synthetic_tree({.vertices = 300, .seed = 9});
  const VesselField whole(tree, 0.5);
  const std::vector<Index> cones = {100, 101, 102, 103};
  const FieldExcerpt excerpt = FieldExcerpts(whole.relations()).take(cones, 3);
  const Centerline centerline = excerpt.centerline();
  const VesselField field(centerline, excerpt);
  ASSERT_LT(field.relations().cone_count(), whole.relations().cone_count() / 2);
  for (Index c = 0; c < field.relations().cone_count(); ++c) {
    const Index in_whole = excerpt.cone[c];
    if (std::find(cones.begin(), cones.end(), in_whole) == cones.end()) continue;
    for (int i = 0; i < 200; ++i) {
      const double t = i / 199.0, angle = 0.7 * i;
      const Vec3 axis = whole.relations().axis_point(in_whole, 1) - whole.relations().axis_point(in_whole, 0),
                 side = axis.unitOrthogonal();
      const Vec3 way = std::cos(angle) * side + std::sin(angle) * axis.normalized().cross(side);
      const double radius = whole.relations().radius_at(in_whole, t);
      const Vec3 p = whole.relations().axis_point(in_whole, t) + (0.8 + 0.002 * i) * radius * way;
      for (const bool fast : {false, true}) {
        const FieldSample a = fast ? whole.sample_fast(p, in_whole) : whole.sample(p, in_whole);
        const FieldSample b = fast ? field.sample_fast(p, c) : field.sample(p, c);
        EXPECT_EQ(a.distance, b.distance);
        EXPECT_EQ(a.gradient, b.gradient);
        EXPECT_EQ(a.cone, excerpt.cone[b.cone]);
        EXPECT_EQ(a.t, b.t);
      }
      EXPECT_EQ(whole.distance_to_others(p, in_whole, radius), field.distance_to_others(p, c, radius));
    }
  }
  const auto partial = std::find(excerpt.complete.begin(), excerpt.complete.end(), 0);
  ASSERT_NE(partial, excerpt.complete.end());
  const auto c = static_cast<Index>(partial - excerpt.complete.begin());
  EXPECT_THROW(field.sample(field.relations().axis_point(c, 0.5), c), std::logic_error);
}

}  // namespace
}  // namespace vmesh
