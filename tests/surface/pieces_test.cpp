// How a surface is divided into pieces, and that the result does not depend on it.
#include <numeric>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "centerlines.h"
#include "random_vessels.h"
#include "surface/pieces/gathering.h"

namespace vmesh {
namespace {

struct Divided {
  explicit Divided(Centerline c, const GenerateOptions& o = {})
      : options(o),
        centerline(std::move(c)),
        field(centerline, options.blend),
        tubes(field, RingOptions::of(options)),
        division(divide(tubes, options)),
        open(centerline.nodes().size(), 0) {}

  PieceSurface make(const PiecePlan& plan) const { return make_piece({tubes, open, options, progress}, plan); }

  GenerateOptions options;
  Centerline centerline;
  VesselField field;
  VesselRings tubes;
  Division division;
  std::vector<char> open;
  Progress progress;
};

// Forks one after the other, far enough apart for seams.
Centerline chain_of_forks(int count) {
  std::vector<CenterlineNode> nodes = {{{0, 0, 0}, 1}};
  std::vector<CenterlineSegment> segments;
  Index last = 0;
  for (int i = 0; i < count; ++i) {
    const double x = 14.0 * (i + 1);
    nodes.push_back({{x, 0, 0}, 1});
    const auto fork = static_cast<Index>(nodes.size() - 1);
    segments.push_back({last, fork});
    nodes.push_back({{x + 3, i % 2 == 0 ? 8.0 : -8.0, 0}, 0.7});
    segments.push_back({fork, fork + 1});
    last = fork;
  }
  nodes.push_back({{14.0 * (count + 1), 0, 0}, 1});
  segments.push_back({last, static_cast<Index>(nodes.size() - 1)});
  return {std::move(nodes), std::move(segments)};
}

TEST(Division, HasAPieceForEveryJunctionAndASeamBetweenTwo) {
  const Divided divided(chain_of_forks(5));
  EXPECT_EQ(divided.division.plans.size(), 5u);
  EXPECT_EQ(divided.division.seams.size(), 4u);
  std::map<RingPlace, int> sides;
  for (const PiecePlan& plan : divided.division.plans) {
    for (const RingPlace& seam : seams_of(RingCounts(divided.tubes), plan)) ++sides[seam];
  }
  for (const RingPlace& seam : divided.division.seams) EXPECT_EQ(sides[seam], 2);
}

TEST(Division, DividesALongTubeAndALongLoop) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < 60; ++i) {
    nodes.push_back({{10.0 * i, 0, 0}, 1});
    if (i > 0) segments.push_back({i - 1, i});
  }
  const Divided tube(Centerline(nodes, segments));
  EXPECT_GT(tube.division.plans.size(), 3u);
  EXPECT_EQ(tube.division.seams.size() + 1, tube.division.plans.size());

  nodes.clear();
  segments.clear();
  for (Index i = 0; i < 200; ++i) {
    const double angle = 2 * M_PI * i / 200;
    nodes.push_back({80 * Vec3(std::cos(angle), std::sin(angle), 0), 1});
    segments.push_back({i, (i + 1) % 200});
  }
  const Divided loop(Centerline(nodes, segments));
  EXPECT_GT(loop.division.plans.size(), 2u);
  EXPECT_EQ(loop.division.seams.size(), loop.division.plans.size());
  const GenerateResult result = generate_surface(loop.centerline);
  EXPECT_TRUE(result.is_sound());
  EXPECT_EQ(measure_topology(result.mesh).genus, 1);
}

TEST(Division, LeavesNoSeamWithOnePieceOnBothSides) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Divided divided(testing::plausible_tree(seed, 2));
    for (const PiecePlan& plan : divided.division.plans) {
      std::vector<RingPlace> seams = seams_of(RingCounts(divided.tubes), plan);
      std::sort(seams.begin(), seams.end());
      EXPECT_EQ(std::adjacent_find(seams.begin(), seams.end()), seams.end());
    }
  }
}

