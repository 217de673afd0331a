#include "skeleton/closed_wall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"

#include "shapes.h"
#include "shared_data.h"

namespace vmesh::testing {
namespace {

using skeleton::close_wall;
using skeleton::ClosedWall;
using skeleton::FlatWallEnd;

struct TubeEnds {
  bool capped = false;
  Index around = 24, along = 40;
};

/// A tube along z from 0 to `length`, outward; capped by stars without middle vertices.
TriMesh tube(double radius, double length, const TubeEnds& options = {}) {
  TriMesh mesh;
  const Index n = options.around;
  for (Index j = 0; j <= options.along; ++j) {
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), length * j / options.along);
    }
  }
  for (Index j = 0; j < options.along; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index a = j * n + i, b = j * n + (i + 1) % n;
      mesh.faces.push_back({a, b, b + n});
      mesh.faces.push_back({a, b + n, a + n});
    }
  }
  const Index top = options.along * n;
  for (Index i = 2; options.capped && i < n; ++i) {
    mesh.faces.push_back({0, i, i - 1});
    mesh.faces.push_back({top, top + i - 1, top + i});
  }
  return mesh;
}

/// Every face with vertices of its own, as STL readers give it.
TriMesh exploded(const TriMesh& mesh) {
  TriMesh soup;
  for (const auto& [a, b, c] : mesh.faces) {
    const auto first = static_cast<Index>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TriMesh without_faces(TriMesh mesh, std::size_t first, std::size_t count) {
  const auto at = mesh.faces.begin() + static_cast<std::ptrdiff_t>(first);
  mesh.faces.erase(at, at + static_cast<std::ptrdiff_t>(count));
  return mesh;
}

TriMesh scaled(TriMesh mesh, double by) {
  for (Vec3& v : mesh.vertices) v *= by;
  return mesh;
}

void expect_sound(const ClosedWall& wall) {
  ASSERT_FALSE(wall.parts.empty());
  double before = std::numeric_limits<double>::infinity();
  for (const skeleton::WallPart& part : wall.parts) {
    const Topology topology = measure_topology(part.mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
    EXPECT_EQ(topology.components, 1u);
    EXPECT_NEAR(part.volume, enclosed_volume(part.mesh), 1e-9 * part.volume);
    EXPECT_LE(part.volume, before);
    before = part.volume;
    ASSERT_EQ(part.end_of_face.size(), part.mesh.faces.size());
    ASSERT_EQ(part.is_filling.size(), part.mesh.faces.size());
  }
  std::vector<double> areas(wall.ends.size(), 0);
  for (std::size_t p = 0; p < wall.parts.size(); ++p) {
    const skeleton::WallPart& part = wall.parts[p];
    for (Index f = 0; f < part.mesh.faces.size(); ++f) {
      const Index end = part.end_of_face[f];
      if (end == kNone) continue;
      ASSERT_LT(end, wall.ends.size());
      EXPECT_EQ(wall.ends[end].part, p);
      EXPECT_TRUE(part.is_filling[f] || !wall.ends[end].was_open);
      areas[end] += 0.5 * area_normal(part.mesh, f).dot(wall.ends[end].normal);
    }
  }
  for (std::size_t e = 0; e < wall.ends.size(); ++e) {
    EXPECT_NEAR(wall.ends[e].normal.norm(), 1, 1e-9);
    if (!wall.parts[wall.ends[e].part].wrapped) {
      EXPECT_NEAR(areas[e], wall.ends[e].area, 0.02 * areas[e]) << "end " << e;
    }
  }
}

bool mentions(const ClosedWall& wall, const std::string& words) {
  for (const std::string& note : wall.notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

/// Volume of a prism with a regular polygon for its base.
double prism(double radius, double length, Index around) {
  return 0.5 * around * radius * radius * std::sin(2 * std::numbers::pi / around) * length;
}

void expect_ends_of_tube(const ClosedWall& wall, double radius, double length, Index around, bool were_open) {
  ASSERT_EQ(wall.ends.size(), 2u);
  double normals = 0;
  for (const FlatWallEnd& end : wall.ends) {
    const bool top = end.normal.z() > 0;
    EXPECT_NEAR(std::abs(end.normal.z()), 1, 1e-9);
    EXPECT_LT((end.center - Vec3(0, 0, top ? length : 0)).norm(), 1e-9 * length);
    EXPECT_NEAR(end.area, prism(radius, 1, around), 1e-9);
    EXPECT_EQ(end.ring.size(), around);
    EXPECT_EQ(end.was_open, were_open);
    EXPECT_GT((end.ring[0] - end.center).cross(end.ring[1] - end.center).dot(end.normal), 0);
    normals += end.normal.z();
  }
  EXPECT_NEAR(normals, 0, 1e-9);
}

TEST(ClosedWall, OpeningsOfATubeAreClosedAndRemembered) {
  const ClosedWall wall = close_wall(tube(2, 20));
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, true);
  ASSERT_EQ(wall.parts.size(), 1u);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 1e-6);
  const auto fillings = std::count(wall.parts[0].is_filling.begin(), wall.parts[0].is_filling.end(), true);
  EXPECT_EQ(fillings, 2 * 22);
  EXPECT_TRUE(mentions(wall, "2 openings"));
}

TEST(ClosedWall, TrianglesOfASoupFindEachOther) {
  const ClosedWall wall = close_wall(exploded(tube(2, 20)));
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, true);
  EXPECT_EQ(wall.parts[0].mesh.vertices.size(), 24u * 41);
}

TEST(ClosedWall, VerticesThatDifferByRoundingAreOne) {
  TriMesh soup = exploded(tube(2, 20, {.capped = true}));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-1e-6, 1e-6);
  for (Vec3& v : soup.vertices) v += Vec3(shift(random), shift(random), shift(random));
  const ClosedWall wall = close_wall(soup);
  expect_sound(wall);
  EXPECT_EQ(wall.parts.size(), 1u);
  EXPECT_EQ(wall.ends.size(), 2u);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 1e-3);
  EXPECT_TRUE(mentions(wall, "taken as one"));
}

