// Surfaces around small vessels, and what is known of a sound volume mesh without the code that makes or checks it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/production/produce.h"
#include "vmesh/solid/make_volume.h"
#include "vmesh/surface/surface_attributes.h"

namespace vmesh::testing {

inline VesselWall grown_wall(const Centerline& centerline, EndShape ends = EndShape::flat, int around = 6) {
  ProductionOptions options;
  options.ends = ends;
  options.growth.around = around;
  const Production production = produce(centerline, {}, options);
  EXPECT_TRUE(production.result.is_sound());
  const GenerateResult& result = production.result;
  MeshAttributes attributes =
      surface_attributes(result.mesh, result.binding, result.radius, result.openings, centerline);
  if (!production.ends.ends.empty()) add_cap_labels(production.ends, attributes);
  return vessel_wall(result.mesh, attributes);
}

/// A vessel of radius 2 from x = 0 to 20 mm.
inline Centerline tube() { return {{{{0, 0, 0}, 2}, {{20, 0, 0}, 2}}, {{0, 1}}}; }

/// Three quarters of a circle of radius 6, a vessel of radius 2.
inline Centerline bend() {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i <= 24; ++i) {
    const double turn = 1.5 * std::numbers::pi * i / 24;
    nodes.push_back({6 * Vec3(std::cos(turn), std::sin(turn), 0), 2});
    if (i > 0) segments.push_back({i - 1, i});
  }
  return {nodes, segments};
}

/// A trunk that divides at a sharp angle.
inline Centerline bifurcation() {
  return {{{{0, 0, 0}, 2.5}, {{0, 0, 15}, 2.5}, {{6, 0, 30}, 2}, {{-6, 0, 30}, 1.6}}, {{0, 1}, {1, 2}, {1, 3}}};
}

/// From radius 3 to .5 within 20 mm.
inline Centerline taper() { return {{{{0, 0, 0}, 3}, {{20, 0, 0}, 0.5}, {{26, 0, 0}, 0.5}}, {{0, 1}, {1, 2}}}; }

/// Two vessels of radius 2 side by side, .2 mm apart.
inline Centerline neighbours() {
  return {{{{-12, 0, 0}, 2}, {{12, 0, 0}, 2}, {{-12, 4.2, 0}, 2}, {{12, 4.2, 0}, 2}}, {{0, 1}, {2, 3}}};
}

/// The determinant of a wedge's map at a place, by differences of its own formula.
inline double wedge_determinant(const VolumeMesh& mesh, const Wedge& wedge, double s, double t, double w) {
  const auto& p = mesh.points;
  const auto mix = [w](const Vec3& below, const Vec3& above) -> Vec3 { return (1 - w) * below + w * above; };
  const Vec3 along_s = mix(p[wedge[1]], p[wedge[4]]) - mix(p[wedge[0]], p[wedge[3]]);
  const Vec3 along_t = mix(p[wedge[2]], p[wedge[5]]) - mix(p[wedge[0]], p[wedge[3]]);
  const Vec3 along_w =
      (1 - s - t) * (p[wedge[3]] - p[wedge[0]]) + s * (p[wedge[4]] - p[wedge[1]]) + t * (p[wedge[5]] - p[wedge[2]]);
  return along_s.cross(along_t).dot(along_w);
}

/// Sampled densely, corners included.
inline double least_determinant(const VolumeMesh& mesh, const Wedge& wedge) {
  constexpr int kSteps = 8;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      for (int k = 0; k <= kSteps; ++k)
        least =
            std::min(least, wedge_determinant(mesh, wedge, double(i) / kSteps, double(j) / kSteps, double(k) / kSteps));
    }
  }
  return least;
}

inline double six_volumes(const VolumeMesh& mesh, Index a, Index b, Index c, Index d) {
  const auto at = [&](Index v) -> Eigen::Matrix<long double, 3, 1> { return mesh.points[v].cast<long double>(); };
  const Eigen::Matrix<long double, 3, 1> x = at(b) - at(a), y = at(c) - at(a), z = at(d) - at(a);
  return static_cast<double>(x.cross(y).dot(z));
}

inline std::size_t inverted_cells(const VolumeMesh& mesh) {
  std::size_t count = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) count += !(six_volumes(mesh, a, b, c, d) > 0);
  for (const Wedge& wedge : mesh.wedges) count += !(least_determinant(mesh, wedge) > 0);
  for (const auto& [a, b, c, d, e] : mesh.pyramids)
    count += !(six_volumes(mesh, a, b, d, e) > 0 && six_volumes(mesh, b, c, a, e) > 0 &&
               six_volumes(mesh, c, d, b, e) > 0 && six_volumes(mesh, d, a, c, e) > 0);
  return count;
}