TEST(Division, IsCoarserWithoutSomeSeams) {
  const Divided divided(chain_of_forks(5));
  const Division fewer = regrouped(RingCounts(divided.tubes), divided.division, {divided.division.seams[1]}, {});
  EXPECT_EQ(fewer.plans.size(), 4u);
  EXPECT_EQ(fewer.seams.size(), 3u);
  const auto& plans = divided.division.plans;
  const Division joined =
      regrouped(RingCounts(divided.tubes), divided.division, {}, {{anchor_of(plans[0]), anchor_of(plans[4])}});
  EXPECT_EQ(joined.plans.size(), 4u);
  EXPECT_EQ(joined.seams, divided.division.seams);
}

TEST(Pieces, AreTheSameWhoeverMakesThemInWhateverOrder) {
  const Divided divided(testing::plausible_tree(3));
  std::vector<PieceSurface> forward, backward(divided.division.plans.size());
  for (const PiecePlan& plan : divided.division.plans) forward.push_back(divided.make(plan));
  for (std::size_t p = backward.size(); p-- > 0;) {
    const Divided apart(testing::plausible_tree(3));  // as on another machine
    backward[p] = apart.make(apart.division.plans[p]);
  }
  const GatheredSurface one = gather(divided.tubes, divided.division, forward);
  const GatheredSurface other = gather(divided.tubes, divided.division, backward);
  EXPECT_GT(forward.size(), 2u);
  EXPECT_EQ(one.mesh.vertices, other.mesh.vertices);
  EXPECT_EQ(one.mesh.faces, other.mesh.faces);
  EXPECT_TRUE(measure_topology(one.mesh).closed);
}

TEST(Pieces, KeepTheirSeamsAsTheyWereLaid) {
  const Divided divided(chain_of_forks(4));
  std::vector<PieceSurface> pieces;
  for (const PiecePlan& plan : divided.division.plans) pieces.push_back(divided.make(plan));
  const GatheredSurface surface = gather(divided.tubes, divided.division, pieces);
  std::size_t v = 0;
  for (const RingPlace& seam : divided.division.seams) {
    for (const RingPoint& p : divided.tubes.layer().lifted(seam.branch, divided.tubes.rings(seam.branch)[seam.ring]))
      EXPECT_EQ(surface.mesh.vertices[v++], p.position);
  }
  for (const PieceSurface& piece : pieces) EXPECT_TRUE(piece.faults.empty());
  EXPECT_EQ(surface.piece_of(0), 0u);
  EXPECT_EQ(surface.piece_of(static_cast<Index>(surface.mesh.faces.size() - 1)), pieces.size() - 1);
}

bool same(const GatheredSurface& one, const GatheredSurface& other) {
  const auto same_place = [](const CenterlineBinding& a, const CenterlineBinding& b) {
    return a.segment == b.segment && a.t == b.t;
  };
  return one.mesh.vertices == other.mesh.vertices && one.mesh.faces == other.mesh.faces && one.radius == other.radius &&
         one.first_vertex == other.first_vertex && one.first_face == other.first_face &&
         std::equal(one.binding.begin(), one.binding.end(), other.binding.begin(), other.binding.end(), same_place) &&
         std::equal(one.openings.begin(), one.openings.end(), other.openings.begin(), other.openings.end(),
                    [](const Opening& a, const Opening& b) { return a.node == b.node && a.ring == b.ring; });
}

