#include "vmesh/volume/crossing.h"

#include <cmath>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::Draw;
using Polyline = std::vector<Vec3>;

TriangleCorners face_of(const TriMesh& mesh, Index f) {
  const auto& [a, b, c] = mesh.faces[f];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

struct Count {
  int net = 0;    // sum of the directions
  int total = 0;  // crossings
};

// All crossings of a polyline with a mesh. Checks on the way that each crossing point lies where it is said to.
Count count_crossings(const TriMesh& mesh, const Polyline& line) {
  Count count;
  for (std::size_t s = 0; s + 1 < line.size(); ++s) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const TriangleCorners triangle = face_of(mesh, f);
      const auto crossing = find_crossing(line[s], line[s + 1], triangle);
      if (!crossing) continue;
      ++count.total;
      count.net += crossing->direction;
      EXPECT_GE(crossing->t, 0);
      EXPECT_LE(crossing->t, 1);
      EXPECT_EQ(std::abs(crossing->direction), 1);
      // t is a quotient of two heights above the plane, each a dot product with coordinates up to `size`: a dozen
      // rounding errors of that size. The point's height inherits them, however flat the crossing.
      const Vec3 point = line[s] + crossing->t * (line[s + 1] - line[s]);
      const Vec3 normal = area_normal(mesh, f).normalized();
      const double size = line[s].norm() + line[s + 1].norm() + triangle[0].norm() + 1;
      EXPECT_LE(std::abs(normal.dot(point - triangle[0])), 64 * std::numeric_limits<double>::epsilon() * size);
    }
  }
  return count;
}

// The same mesh with its vertices in another order: ties are broken by index, and every order must work.
TriMesh renumbered(const TriMesh& mesh, Draw& draw) {
  std::vector<Index> number(mesh.vertices.size());
  std::iota(number.begin(), number.end(), Index{0});
  draw.shuffle(number);
  TriMesh other = mesh;
  for (Index v = 0; v < number.size(); ++v) other.vertices[number[v]] = mesh.vertices[v];
  for (Triangle& f : other.faces) {
    const auto first = draw.below(3);
    f = {number[f[first]], number[f[(first + 1) % 3]], number[f[(first + 2) % 3]]};
  }
  return other;
}

// The boundary of a set of unit cubes of a 3^3 grid, as a closed mesh with corners at whole numbers: reflex edges,
// saddle corners, edges with four faces.
class Polycube {
 public:
  explicit Polycube(Draw& draw) {
    for (int cell = 0; cell < 27; ++cell) {
      if (draw.chance(0.5)) cells_.insert(cell);
    }
    cells_.insert(13);
    const TriMesh cube = testing::cube();
    for (const int cell : cells_) {
      const Vec3 corner(cell % 3, cell / 3 % 3, cell / 9);
      for (std::size_t side = 0; side < 6; ++side) {
        const Vec3 normal = area_normal(cube, static_cast<Index>(2 * side));
        if (contains(corner + Vec3::Constant(0.5) + normal)) continue;
        const auto& t = cube.faces[2 * side];
        Index quad[4] = {t[0], t[1], t[2], cube.faces[2 * side + 1][2]};
        for (Index& v : quad) v = number_of(corner + cube.vertices[v]);
        const bool turned = draw.chance(0.5);
        const Index i = turned ? 1 : 0;
        mesh_.faces.push_back({quad[i], quad[i + 1], quad[i + 2]});
        mesh_.faces.push_back({quad[i], quad[i + 2], quad[(i + 3) % 4]});
      }
    }
    mesh_ = renumbered(mesh_, draw);
  }

  const TriMesh& mesh() const { return mesh_; }
  /// `p` inside a cell, not on its boundary.
  bool contains(const Vec3& p) const {
    if ((p.array() < 0).any() || (p.array() > 3).any()) return false;
    return cells_.contains(static_cast<int>(p.x()) + 3 * static_cast<int>(p.y()) + 9 * static_cast<int>(p.z()));
  }

