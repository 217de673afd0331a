#include "vmesh/mesh/topology.h"

#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::operator+;
using testing::moved, testing::inverted, testing::tetrahedron, testing::cube, testing::icosphere, testing::torus;

TEST(Topology, OfASphere) {
  const auto t = measure_topology(icosphere(2));
  EXPECT_TRUE(t.closed);
  EXPECT_TRUE(t.manifold);
  EXPECT_TRUE(t.oriented);
  EXPECT_TRUE(t.outward);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.boundary_edges, 0u);
  EXPECT_EQ(t.euler_characteristic, 2);
  EXPECT_EQ(t.genus, 0);
}

TEST(Topology, OfATorus) {
  const auto t = measure_topology(torus(3, 1, 12, 8));
  EXPECT_TRUE(t.closed && t.manifold && t.oriented && t.outward);
  EXPECT_EQ(t.euler_characteristic, 0);
  EXPECT_EQ(t.genus, 1);
}

TEST(Topology, SumsTheGenusOverComponents) {
  const auto t = measure_topology(torus(3, 1, 12, 8) + moved(cube(), {9, 0, 0}) + moved(torus(3, 1, 5, 4), {0, 0, 9}));
  EXPECT_EQ(t.components, 3u);
  EXPECT_EQ(t.euler_characteristic, 2);
  EXPECT_EQ(t.genus, 2);
}

TEST(Topology, DoesNotCountVerticesWithoutAFace) {
  TriMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.begin(), {7, 7, 7});
  for (Triangle& f : mesh.faces) f = {f[0] + 1, f[1] + 1, f[2] + 1};
  mesh.vertices.emplace_back(8, 8, 8);
  const auto t = measure_topology(mesh);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.euler_characteristic, 2);
  EXPECT_TRUE(t.outward);
}

TEST(Topology, CountsTheEdgesOfAHole) {
  TriMesh mesh = cube();
  mesh.faces.pop_back();
  const auto t = measure_topology(mesh);
  EXPECT_FALSE(t.closed);
  EXPECT_TRUE(t.manifold);
  EXPECT_TRUE(t.oriented);
  EXPECT_FALSE(t.outward);
  EXPECT_EQ(t.boundary_edges, 3u);
  EXPECT_EQ(t.euler_characteristic, 1);
  EXPECT_EQ(t.genus, 0);
}

TEST(Topology, SeesAnEdgeWithThreeFaces) {
  TriMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(1, 1, 0);
  mesh.faces.push_back({1, 2, 4});
  const auto t = measure_topology(mesh);
  EXPECT_FALSE(t.manifold);
  EXPECT_FALSE(t.oriented);
  EXPECT_FALSE(t.closed);
  EXPECT_EQ(t.boundary_edges, 2u);
}

TEST(Topology, SeesTwoBodiesThatShareAnEdge) {
  TriMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(-1, 0, 0);
  mesh.vertices.emplace_back(0, -1, 0);
  mesh.faces.insert(mesh.faces.end(), {{0, 5, 4}, {0, 4, 3}, {0, 3, 5}, {4, 5, 3}});  // shares the edge 0-3
  const auto t = measure_topology(mesh);
  EXPECT_TRUE(t.closed);
  EXPECT_FALSE(t.manifold);
  EXPECT_FALSE(t.oriented);
  EXPECT_FALSE(t.outward);
  EXPECT_EQ(t.components, 1u);
}

TEST(Topology, SeesTwoBodiesThatShareAVertex) {
  TriMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  mesh.faces.insert(mesh.faces.end(), {{0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}});
  const auto t = measure_topology(mesh);
  EXPECT_FALSE(t.manifold);
  EXPECT_TRUE(t.closed);
  EXPECT_TRUE(t.oriented);
  EXPECT_TRUE(t.outward);
  EXPECT_EQ(t.components, 1u);
  EXPECT_EQ(t.euler_characteristic, 3);
  EXPECT_EQ(t.genus, 0);  // not defined
}

TEST(Topology, SeesAFanThatTouchesAnotherAtAVertexOfAnOpenMesh) {
  const TriMesh mesh = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  const auto t = measure_topology(mesh);
  EXPECT_FALSE(t.manifold);
  EXPECT_TRUE(t.oriented);
  EXPECT_EQ(t.boundary_edges, 6u);
}

TEST(Topology, TellsInwardFromInconsistent) {
  auto t = measure_topology(inverted(cube()));
  EXPECT_TRUE(t.closed && t.manifold && t.oriented);
  EXPECT_FALSE(t.outward);
  TriMesh one_flipped = cube();
  std::swap(one_flipped.faces[5][0], one_flipped.faces[5][1]);
  t = measure_topology(one_flipped);
  EXPECT_TRUE(t.closed && t.manifold);
  EXPECT_FALSE(t.oriented);
  EXPECT_FALSE(t.outward);
}