TEST(ClosedWall, ATubeThatFacesInwardsIsTurned) {
  const ClosedWall wall = close_wall(inverted(tube(2, 20)));
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, true);
  EXPECT_TRUE(mentions(wall, "inwards"));
}

TEST(ClosedWall, FacesAreTurnedToTheirNeighboursSide) {
  TriMesh mesh = tube(2, 20);
  std::mt19937 random(1);
  for (Triangle& face : mesh.faces) {
    if (random() % 3 == 0) std::swap(face[0], face[1]);
  }
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, true);
  EXPECT_TRUE(mentions(wall, "turned"));
}

TEST(ClosedWall, AMissingFaceIsNoEnd) {
  const ClosedWall wall = close_wall(without_faces(tube(2, 20), 1000, 1));
  expect_sound(wall);
  EXPECT_EQ(wall.ends.size(), 2u);
  EXPECT_TRUE(mentions(wall, "1 hole in the wall"));
}

TEST(ClosedWall, ASlitIsNoEnd) {
  // One row of quadrilaterals along the tube, not up to its ends.
  TriMesh mesh = tube(2, 20);
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t row = f / 48, column = f % 48;
    if (row < 5 || row > 34 || column > 1) kept.push_back(mesh.faces[f]);
  }
  mesh.faces = kept;
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  EXPECT_EQ(wall.ends.size(), 2u);
  EXPECT_TRUE(mentions(wall, "1 hole in the wall"));
}

TEST(ClosedWall, AnObliqueEndIsAnEnd) {
  TriMesh mesh = tube(2, 20);
  for (Vec3& v : mesh.vertices) v.z() += (v.x() + 2) * v.z() / 20;  // the top leans by 45 degrees
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  ASSERT_EQ(wall.ends.size(), 2u);
  const FlatWallEnd& end = wall.ends[wall.ends[0].center.z() > 10 ? 0 : 1];
  EXPECT_LT((end.normal - Vec3(-1, 0, 1).normalized()).norm(), 1e-6);
  EXPECT_NEAR(end.area, prism(2, 1, 24) * std::numbers::sqrt2, 1e-6);
}

TEST(ClosedWall, AJaggedUnevenEndIsClosed) {
  TriMesh mesh = tube(2, 20);
  for (std::size_t i = mesh.vertices.size() - 24; i < mesh.vertices.size(); ++i)
    mesh.vertices[i].z() += 0.3 * static_cast<double>(i % 3) + 0.2 * std::pow(mesh.vertices[i].x(), 2);
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  ASSERT_EQ(wall.ends.size(), 2u);
  EXPECT_GT(wall.ends[0].normal.cwiseAbs().z(), 0.98);
  EXPECT_GT(wall.ends[1].normal.cwiseAbs().z(), 0.98);
}