 private:
  Index number_of(const Vec3& p) {
    for (Index v = 0; v < mesh_.vertices.size(); ++v) {
      if (mesh_.vertices[v] == p) return v;
    }
    mesh_.vertices.push_back(p);
    return static_cast<Index>(mesh_.vertices.size() - 1);
  }

  std::set<int> cells_;
  TriMesh mesh_;
};

// The convex hull of random points, by definition: faces with all other points behind them.
TriMesh random_hull(Draw& draw, Index count) {
  TriMesh mesh;
  for (Index i = 0; i < count; ++i) mesh.vertices.push_back(draw.direction());
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < count; ++b) {
      for (Index c = 0; c < count; ++c) {
        if (a >= b || a >= c || b == c) continue;
        const Vec3 normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
        bool all_behind = true;
        for (Index d = 0; d < count; ++d) {
          if (d != a && d != b && d != c && normal.dot(mesh.vertices[d] - mesh.vertices[a]) > 0) all_behind = false;
        }
        if (all_behind) mesh.faces.push_back({a, b, c});
      }
    }
  }
  return mesh;
}

bool inside_hull(const TriMesh& mesh, const Vec3& p) {
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (area_normal(mesh, f).dot(p - mesh.vertices[mesh.faces[f][0]]) > 0) return false;
  }
  return true;
}

TEST(Crossing, OfASegmentThroughAFaceHasItsPlaceAndDirection) {
  const TriangleCorners triangle = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto out = find_crossing({1, 1, -1}, {1, 1, 3}, triangle);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->t, 0.25);
  EXPECT_EQ(out->direction, 1);
  const auto in = find_crossing({1, 1, 3}, {1, 1, -1}, triangle);
  ASSERT_TRUE(in);
  EXPECT_EQ(in->t, 0.75);
  EXPECT_EQ(in->direction, -1);
  EXPECT_FALSE(find_crossing({1, 1, 1}, {1, 1, 3}, triangle));
  EXPECT_FALSE(find_crossing({3, 3, -1}, {3, 3, 1}, triangle));
  EXPECT_FALSE(find_crossing({-1, 1, -1}, {-1, 1, 1}, triangle));
  EXPECT_FALSE(find_crossing({1, -1, -1}, {1, -1, 1}, triangle));
  EXPECT_FALSE(find_crossing({1, 1, 0}, {2, 1, 0}, triangle));  // within the face
}

TEST(Crossing, OfOneSegmentLeavingAConvexBodyIsOneFaceHoweverItLeaves) {
  // From the centre of the cube of side 4 to all points of a grid on a larger cube: through corners, along diagonals,
  // through edges and the diagonals of the faces.
  Draw draw(11);
  for (int trial = 0; trial < 8; ++trial) {
    TriMesh mesh = testing::cube();
    for (Vec3& v : mesh.vertices) v = 4 * v - Vec3::Constant(2);
    mesh = renumbered(mesh, draw);
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        for (int k = -4; k <= 4; ++k) {
          if (std::max({std::abs(i), std::abs(j), std::abs(k)}) < 4) continue;
          const Vec3 end(i, j, k);
          const auto out = count_crossings(mesh, {{0, 0, 0}, end});
          EXPECT_EQ(out.net, 1) << end.transpose();
          EXPECT_EQ(out.total, 1) << end.transpose();
          const auto through = count_crossings(mesh, {-end, end});
          EXPECT_EQ(through.net, 0) << end.transpose();
          EXPECT_EQ(through.total, 2) << end.transpose();
        }
      }
    }
  }
}

TEST(Crossing, OfALineThroughAVertexIsOneFaceWhateverTheVertexIsNumbered) {
  Draw draw(12);
  for (int trial = 0; trial < 20; ++trial) {
    const TriMesh mesh = renumbered(testing::icosphere(trial % 2), draw);
    for (const Vec3& v : mesh.vertices) {
      const auto out = count_crossings(mesh, {{0, 0, 0}, 2 * v});
      EXPECT_EQ(out.net, 1);
      EXPECT_EQ(out.total, 1);
    }
  }
}