TEST(Topology, WantsEveryComponentOutward) {
  const auto t = measure_topology(icosphere(1) + moved(inverted(tetrahedron()), {5, 0, 0}));
  EXPECT_TRUE(t.oriented);
  EXPECT_FALSE(t.outward);
}

TEST(Topology, OrientsFarFromTheOrigin) {
  // 2^40 leaves 12 bits behind the point: the cube's corners are still exact, a product with the position is not.
  const Vec3 far(0x1p40, -0x1p40, 0x1p40);
  EXPECT_TRUE(measure_topology(moved(cube(), far)).outward);
  EXPECT_FALSE(measure_topology(moved(inverted(cube()), far)).outward);
}

TEST(Topology, OfAnEmptyMeshIsNothing) {
  const auto t = measure_topology({});
  EXPECT_FALSE(t.closed);
  EXPECT_FALSE(t.outward);
  EXPECT_EQ(t.components, 0u);
  EXPECT_EQ(t.euler_characteristic, 0);
}

TEST(Topology, CallsAFaceThatRepeatsAVertexNotManifold) {
  EXPECT_FALSE(measure_topology({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}}).manifold);
}

TEST(Topology, RefusesAFaceWithAnUnknownVertex) {
  try {
    measure_topology({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}});
    FAIL() << "no exception";
  } catch (const InvalidInput& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("face 1"), std::string::npos) << text;
    EXPECT_NE(text.find("vertex 3"), std::string::npos) << text;
  }
}

TEST(Topology, DoesNotDependOnTheOrderOfFacesAndVertices) {
  testing::Draw draw(2);
  for (int trial = 0; trial < 50; ++trial) {
    // Random faces on few vertices: every defect appears, and often several at once.
    TriMesh mesh;
    mesh.vertices.resize(6, Vec3::Zero());
    for (Vec3& v : mesh.vertices) v = draw.in_cube(1);
    for (Index f = 0; f < 3 + draw.below(8); ++f) {
      std::vector<Index> v = {0, 1, 2, 3, 4, 5};
      draw.shuffle(v);
      mesh.faces.push_back({v[0], v[1], v[2]});
    }
    const auto before = measure_topology(mesh);
    std::vector<Index> number = {0, 1, 2, 3, 4, 5};
    draw.shuffle(number);
    TriMesh other = mesh;
    for (Index v = 0; v < 6; ++v) other.vertices[number[v]] = mesh.vertices[v];
    for (Triangle& f : other.faces) f = {number[f[1]], number[f[2]], number[f[0]]};
    draw.shuffle(other.faces);
    const auto after = measure_topology(other);
    EXPECT_EQ(after.closed, before.closed);
    EXPECT_EQ(after.manifold, before.manifold);
    EXPECT_EQ(after.oriented, before.oriented);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_edges, before.boundary_edges);
    EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
  }
}

TEST(Topology, BoundaryEdgesRunAsTheirFacesDo) {
  using Edges = std::vector<std::array<Index, 2>>;
  EXPECT_TRUE(boundary_edges(cube()).empty());
  const TriMesh strip{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{2, 0, 1}, {2, 1, 3}}};
  EXPECT_EQ(boundary_edges(strip), (Edges{{0, 1}, {2, 0}, {1, 3}, {3, 2}}));
  TriMesh crowded = strip;
  crowded.vertices.emplace_back(0, 0, 1);
  crowded.faces.push_back({1, 2, 4});  // the edge 1-2 has three faces, and is none of the boundary
  EXPECT_EQ(boundary_edges(crowded), (Edges{{0, 1}, {2, 0}, {1, 3}, {4, 1}, {3, 2}, {2, 4}}));
  EXPECT_THROW(boundary_edges({strip.vertices, {{0, 1, 9}}}), InvalidInput);
}

TEST(Topology, CountsLoopsOfTheBoundaryAndCrowdedEdges) {
  EXPECT_EQ(measure_topology(cube()).boundary_loops, 0u);
  TriMesh tube = cube();
  tube.faces.erase(tube.faces.begin(), tube.faces.begin() + 4);  // bottom and top
  auto t = measure_topology(tube);
  EXPECT_EQ(t.boundary_edges, 8u);
  EXPECT_EQ(t.boundary_loops, 2u);
  EXPECT_EQ(t.crowded_edges, 0u);
  TriMesh mesh = tetrahedron();
  mesh.vertices.emplace_back(1, 1, 0);
  mesh.faces.push_back({1, 2, 4});
  t = measure_topology(mesh);
  EXPECT_EQ(t.crowded_edges, 1u);
  EXPECT_EQ(t.boundary_loops, 1u);
}

TEST(DegenerateFaces, AreThoseWithoutArea) {
  TriMesh mesh = cube();
  EXPECT_TRUE(degenerate_faces(mesh).empty());
  mesh.vertices.emplace_back(0.5, 0, 0);
  mesh.vertices.emplace_back(1, 0, 0);
  mesh.faces.insert(mesh.faces.end(), {{0, 1, 8}, {0, 0, 3}, {1, 9, 3}, {0, 8, 3}});
  EXPECT_EQ(degenerate_faces(mesh), (std::vector<Index>{12, 13, 14}));
}