TEST(ClosedWall, FlatCapsAreFound) {
  const ClosedWall wall = close_wall(tube(2, 20, {.capped = true}));
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, false);
  EXPECT_TRUE(mentions(wall, "2 flat caps"));
  // With edges longer than the radius, eight of them around.
  const ClosedWall coarse = close_wall(tube(2, 20, {.capped = true, .around = 8, .along = 1}));
  expect_sound(coarse);
  expect_ends_of_tube(coarse, 2, 20, 8, false);
}

TEST(ClosedWall, RoundEndsAreNoCaps) {
  for (const int levels : {0, 1, 2, 3}) {
    TriMesh mesh = icosphere(levels);
    for (Vec3& v : mesh.vertices) v.z() += v.z() > 0 ? 5 : -5;  // a capsule
    const ClosedWall wall = close_wall(mesh);
    expect_sound(wall);
    EXPECT_TRUE(wall.ends.empty()) << levels;
    EXPECT_TRUE(wall.notes.empty());
  }
}

/// The faces of the voxels of unit size whose middles are inside, as cuboids are drawn.
template <class Inside>
TriMesh voxel_faces(int size, Inside&& inside) {
  TriMesh mesh;
  const auto in = [&](int x, int y, int z) { return inside(Vec3(x, y, z)); };
  for (int n = 0; n < size * size * size; ++n) {
    const std::array<int, 3> at = {n % size - size / 2, n / size % size - size / 2, n / size / size - size / 2};
    if (!in(at[0], at[1], at[2])) continue;
    for (int side = 0; side < 6; ++side) {
      std::array<int, 3> next = at;
      const int axis = side / 2, sign = side % 2 == 0 ? -1 : 1;
      next[axis] += sign;
      if (in(next[0], next[1], next[2])) continue;
      Vec3 middle(at[0], at[1], at[2]), u = Vec3::Zero(), v = Vec3::Zero();
      middle[axis] += 0.5 * sign;
      u[(axis + 1) % 3] = 0.5;
      v[(axis + 2) % 3] = 0.5 * sign;
      const auto first = static_cast<Index>(mesh.vertices.size());
      for (const Vec3& p : {Vec3(middle - u - v), Vec3(middle + u - v), Vec3(middle + u + v), Vec3(middle - u + v)})
        mesh.vertices.push_back(p);
      mesh.faces.push_back({first, first + 1, first + 2});
      mesh.faces.push_back({first, first + 2, first + 3});
    }
  }
  return mesh;
}

TEST(ClosedWall, StairsOfVoxelsAreNoCaps) {
  // A capsule that leans, so that its voxels touch along edges here and there.
  const Vec3 axis = Vec3(1, 0.37, 0.21).normalized();
  for (const double radius : {2.5, 3.3, 4.2, 5.1, 6.0, 7.5}) {
    const TriMesh mesh = voxel_faces(48, [&](const Vec3& p) {
      const double along = std::clamp(p.dot(axis), -15.0, 15.0);
      return (p - along * axis).norm() < radius;
    });
    const ClosedWall wall = close_wall(mesh);
    expect_sound(wall);
    EXPECT_EQ(wall.parts.size(), 1u);
    EXPECT_TRUE(wall.ends.empty()) << radius;
  }
}

TEST(ClosedWall, VoxelsThatTouchAlongEdgesAreTakenApart) {
  const ClosedWall wall = close_wall(cube() + moved(cube(), {1, 1, 0}));
  expect_sound(wall);
  EXPECT_EQ(wall.parts.size(), 2u);
  // Along a single edge of one piece: two cubes joined by two others.
  const TriMesh ring = voxel_faces(8, [](const Vec3& p) {
    return (p - Vec3(1, 1, 0)).norm() < 0.1 || p.norm() < 0.1 || p == Vec3(0, 0, 1) || p == Vec3(1, 0, 1) ||
           p == Vec3(1, 1, 1);
  });
  const ClosedWall touching = close_wall(ring);
  expect_sound(touching);
  EXPECT_EQ(touching.parts.size(), 1u);
  EXPECT_NEAR(touching.parts[0].volume, 5, 1e-12);
}