TEST(Crossing, OfALineThroughAnEdgeIsOneFace) {
  Draw draw(13);
  const TriMesh mesh = renumbered(testing::icosahedron(), draw);
  for (const auto& [a, b, c] : mesh.faces) {
    const auto out = count_crossings(mesh, {{0, 0, 0}, mesh.vertices[a] + mesh.vertices[b]});
    EXPECT_EQ(out.net, 1);
    EXPECT_EQ(out.total, 1);
  }
}

TEST(Crossing, OfAPolylineWithANodeOnTheSurfaceIsOne) {
  Draw draw(14);
  for (int trial = 0; trial < 20; ++trial) {
    TriMesh mesh = testing::cube();
    for (Vec3& v : mesh.vertices) v = 2 * v - Vec3::Constant(1);
    mesh = renumbered(mesh, draw);
    for (const Vec3& on : {Vec3(1, 0, 0), Vec3(1, 0.5, 0.25), Vec3(1, 1, 0.5), Vec3(1, 1, 1), Vec3(0, -1, 0),
                           Vec3(0, 0, -1), Vec3(-1, -1, 0), Vec3(-1, 1, -1), Vec3(-0.25, 1, 0.75)}) {
      EXPECT_EQ(count_crossings(mesh, {{0, 0, 0}, on, 2 * on}).net, 1) << on.transpose();
      EXPECT_EQ(count_crossings(mesh, {{0, 0, 0}, on, {0.125, 0.25, 0.5}}).net, 0) << on.transpose();
      EXPECT_EQ(count_crossings(mesh, {2 * on, on, 3 * on}).net, 0) << on.transpose();
    }
  }
}

TEST(Crossing, OfAPolylineThatRunsAlongTheSurfaceAddsUp) {
  const TriMesh mesh = testing::cube();
  // In the face, along an edge, along a face's diagonal, then away.
  const Polyline line = {{0.5, 0.5, 0.5}, {0.5, 0.5, 1}, {0.5, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 1}};
  for (const Vec3& end : {Vec3(0.5, 0.25, 0.5), Vec3(2, 3, 4), Vec3(-1, 0, 1), Vec3(0, 0, 2)}) {
    Polyline whole = line;
    whole.push_back(end);
    EXPECT_EQ(count_crossings(mesh, whole).net, (end.array() > 0).all() && (end.array() < 1).all() ? 0 : 1)
        << end.transpose();
  }
}

TEST(Crossing, OfRandomPolylinesWithHullsSayInsideOrOutside) {
  Draw draw(15);
  for (int trial = 0; trial < 40; ++trial) {
    const TriMesh mesh = random_hull(draw, 6 + draw.below(8));
    for (int i = 0; i < 20; ++i) {
      Polyline line;
      for (Index n = 0; n < 2 + draw.below(4); ++n) line.push_back(draw.in_cube(1.2));
      const auto count = count_crossings(mesh, line);
      EXPECT_EQ(count.net, int{inside_hull(mesh, line.front())} - int{inside_hull(mesh, line.back())});
      EXPECT_EQ(count.total % 2, std::abs(count.net) % 2);
    }
  }
}

TEST(Crossing, OfGridPolylinesWithPolycubesSayInsideOrOutside) {
  // The ends are centres of cells, strictly inside or outside. All other nodes lie on the half-integer grid: on
  // corners, edges, diagonals and faces, convex and reflex, and the segments run along them.
  Draw draw(16);
  for (int trial = 0; trial < 60; ++trial) {
    const Polycube body(draw);
    for (int i = 0; i < 20; ++i) {
      const auto center = [&] { return Vec3(draw.below(5) - 0.5, draw.below(5) - 0.5, draw.below(5) - 0.5); };
      Polyline line = {center()};
      for (Index n = 0; n < draw.below(4); ++n) {
        line.emplace_back(draw.below(9) / 2.0 - 0.5, draw.below(9) / 2.0 - 0.5, draw.below(9) / 2.0 - 0.5);
      }
      line.push_back(center());
      EXPECT_EQ(count_crossings(body.mesh(), line).net,
                int{body.contains(line.front())} - int{body.contains(line.back())})
          << "trial " << trial << ", polyline " << i;
    }
  }
}

}  // namespace
}  // namespace vmesh