TEST(DuplicateFaces, HaveTheSameVerticesInWhateverOrder) {
  TriMesh mesh = cube();
  EXPECT_TRUE(duplicate_faces(mesh).empty());
  const auto [a, b, c] = mesh.faces[2];
  mesh.faces.insert(mesh.faces.begin(), {c, b, a});
  mesh.faces.push_back({b, c, a});
  EXPECT_EQ(duplicate_faces(mesh), (std::vector<Index>{3, 13}));
}

TEST(DefectiveFaces, AreNotLookedForAmongFacesWithoutVertices) {
  TriMesh mesh = cube();
  mesh.faces.push_back({0, 1, 8});
  EXPECT_THROW(degenerate_faces(mesh), InvalidInput);
  EXPECT_THROW(duplicate_faces(mesh), InvalidInput);
}

TEST(Valence, IsTheNumberOfEdges) {
  const auto sphere = valences(icosphere(2));
  EXPECT_EQ(std::count(sphere.begin(), sphere.end(), 5u), 12);
  EXPECT_EQ(std::count(sphere.begin(), sphere.end(), 6u), static_cast<std::ptrdiff_t>(sphere.size()) - 12);
  const TriMesh open = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 2}}};
  EXPECT_EQ(valences(open), (std::vector<Index>{2, 2, 2, 0}));
}

TEST(Topology, OfManyBodiesIsThatOfEach) {
  constexpr Index kBodies = 9000;  // 36,000 vertices: more than one block
  TriMesh mesh;
  for (Index i = 0; i < kBodies; ++i) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    const TriMesh body = moved(tetrahedron(), {2.0 * i, 0, 0});
    mesh.vertices.insert(mesh.vertices.end(), body.vertices.begin(), body.vertices.end());
    for (const auto& [a, b, c] : body.faces) mesh.faces.push_back({first + a, first + b, first + c});
  }
  Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, kBodies);
  EXPECT_EQ(topology.euler_characteristic, 2 * kBodies);
  EXPECT_EQ(valences(mesh), std::vector<Index>(4 * kBodies, 3));
  std::vector<Vec3> points;
  for (Index i = 0; i < kBodies; ++i) points.push_back({2.0 * i + (i % 2 == 0 ? 0.1 : 1.1), 0.1, 0.1});
  const std::vector<bool> inside = points_inside(mesh, points);
  for (Index i = 0; i < kBodies; ++i) EXPECT_EQ(inside[i], i % 2 == 0);
  mesh.faces.pop_back();                // opens the last body
  mesh.faces.push_back(mesh.faces[0]);  // the first has a face twice
  topology = measure_topology(mesh);
  EXPECT_FALSE(topology.closed || topology.manifold || topology.oriented);
  EXPECT_EQ(topology.boundary_edges, 3u);
  EXPECT_EQ(topology.boundary_loops, 1u);
  EXPECT_EQ(topology.crowded_edges, 3u);
  const std::vector<std::array<Index, 2>> boundary = boundary_edges(mesh);
  ASSERT_EQ(boundary.size(), 3u);
  for (const auto& [from, to] : boundary) EXPECT_GE(std::min(from, to), Index{4 * (kBodies - 1)});
}

TEST(EnclosedVolume, OfSimpleBodiesIsExact) {
  EXPECT_EQ(enclosed_volume({}), 0);
  // Products and sums of small whole numbers are exact, the division by 6 rounds once.
  EXPECT_DOUBLE_EQ(enclosed_volume(tetrahedron()), 1.0 / 6);
  EXPECT_DOUBLE_EQ(enclosed_volume(cube()), 1);
  EXPECT_DOUBLE_EQ(enclosed_volume(inverted(cube())), -1);
  EXPECT_DOUBLE_EQ(enclosed_volume(moved(cube(), {0x1p40, 0x1p40, 0x1p40})), 1);
  EXPECT_DOUBLE_EQ(enclosed_volume(cube() + moved(tetrahedron(), {5, 5, 5})), 7.0 / 6);
}

TEST(EnclosedVolume, OfAPrismaticTorusFollowsPappus) {
  // Between two neighbouring cross-sections lies a prismatoid; as the tube's corners lie on cones around the axis, the
  // volume is the polygon's area times its centre's path, with sin(2 pi / n) in place of 2 pi / n for both polygons.
  const Index along = 40, around = 24;
  const double expected = 0.5 * around * std::sin(2 * std::numbers::pi / around) *  // area of the cross-section
                          3 * along * std::sin(2 * std::numbers::pi / along);       // path of its centre
  const double volume = enclosed_volume(torus(3, 1, along, around));
  // The quadrilaterals are planar trapezoids, so that their diagonals do not matter: only rounding is left.
  EXPECT_NEAR(volume, expected, 1e-12 * expected);
}

}  // namespace
}  // namespace vmesh