TEST(ClosedWall, TheLumenOfAWallIsTaken) {
  const TriMesh outer = tube(3, 22, {.capped = true}), inner = moved(tube(2, 20, {.capped = true}), {0, 0, 1});
  for (const TriMesh& mesh : {outer + inner, outer + inverted(inner), inner + inverted(outer)}) {
    const ClosedWall wall = close_wall(mesh);
    expect_sound(wall);
    ASSERT_EQ(wall.parts.size(), 1u);
    EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 1e-6);
    EXPECT_EQ(wall.ends.size(), 2u);
    EXPECT_TRUE(mentions(wall, "inner surface"));
  }
}

TEST(ClosedWall, ACavityIsLeftOut) {
  const TriMesh cavity = moved(scaled(icosphere(1), 0.5), {0, 0, 7});
  for (const TriMesh& mesh : {tube(2, 20) + cavity, tube(2, 20) + inverted(cavity)}) {
    const ClosedWall wall = close_wall(mesh);
    expect_sound(wall);
    ASSERT_EQ(wall.parts.size(), 1u);
    EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 1e-6);
    EXPECT_TRUE(mentions(wall, "cavity is left out"));
    EXPECT_TRUE(mentions(wall, "7) mm"));
  }
}

TEST(ClosedWall, DebrisIsLeftOutInOneLine) {
  TriMesh mesh = tube(2, 20) + moved(tube(1, 10), {10, 0, 0});
  for (int i = 0; i < 5; ++i) mesh = mesh + moved(scaled(cube(), 0.01), {20. + i, 0, 0});
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  EXPECT_EQ(wall.parts.size(), 2u);
  EXPECT_EQ(wall.ends.size(), 4u);
  EXPECT_TRUE(mentions(wall, "5 components with almost no volume"));
}

TEST(ClosedWall, DuplicatesAndFinsAreLeftOut) {
  TriMesh mesh = tube(2, 20);
  mesh.faces.push_back(mesh.faces[100]);
  mesh.faces.push_back({mesh.faces[200][1], mesh.faces[200][0], mesh.faces[200][2]});
  mesh.faces.push_back({5, 5, 6});
  mesh.vertices.emplace_back(3, 3, 10);
  mesh.faces.push_back({mesh.faces[300][0], mesh.faces[300][1], static_cast<Index>(mesh.vertices.size() - 1)});
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  expect_ends_of_tube(wall, 2, 20, 24, true);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 1e-6);
  EXPECT_TRUE(mentions(wall, "2 duplicate faces"));
  EXPECT_TRUE(mentions(wall, "hangs on an edge"));
  EXPECT_TRUE(mentions(wall, "corners coincide"));
}

TEST(ClosedWall, AWallBetweenTwoVolumesIsLeftOut) {
  const ClosedWall wall = close_wall(cube() + moved(cube(), {1, 0, 0}));
  expect_sound(wall);
  ASSERT_EQ(wall.parts.size(), 1u);
  EXPECT_NEAR(wall.parts[0].volume, 2, 1e-12);
}

TEST(ClosedWall, AMembraneInAVesselIsWrappedAway) {
  TriMesh mesh = tube(2, 20);
  for (Index i = 2; i < 24; ++i) mesh.faces.push_back({20 * 24, 20 * 24 + i - 1, 20 * 24 + i});
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  ASSERT_EQ(wall.parts.size(), 1u);
  EXPECT_TRUE(wall.parts[0].wrapped);
  EXPECT_GT(wall.wrap_offset, 0);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 0.02 * prism(2, 20, 24));
  EXPECT_EQ(wall.ends.size(), 2u);
  EXPECT_TRUE(mentions(wall, "wrapped"));
}

/// The faces apart, each smaller by this share.
TriMesh shrunk(const TriMesh& mesh, double by) {
  TriMesh soup = exploded(mesh);
  for (std::size_t f = 0; f < soup.faces.size(); ++f) {
    const Vec3 middle = (soup.vertices[3 * f] + soup.vertices[3 * f + 1] + soup.vertices[3 * f + 2]) / 3;
    for (std::size_t i = 3 * f; i < 3 * f + 3; ++i) soup.vertices[i] += by * (middle - soup.vertices[i]);
  }
  return soup;
}

TEST(ClosedWall, NarrowGapsAreClosed) {
  const ClosedWall wall = close_wall(shrunk(tube(2, 20), 0.02));
  expect_sound(wall);
  ASSERT_EQ(wall.parts.size(), 1u);
  EXPECT_EQ(wall.wrap_offset, 0);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 0.01 * prism(2, 20, 24));
  EXPECT_EQ(wall.ends.size(), 2u);
}

