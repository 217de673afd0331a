#include <algorithm>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::operator+;
using testing::moved, testing::tetrahedron, testing::cube, testing::icosphere, testing::torus;
using Pairs = std::vector<std::pair<Index, Index>>;

TEST(SelfIntersections, AreNoneOnAClosedSurface) {
  EXPECT_TRUE(self_intersections(icosphere(2)).empty());
  EXPECT_TRUE(self_intersections(torus(3, 1, 12, 8)).empty());
  EXPECT_TRUE(self_intersections(cube()).empty());  // coplanar neighbours on either side of their edge
  EXPECT_TRUE(self_intersections({}).empty());
}

TEST(SelfIntersections, FindAVertexPushedThroughTheOtherSide) {
  TriMesh mesh = icosphere(2);
  mesh.vertices[0] *= -1.5;
  const Pairs pairs = self_intersections(mesh);
  ASSERT_FALSE(pairs.empty());
  for (const auto& [f, g] : pairs) {
    const auto moved_face = [&](Index face) {
      return std::count(mesh.faces[face].begin(), mesh.faces[face].end(), 0u) > 0;
    };
    EXPECT_NE(moved_face(f), moved_face(g)) << f << " " << g;  // each pair is of the spike and what it pierces
  }
}

TEST(SelfIntersections, FindTwoTetrahedraThatPierceEachOther) {
  const TriMesh apart = tetrahedron() + moved(tetrahedron(), {2, 0, 0});
  EXPECT_TRUE(self_intersections(apart).empty());
  // Shifted by (1, 1, 1) / 5: faces 4 to 6 of the second cut face 3 of the first, {x + y + z = 1}; nothing else meets.
  const TriMesh mesh = tetrahedron() + moved(tetrahedron(), {0.2, 0.2, 0.2});
  EXPECT_EQ(self_intersections(mesh), (Pairs{{3, 4}, {3, 5}, {3, 6}}));
}

TEST(SelfIntersections, FindAFoldAtAnEdge) {
  const auto wings = [](const Vec3& tip) {
    return TriMesh{{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, tip}, {{0, 1, 2}, {1, 0, 3}}};
  };
  EXPECT_TRUE(self_intersections(wings({1, -1, 0})).empty());       // flat
  EXPECT_TRUE(self_intersections(wings({1, 2, 0x1p-40})).empty());  // folded, but not all the way
  EXPECT_EQ(self_intersections(wings({1, 2, 0})), (Pairs{{0, 1}}));
  EXPECT_EQ(self_intersections(wings({5, 1, 0})), (Pairs{{0, 1}}));
  EXPECT_EQ(self_intersections(wings({1, 1, 0})), (Pairs{{0, 1}}));
}

TEST(SelfIntersections, FindFacesThatShareAVertexAndPierce) {
  const auto pair = [](const Vec3& p, const Vec3& q) {
    return TriMesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, p, q}, {{0, 1, 2}, {0, 3, 4}}};
  };
  EXPECT_EQ(self_intersections(pair({0.5, 0.5, 1}, {0.5, 0.5, -1})), (Pairs{{0, 1}}));  // its far edge pierces
  EXPECT_EQ(self_intersections(pair({3, 3, 1}, {3, 3, -1})), (Pairs{{0, 1}}));          // is pierced by the far edge
  EXPECT_EQ(self_intersections(pair({0.5, 0.5, 0}, {0.5, 0.5, 1})), (Pairs{{0, 1}}));   // a tip in the plane
  EXPECT_EQ(self_intersections(pair({3, 1, 0}, {3, 2, 0})), (Pairs{{0, 1}}));           // overlap in one plane
  EXPECT_EQ(self_intersections(pair({1, 0, 0}, {1, 0, 1})), (Pairs{{0, 1}}));           // along the shared ray
  EXPECT_TRUE(self_intersections(pair({0.5, 0.5, 1}, {0.5, 0.5, 0x1p-40})).empty());    // just above
  EXPECT_TRUE(self_intersections(pair({-1, 0, 0}, {0, -1, 0})).empty());                // opposite sectors of a plane
  EXPECT_TRUE(self_intersections(pair({-0.5, -0.5, 1}, {-0.5, -0.5, -1})).empty());     // behind the vertex
}

TEST(SelfIntersections, FindFacesThatTouchWithoutSharing) {
  const auto pair = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return TriMesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, p, q, r}, {{0, 1, 2}, {3, 4, 5}}};
  };
  EXPECT_EQ(self_intersections(pair({0.5, 0.5, 0}, {0, 0, 1}, {1, 1, 1})), (Pairs{{0, 1}}));  // a corner on the face
  EXPECT_EQ(self_intersections(pair({2, 0, 0}, {3, 0, 1}, {3, 1, 1})), (Pairs{{0, 1}}));  // a vertex twice in the list
  EXPECT_TRUE(self_intersections(pair({0.5, 0.5, 0x1p-40}, {0, 0, 1}, {1, 1, 1})).empty());
}