TEST(Pieces, AreGatheredInWhateverOrderTheyAreFinishedAndFreed) {
  Divided divided(chain_of_forks(4));
  for (Index n = 0; n < divided.open.size(); ++n) divided.open[n] = divided.centerline.degree(n) == 1;
  std::vector<PieceSurface> pieces;
  for (const PiecePlan& plan : divided.division.plans) pieces.push_back(divided.make(plan));
  ASSERT_GT(pieces.size(), 3u);
  const GatheredSurface in_turn = gather(divided.tubes, divided.division, pieces);
  EXPECT_EQ(in_turn.openings.size(), 6u);
  Gatherer gatherer(divided.tubes, divided.division, pieces, 1);  // far too few vertices expected
  for (const Index p : {2u, 0u, 3u, 1u}) gatherer.add(p);
  EXPECT_TRUE(same(gatherer.finish(), in_turn));
  for (Index p = 0; p < pieces.size(); ++p) {
    const PieceSurface& piece = pieces[p];
    EXPECT_EQ(piece.work.vertices, in_turn.first_vertex[p + 1] - in_turn.first_vertex[p]) << "what it took is known";
    EXPECT_GT(piece.work.seconds, 0);
    EXPECT_EQ(piece.vertices.capacity() + piece.binding.capacity() + piece.radius.capacity() + piece.faces.capacity(),
              0u);
  }
}

TEST(Pieces, OfAnotherDivisionAreGatheredWithThoseThatStay) {
  Divided divided(chain_of_forks(5));
  for (Index n = 0; n < divided.open.size(); ++n) divided.open[n] = divided.centerline.degree(n) == 1;
  const Division before = divided.division;
  std::vector<PieceSurface> pieces;
  for (const PiecePlan& plan : before.plans) pieces.push_back(divided.make(plan));
  GatheredSurface surface = gather(divided.tubes, before, pieces);

  const Division next = regrouped(RingCounts(divided.tubes), before, {before.seams[1]}, {});
  ASSERT_EQ(next.plans.size() + 1, before.plans.size());
  std::vector<Index> known;
  std::vector<PieceSurface> made, all;
  for (const PiecePlan& plan : next.plans) {
    const auto it = std::find(before.plans.begin(), before.plans.end(), plan);
    known.push_back(it == before.plans.end() ? kNone : static_cast<Index>(it - before.plans.begin()));
    all.push_back(divided.make(plan));
    made.push_back(all.back());
    if (known.back() == kNone) continue;
    made.back().vertices.clear();  // they are in the surface
    made.back().faces.clear();
  }
  EXPECT_EQ(std::count(known.begin(), known.end(), kNone), 1);
  surface = gather_again(std::move(surface), before, next, known, made, divided.centerline);
  EXPECT_TRUE(same(surface, gather(divided.tubes, next, all)));
}

void collect_points(const VesselRings& tubes, Index branch, std::vector<Vec3>& points) {
  for (const Ring& ring : tubes.rings(branch)) {
    for (const RingPoint& p : ring.points) points.push_back(p.position);
  }
}

TEST(Rings, AreReleasedByBranch) {
  Divided divided(testing::plausible_tree(3));
  const auto branches = static_cast<Index>(divided.tubes.axes().size());
  ASSERT_GT(branches, 10u);
  std::vector<std::vector<Vec3>> before(branches);
  for (Index b = 0; b < branches; ++b) collect_points(divided.tubes, b, before[b]);
  for (Index b = 0; b < branches; b += 2) divided.tubes.release(b);
  for (Index b = 1; b < branches; b += 2) {
    std::vector<Vec3> after;
    collect_points(divided.tubes, b, after);
    EXPECT_EQ(before[b], after);
    EXPECT_TRUE(divided.tubes.rings(b - 1).empty());
  }
}

TEST(Rings, AreLaidAgainAsTheyWere) {
  Divided divided(testing::plausible_tree(3));
  std::vector<Vec3> before, after;
  const auto collect = [&](std::vector<Vec3>& points) {
    for (Index b = 0; b < divided.tubes.axes().size(); ++b) collect_points(divided.tubes, b, points);
  };
  collect(before);
  EXPECT_FALSE(before.empty());
  std::vector<Index> all(divided.tubes.axes().size());
  std::iota(all.begin(), all.end(), Index{0});
  for (const Index b : all) {
    const std::size_t count = divided.tubes.rings(b).size();
    divided.tubes.release(b);
    EXPECT_TRUE(divided.tubes.rings(b).empty());
    EXPECT_EQ(divided.tubes.ring_count(b), count);
  }
  divided.tubes.lay_again(all);
  collect(after);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace vmesh