TEST(ClosedWall, ASoupWithGapsIsWrapped) {
  const ClosedWall wall = close_wall(shrunk(tube(2, 20, {.capped = true}), 0.4));
  expect_sound(wall);
  ASSERT_EQ(wall.parts.size(), 1u);
  EXPECT_TRUE(wall.parts[0].wrapped);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 0.02 * prism(2, 20, 24));
  EXPECT_GT(wall.wrap_offset, 0);
}

TEST(ClosedWall, HolesHereAndThereAreNoEnds) {
  TriMesh mesh = tube(2, 20);
  std::mt19937 random(1);
  std::erase_if(mesh.faces, [&](const Triangle&) { return random() % 20 == 0; });
  const ClosedWall wall = close_wall(mesh);
  expect_sound(wall);
  EXPECT_NEAR(wall.parts[0].volume, prism(2, 20, 24), 0.02 * prism(2, 20, 24));
  EXPECT_LE(wall.ends.size(), 2u);
}

TEST(ClosedWall, TheSameEveryTime) {
  const TriMesh mesh = exploded(tube(2, 20)) + moved(without_faces(tube(1, 9), 100, 3), {8, 0, 0});
  const ClosedWall a = close_wall(mesh), b = close_wall(mesh);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t p = 0; p < a.parts.size(); ++p) {
    EXPECT_EQ(a.parts[p].mesh.vertices, b.parts[p].mesh.vertices);
    EXPECT_EQ(a.parts[p].mesh.faces, b.parts[p].mesh.faces);
  }
  EXPECT_EQ(a.notes, b.notes);
}

TEST(ClosedWall, WhatHasNoVolumeIsRefused) {
  EXPECT_THROW(close_wall({}), InvalidInput);
  EXPECT_THROW(close_wall({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}), InvalidInput);
  EXPECT_THROW(close_wall({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), InvalidInput);
  EXPECT_THROW(close_wall({{{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}}), InvalidInput);
  EXPECT_THROW(close_wall({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), InvalidInput);
  TriMesh huge = scaled(cube(), 1e200);
  EXPECT_THROW(close_wall(huge), InvalidInput);
  huge.vertices.emplace_back(std::nan(""), 0, 0);  // without a face
  EXPECT_THROW(close_wall(huge), InvalidInput);
  TriMesh fine = cube();
  fine.vertices.emplace_back(std::nan(""), 0, 0);
  EXPECT_NO_THROW(close_wall(fine));
}

TEST(ClosedWall, CanBeCancelled) {
  EXPECT_THROW(close_wall(tube(2, 20), [](std::string_view, double) { return false; }), Cancelled);
}

// Surfaces of others.

ClosedWall closed_file(const std::string& relative) { return close_wall(read_surface(shared_data(relative)).mesh); }

#define EXPECT_WALL(file, part_count, openings, caps)                                                        \
  do {                                                                                                       \
    const ClosedWall wall = closed_file(file);                                                               \
    expect_sound(wall);                                                                                      \
    EXPECT_EQ(wall.parts.size(), part_count) << file;                                                        \
    const auto open = std::count_if(wall.ends.begin(), wall.ends.end(), [](auto& e) { return e.was_open; }); \
    EXPECT_EQ(open, openings) << file;                                                                       \
    EXPECT_EQ(wall.ends.size() - static_cast<std::size_t>(open), caps) << file;                              \
  } while (false)

TEST(WallsOfOthers, FieldCasesAreClosed) {
  VMESH_NEED_SHARED_DATA("field");
  EXPECT_WALL("field/capped.stl", 1u, 0, 2u);
  EXPECT_WALL("field/sv_cylinder.stl", 1u, 0, 2u);
  EXPECT_WALL("field/coarse8.stl", 1u, 0, 2u);
  EXPECT_WALL("field/tube_path_4R.stl", 1u, 0, 2u);
  for (const char* file : {"field/closed_wall.stl", "field/nested_same_orientation.stl"}) {
    const ClosedWall wall = closed_file(file);
    expect_sound(wall);
    EXPECT_EQ(wall.parts.size(), 1u);
    EXPECT_TRUE(mentions(wall, "inner surface"));
  }
}

TEST(WallsOfOthers, OpenEndsOfAnAortaAreClosed) {
  VMESH_NEED_SHARED_DATA("pairs_centerline_surface");
  EXPECT_WALL("pairs_centerline_surface/aorta-surface-open-ends.stl", 1u, 3, 0u);
}

}  // namespace
}  // namespace vmesh::testing