/// Every face by its corners, and how often it is seen from a cell and from outside.
inline std::map<std::vector<Index>, std::pair<int, int>> face_counts(const VolumeMesh& mesh) {
  std::map<std::vector<Index>, std::pair<int, int>> counts;
  const auto add = [&](std::vector<Index> corners, bool outside) {
    std::sort(corners.begin(), corners.end());
    ++(outside ? counts[corners].second : counts[corners].first);
  };
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    for (const auto& face : {std::vector<Index>{a, b, c}, {a, b, d}, {a, c, d}, {b, c, d}}) add(face, false);
  }
  for (const auto& [a, b, c, d, e, f] : mesh.wedges) {
    for (const auto& face : {std::vector<Index>{a, b, c}, {d, e, f}, {a, b, d, e}, {b, c, e, f}, {a, c, d, f}})
      add(face, false);
  }
  for (const auto& [a, b, c, d, e] : mesh.pyramids) {
    for (const auto& face : {std::vector<Index>{a, b, c, d}, {a, b, e}, {b, c, e}, {c, d, e}, {a, d, e}})
      add(face, false);
  }
  for (const BoundaryFace& face : mesh.boundary) {
    std::vector<Index> corners(face.corners.begin(), face.corners.begin() + (face.is_triangle() ? 3 : 4));
    add(corners, true);
  }
  return counts;
}

/// Inner faces have two cells, those of the boundary one.
inline std::size_t unmatched_faces(const VolumeMesh& mesh) {
  const auto counts = face_counts(mesh);
  return static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), [](const auto& entry) {
    const auto& [cells, outside] = entry.second;
    return cells + outside != 2 || outside > 1;
  }));
}

/// By Gauss' theorem from the boundary alone; quadrilaterals in both ways of dividing them.
inline double volume_within_boundary(const VolumeMesh& mesh) {
  double six = 0;
  const auto add = [&](Index a, Index b, Index c, double weight) {
    six += weight * mesh.points[a].dot(mesh.points[b].cross(mesh.points[c]));
  };
  for (const BoundaryFace& face : mesh.boundary) {
    const auto& [a, b, c, d] = face.corners;
    if (face.is_triangle()) {
      add(a, b, c, 1);
    } else {
      for (const auto& [i, j, k] : {std::array{a, b, c}, std::array{a, c, d}, std::array{b, c, d}, std::array{b, d, a}})
        add(i, j, k, 0.5);
    }
  }
  return six / 6;
}

inline double patch_area(const VolumeMesh& mesh, const std::string& name) {
  const auto patch = std::find(mesh.patch_names.begin(), mesh.patch_names.end(), name) - mesh.patch_names.begin();
  double area = 0;
  for (const BoundaryFace& face : mesh.boundary) {
    if (face.patch != patch) continue;
    const auto at = [&](std::size_t i) -> const Vec3& { return mesh.points[face.corners[i]]; };
    area += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
    if (!face.is_triangle()) area += (at(2) - at(0)).cross(at(3) - at(0)).norm() / 2;
  }
  return area;
}

inline double cap_area(const VesselWall& wall, Index patch) {
  double area = 0;
  for (Index f = 0; f < wall.patch.size(); ++f)
    area += wall.patch[f] == patch ? area_normal(wall.mesh, f).norm() / 2 : 0;
  return area;
}

// A sum of thousands of terms, each rounded to 1e-16 of it.
constexpr double kSum = 1e-9;

/// What holds for every mesh of a lumen.
inline void expect_sound_lumen(const VesselWall& wall, const VolumeResult& result) {
  for (const VolumeDefect& defect : result.defects) ADD_FAILURE() << defect.message;
  const VolumeMesh& mesh = result.mesh;
  EXPECT_GT(mesh.tetrahedra.size(), 0u);
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_EQ(unmatched_faces(mesh), 0u);
  EXPECT_EQ(mesh.cell_region.size(), mesh.cell_count());
  for (Index patch = wall.wall_patches; patch < wall.patch_names.size(); ++patch) {
    const double expected = cap_area(wall, patch);
    EXPECT_NEAR(patch_area(mesh, wall.patch_names[patch]), expected, kSum * expected) << wall.patch_names[patch];
  }
  if (mesh.region_names.size() > 1) return;
  const double expected = enclosed_volume(wall.mesh);
  EXPECT_NEAR(volume_within_boundary(mesh), expected, kSum * expected);
}

}  // namespace vmesh::testing