TEST(SelfIntersections, FindDuplicates) {
  TriMesh mesh = tetrahedron();
  mesh.faces.push_back({2, 3, 1});
  // The copy meets the original; with the other three it shares an edge, like the original.
  EXPECT_EQ(self_intersections(mesh), (Pairs{{3, 4}}));
  mesh.faces.push_back({3, 2, 1});  // the other way around
  EXPECT_EQ(self_intersections(mesh), (Pairs{{3, 4}, {3, 5}, {4, 5}}));
}

TEST(SelfIntersections, BetweenPartsAreThoseOfTheirFaces) {
  // Three spheres in a row, each reaching into the next, and the last folded into itself.
  TriMesh last = moved(icosphere(2), {3, 0.1, 0});
  last.vertices[0] = 2 * Vec3(3, 0.1, 0) - last.vertices[0];
  const TriMesh sphere = icosphere(2), mesh = sphere + moved(sphere, {1.5, 0, 0.1}) + last;
  const auto size = static_cast<Index>(sphere.faces.size());
  for (const std::vector<Index>& first : {std::vector<Index>{0}, {0, size}, {0, size, 2 * size}, {0, 7, size, size}}) {
    const auto part = [&](Index f) { return std::upper_bound(first.begin(), first.end(), f); };
    Pairs expected = self_intersections(mesh);
    EXPECT_GT(expected.size(), 100u);
    std::erase_if(expected, [&](const auto& pair) { return part(pair.first) == part(pair.second); });
    EXPECT_EQ(intersections_between(mesh, first), expected);
  }
}

TEST(SelfIntersections, LeaveDegenerateFacesOut) {
  TriMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.end(), {{-1, 0.25, 0.25}, {0.5, 0.25, 0.25}, {2, 0.25, 0.25}});
  mesh.faces.push_back({4, 5, 6});  // a needle right through
  mesh.faces.push_back({4, 6, 6});
  EXPECT_TRUE(self_intersections(mesh).empty());
}

// The intersection of two faces, constructed exactly: must be no more than their common vertices and edge.
class Oracle {
 public:
  explicit Oracle(const TriMesh& mesh) : mesh_(mesh) {}

  bool degenerate(Index f) const { return triangle(f).is_degenerate(); }

  bool intersect(Index f, Index g) const {
    const auto meet = CGAL::intersection(triangle(f), triangle(g));
    if (!meet) return false;
    std::vector<Point> common;
    for (const Index v : mesh_.faces[f]) {
      if (std::count(mesh_.faces[g].begin(), mesh_.faces[g].end(), v) > 0) common.push_back(point(v));
    }
    if (const auto* p = boost::get<Point>(&*meet)) return common.size() != 1 || *p != common[0];
    if (const auto* s = boost::get<Kernel::Segment_3>(&*meet)) {
      if (common.size() != 2) return true;
      const Kernel::Segment_3 edge(common[0], common[1]);
      return *s != edge && s->opposite() != edge;
    }
    return true;
  }

 private:
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  using Point = Kernel::Point_3;

  Point point(Index v) const { return {mesh_.vertices[v].x(), mesh_.vertices[v].y(), mesh_.vertices[v].z()}; }
  Kernel::Triangle_3 triangle(Index f) const {
    const auto& [a, b, c] = mesh_.faces[f];
    return {point(a), point(b), point(c)};
  }

  const TriMesh& mesh_;
};

void expect_same_as_oracle(const TriMesh& mesh) {
  const Oracle oracle(mesh);
  Pairs expected;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index g = f + 1; g < mesh.faces.size(); ++g) {
      if (!oracle.degenerate(f) && !oracle.degenerate(g) && oracle.intersect(f, g)) expected.emplace_back(f, g);
    }
  }
  EXPECT_EQ(self_intersections(mesh), expected);
}

TriMesh random_soup(testing::Draw& draw, Index vertices, int faces) {
  TriMesh mesh;
  mesh.vertices.resize(vertices, Vec3::Zero());
  for (int f = 0; f < faces; ++f) {
    Triangle t;
    do {
      for (Index& v : t) v = draw.below(vertices);
    } while (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
    mesh.faces.push_back(t);
  }
  return mesh;
}

TEST(SelfIntersections, AgreeWithExactConstructionsOnRandomSoups) {
  testing::Draw draw(3);
  for (int trial = 0; trial < 60; ++trial) {
    // Few vertices: most pairs share some; many: most share none.
    TriMesh mesh = random_soup(draw, trial % 2 == 0 ? 8 : 60, 24);
    for (Vec3& v : mesh.vertices) v = draw.in_cube(1);
    SCOPED_TRACE(trial);
    expect_same_as_oracle(mesh);
  }
}

TEST(SelfIntersections, AgreeWithExactConstructionsWhereEverythingTouches) {
  testing::Draw draw(4);
  for (int trial = 0; trial < 120; ++trial) {
    // On a grid of 3^3 points most faces are coplanar, touch, overlap or are degenerate; vertices coincide too.
    TriMesh mesh = random_soup(draw, trial % 2 == 0 ? 8 : 30, 16);
    for (Vec3& v : mesh.vertices) v = Vec3(draw.below(3), draw.below(3), trial % 3 == 0 ? 0 : draw.below(3));
    SCOPED_TRACE(trial);
    expect_same_as_oracle(mesh);
  }
}

}  // namespace
}  // namespace vmesh
