#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"

#include "solid/wedge_jacobian.h"

namespace vmesh {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

WedgeCorners corners_of(const VolumeMesh& mesh, const Wedge& cell) {
  WedgeCorners corners;
  for (std::size_t i = 0; i < cell.size(); ++i) corners[i] = mesh.points[cell[i]];
  return corners;
}

using TetrahedronCorners = std::array<Vec3, 4>;

/// Angle between the two faces at edge i-j, in degrees.
double dihedral_angle(const TetrahedronCorners& p, std::size_t i, std::size_t j) {
  const std::size_t k = i != 0 && j != 0 ? 0 : i != 1 && j != 1 ? 1 : 2, l = 6 - i - j - k;
  const Vec3 edge = p[j] - p[i], first = edge.cross(p[k] - p[i]), second = edge.cross(p[l] - p[i]);
  return std::atan2(first.cross(second).norm(), first.dot(second)) * kDegrees;
}

/// 3 inradius / circumradius.
double radius_ratio(const TetrahedronCorners& p) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const double six_volumes = a.dot(b.cross(c));
  const double twice_area = a.cross(b).norm() + b.cross(c).norm() + c.cross(a).norm() + (b - a).cross(c - a).norm();
  const Vec3 center = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  // Inradius: 3 V / area; circumradius: |center| / (12 V).
  return center.norm() > 0 ? 6 * six_volumes * six_volumes / (twice_area * center.norm()) : 0;
}

double area_of(const VolumeMesh& mesh, const BoundaryFace& face) {
  const auto at = [&](std::size_t i) -> const Vec3& { return mesh.points[face.corners[i]]; };
  const Vec3 first = (at(1) - at(0)).cross(at(2) - at(0));
  if (face.is_triangle()) return first.norm() / 2;
  return (first + (at(2) - at(0)).cross(at(3) - at(0))).norm() / 2;
}

void measure_tetrahedra(const VolumeMesh& mesh, VolumeMeasures& measures) {
  double sum = 0;
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    const TetrahedronCorners p = {mesh.points[cell[0]], mesh.points[cell[1]], mesh.points[cell[2]],
                                  mesh.points[cell[3]]};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double angle = dihedral_angle(p, i, j);
        measures.max_dihedral_deg = std::max(measures.max_dihedral_deg, angle);
        if (angle >= measures.min_dihedral_deg) continue;
        measures.min_dihedral_deg = angle;
        measures.worst_tetrahedron = (p[0] + p[1] + p[2] + p[3]) / 4;
      }
    }
    const double ratio = radius_ratio(p);
    sum += ratio;
    measures.least_radius_ratio = std::min(measures.least_radius_ratio, ratio);
  }
  if (!mesh.tetrahedra.empty()) measures.mean_radius_ratio = sum / static_cast<double>(mesh.tetrahedra.size());
}

double least_jacobian(const VolumeMesh& mesh, const Tetrahedron& cell) { return 6 * volume_of(mesh, cell); }

double least_jacobian(const VolumeMesh& mesh, const Wedge& cell) {
  const auto coefficients = jacobian_coefficients(corners_of(mesh, cell));
  return *std::min_element(coefficients.begin(), coefficients.end());
}

double least_jacobian(const VolumeMesh& mesh, const Pyramid& cell) {
  const auto& [a, b, c, d, e] = cell;
  const std::array<Tetrahedron, 4> corners = {{{a, b, d, e}, {b, c, a, e}, {c, d, b, e}, {d, a, c, e}}};
  double least = std::numeric_limits<double>::infinity();
  for (const Tetrahedron& corner : corners) least = std::min(least, least_jacobian(mesh, corner));
  return least;
}

}  // namespace

std::vector<double> least_jacobians_mm3(const VolumeMesh& mesh) {
  std::vector<double> jacobians;
  jacobians.reserve(mesh.cell_count());
  for_each_cell(mesh, [&](const auto& cell) { jacobians.push_back(least_jacobian(mesh, cell)); });
  return jacobians;
}

double volume_of(const VolumeMesh& mesh, const Tetrahedron& cell) {
  const Vec3& a = mesh.points[cell[0]];
  return (mesh.points[cell[1]] - a).cross(mesh.points[cell[2]] - a).dot(mesh.points[cell[3]] - a) / 6;
}

double volume_of(const VolumeMesh& mesh, const Wedge& cell) {
  const auto coefficients = jacobian_coefficients(corners_of(mesh, cell));
  return std::accumulate(coefficients.begin(), coefficients.end(), 0.0) / 18;
}

double volume_of(const VolumeMesh& mesh, const Pyramid& cell) {
  const auto& [a, b, c, d, e] = cell;
  return (volume_of(mesh, Tetrahedron{a, b, d, e}) + volume_of(mesh, Tetrahedron{b, c, a, e}) +
          volume_of(mesh, Tetrahedron{c, d, b, e}) + volume_of(mesh, Tetrahedron{d, a, c, e})) /
         2;
}

VolumeMeasures measure_volume(const VolumeMesh& mesh) {
  VolumeMeasures measures;
  measure_tetrahedra(mesh, measures);
  for (const Wedge& cell : mesh.wedges) {
    const auto coefficients = jacobian_coefficients(corners_of(mesh, cell));
    const auto [least, most] = std::minmax_element(coefficients.begin(), coefficients.end());
    measures.least_scaled_jacobian = std::min(measures.least_scaled_jacobian, *most > 0 ? *least / *most : -1);
  }
  measures.region_volume_mm3.assign(mesh.region_names.size(), 0);
  std::size_t c = 0;
  for_each_cell(
      mesh, [&](const auto& cell) { measures.region_volume_mm3.at(mesh.cell_region[c++]) += volume_of(mesh, cell); });
  measures.patch_area_mm2.assign(mesh.patch_names.size(), 0);
  for (const BoundaryFace& face : mesh.boundary) measures.patch_area_mm2.at(face.patch) += area_of(mesh, face);
  return measures;
}

}  // namespace vmesh
