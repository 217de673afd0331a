#include "vmesh/solid/followed_volume.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"
#include "vmesh/surface/followed_surface.h"

#include "solid/mend_cells.h"

namespace vmesh {
namespace {

/// Of every point of layers, the one of its column with the lowest number: make_volume() numbers those of the wall
/// first.
std::vector<Index> roots_of_columns(const VolumeMesh& mesh) {
  DisjointSets columns(mesh.points.size());
  for (const Wedge& wedge : mesh.wedges) {
    for (std::size_t i = 0; i < 3; ++i) columns.join(wedge[i], wedge[i + 3]);
  }
  std::vector<Index> roots(mesh.points.size());
  for (Index v = 0; v < roots.size(); ++v) roots[v] = columns.find(v);
  return roots;
}

/// By which the wall turns around the points of columns on it.
std::vector<Eigen::Quaterniond> turns_at_roots(const VolumeMesh& mesh, const std::vector<Index>& roots,
                                               const std::vector<Vec3>& moved) {
  std::vector<Vec3> before(mesh.points.size(), Vec3::Zero()), after = before;
  const auto area = [](const std::vector<Vec3>& points, const Triangle& face) {
    return (points[face[1]] - points[face[0]]).cross(points[face[2]] - points[face[0]]).eval();
  };
  for (const Wedge& wedge : mesh.wedges) {
    for (const std::size_t first : {0, 3}) {
      const Triangle face = {wedge[first], wedge[first + 1], wedge[first + 2]};
      if (std::any_of(face.begin(), face.end(), [&](Index v) { return roots[v] != v; })) continue;
      const Vec3 was = area(mesh.points, face), is = area(moved, face);
      for (const Index v : face) {
        const double side = before[v].dot(was) < 0 ? -1 : 1;  // of the wall on which the wedge is
        before[v] += side * was;
        after[v] += side * is;
      }
    }
  }
  std::vector<Eigen::Quaterniond> turns;
  turns.reserve(before.size());
  for (std::size_t v = 0; v < before.size(); ++v)
    turns.push_back(Eigen::Quaterniond::FromTwoVectors(before[v], after[v]));
  return turns;
}

/// Points of the sides of layers that are outside: on caps, which they must not leave.
std::vector<char> points_of_sides(const VolumeMesh& mesh) {
  std::vector<char> is_side(mesh.points.size(), 0);
  for (const BoundaryFace& face : mesh.boundary) {
    if (face.is_triangle()) continue;
    for (const Index v : face.corners) is_side[v] = 1;
  }
  return is_side;
}

/// Where points of layers go with their points of the wall.
void carry_layers(const VolumeMesh& mesh, const std::vector<double>& widening, std::vector<Vec3>& moved) {
  const std::vector<Index> roots = roots_of_columns(mesh);
  const std::vector<char> is_side = points_of_sides(mesh);
  const std::vector<Eigen::Quaterniond> turns = turns_at_roots(mesh, roots, moved);
  for (Index v = 0; v < mesh.points.size(); ++v) {
    const Index root = roots[v];
    if (root == v || is_side[v]) continue;
    moved[v] = moved[root] + turns[root] * (widening[root] * (mesh.points[v] - mesh.points[root]));
  }
}

}  // namespace

std::vector<Vec3> follow_edit(const VolumeMesh& mesh, const Centerline& centerline, const CenterlineEdit& edit) {
  check_volume_mesh(mesh);
  VolumeMesh moved = mesh;
  moved.points = follow_edit_within(mesh.points, centerline, edit);
  if (find_inverted_cells(moved).count == 0) return std::move(moved.points);
  VolumeMesh mended = moved;
  carry_layers(mesh, widening_within(mesh.points, centerline, edit), mended.points);
  mend_cells(mended, mesh.points);
  return std::move((find_inverted_cells(mended).count == 0 ? mended : moved).points);
}

}  // namespace vmesh
