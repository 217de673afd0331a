#include "vmesh/solid/followed_volume.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"
#include "vmesh/surface/followed_surface.h"

#include "solid/fan_direction.h"
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

// Layers are made thinner in steps of this factor where cells still turn over or the outside crosses itself.
constexpr double kThinnerStep = 0.6;
constexpr int kMostThinnings = 8;

std::vector<Index> points_of_crossing_faces(const VolumeMesh& mesh) {
  std::vector<Triangle> faces;
  for (const BoundaryFace& face : mesh.boundary) {
    const auto& [a, b, c, d] = face.corners;
    faces.push_back({a, b, c});
    if (!face.is_triangle()) faces.push_back({a, c, d});
  }
  std::vector<Index> points;
  for (const auto& [f, g] : self_intersections({mesh.points, faces})) {
    points.insert(points.end(), faces[f].begin(), faces[f].end());
    points.insert(points.end(), faces[g].begin(), faces[g].end());
  }
  return points;
}

/// Points of layers, carried by those of the wall.
class CarriedLayers {
 public:
  CarriedLayers(const VolumeMesh& mesh, const std::vector<double>& widening, const std::vector<Vec3>& moved)
      : mesh_(mesh),
        widening_(widening),
        moved_(moved),
        roots_(roots_of_columns(mesh)),
        turns_(turns_at_roots(mesh, roots_, moved)),
        is_side_(points_of_sides(mesh)),
        column_(columns_on_sides()),
        share_(mesh.points.size(), 1),
        way_(mesh.points.size(), Vec3::Zero()) {}

  std::vector<Vec3> points() const {
    std::vector<Vec3> points = moved_;
    for (Index v = 0; v < points.size(); ++v) {
      if (!is_carried(v)) continue;
      const Index root = roots_[v], column = column_[v];
      const Vec3 rest = share_[column] * widening_[root] * (mesh_.points[v] - mesh_.points[root]);
      points[v] = moved_[root] + (way_[column].isZero() ? turns_[root] * rest : (rest.norm() * way_[column]).eval());
    }
    return points;
  }

  /// Whether faces of the boundary cross that layers do not move.
  bool wall_crosses() const {
    VolumeMesh wall = mesh_;
    wall.points = moved_;
    std::erase_if(wall.boundary, [&](const BoundaryFace& face) {
      return std::any_of(face.corners.begin(), face.corners.end(),
                         [&](Index v) { return v != kNone && is_carried(v); });
    });
    return !points_of_crossing_faces(wall).empty();
  }

  /// Whether points of layers are outside, which their thickness moves.
  bool are_outside() const {
    return std::any_of(mesh_.boundary.begin(), mesh_.boundary.end(),
                       [&](const BoundaryFace& face) { return face.is_triangle() && is_carried(face.corners[0]); });
  }

  /// At these points: first in the direction that sees most of the wall, then thinner. Returns whether there are layers
  /// at any.
  bool make_room(const std::vector<Index>& points) {
    std::vector<char> is_due(share_.size(), 0);
    for (const Index v : points) {
      if (is_carried(v)) is_due[column_[v]] = 1;
    }
    const std::vector<std::vector<Vec3>> fans = fans_of_wall(is_due);
    bool any = false;
    for (Index column = 0; column < is_due.size(); ++column) {
      if (!is_due[column]) continue;
      any = true;
      if (!turn(column, fans[column])) share_[column] *= kThinnerStep;
    }
    if (any) make_gradual();
    return any;
  }

 private:
  bool is_carried(Index v) const { return roots_[v] != v && !is_side_[v]; }

  /// As roots, but of the points of layers on one side of the wall.
  std::vector<Index> columns_on_sides() const {
    DisjointSets columns(mesh_.points.size());
    for_each_column_edge([&](Index v, Index w) { columns.join(v, w); });
    std::vector<Index> column(mesh_.points.size());
    for (Index v = 0; v < column.size(); ++v) column[v] = columns.find(v);
    return column;
  }

  template <class Visit>
  void for_each_column_edge(const Visit& visit) const {
    for (const Wedge& wedge : mesh_.wedges) {
      for (std::size_t i = 0; i < 3; ++i) {
        if (roots_[wedge[i]] != wedge[i] && roots_[wedge[i + 3]] != wedge[i + 3]) visit(wedge[i], wedge[i + 3]);
      }
    }
  }

  // Normals of faces of the wall under these columns, towards them.
  std::vector<std::vector<Vec3>> fans_of_wall(const std::vector<char>& is_due) const {
    std::vector<std::vector<Vec3>> fans(is_due.size());
    for (const Wedge& wedge : mesh_.wedges) {
      for (const std::size_t first : {0, 3}) {
        const Triangle face = {wedge[first], wedge[first + 1], wedge[first + 2]};
        if (std::any_of(face.begin(), face.end(), [&](Index v) { return roots_[v] != v; })) continue;
        // The face with corners 0, 1, 2 looks into its wedge, the other one out of it.
        const Vec3 area = (moved_[face[1]] - moved_[face[0]]).cross(moved_[face[2]] - moved_[face[0]]);
        for (std::size_t i = 0; i < 3; ++i) {
          const Index column = column_[wedge[3 - first + i]];
          if (is_due[column]) fans[column].push_back((first == 0 ? 1 : -1) * area.normalized());
        }
      }
    }
    return fans;
  }

  // Once.
  bool turn(Index column, const std::vector<Vec3>& fan) {
    if (fan.empty() || !way_[column].isZero()) return false;
    const FanDirection best = best_direction(fan);
    if (!(best.least > 0)) return false;
    way_[column] = best.way;
    return true;
  }

  // From column to column of a wedge by one step at most.
  void make_gradual() {
    bool any = true;
    while (any) {
      any = false;
      for (const Wedge& wedge : mesh_.wedges) {
        for (const std::size_t first : {0, 3})
          any = limit_steps({wedge[first], wedge[first + 1], wedge[first + 2]}) || any;
      }
    }
  }

  bool limit_steps(const Triangle& face) {
    if (std::any_of(face.begin(), face.end(), [&](Index v) { return roots_[v] == v; })) return false;
    double least = 1;
    for (const Index v : face) least = std::min(least, share_[column_[v]]);
    bool any = false;
    for (const Index v : face) {
      double& share = share_[column_[v]];
      if (share * kThinnerStep <= least * (1 + 1e-9)) continue;
      share = least / kThinnerStep;
      any = true;
    }
    return any;
  }

  const VolumeMesh& mesh_;
  const std::vector<double>& widening_;
  const std::vector<Vec3>& moved_;
  std::vector<Index> roots_;
  std::vector<Eigen::Quaterniond> turns_;
  std::vector<char> is_side_;  // they must not leave caps
  std::vector<Index> column_;
  std::vector<double> share_;  // of the thickness, at the number of a column
  std::vector<Vec3> way_;      // at the same, zero where columns turn with the wall
};

std::vector<Index> points_of_inverted_cells(const VolumeMesh& mesh) {
  const std::vector<double> jacobian = least_jacobians_mm3(mesh);
  std::vector<Index> points;
  Index c = 0;
  for_each_cell(mesh, [&](const auto& cell) {
    if (!(jacobian[c++] > 0)) points.insert(points.end(), cell.begin(), cell.end());
  });
  return points;
}

/// Moves points of a mesh in which no cell is turned over, so that cells which became flat are less so.
void make_less_flat(VolumeMesh& moved, const std::vector<Vec3>& rest) {
  const std::vector<Vec3> before = moved.points;
  mend_cells(moved, rest);
  if (find_inverted_cells(moved).count > 0) moved.points = before;
}

/// Points at what is wrong with a mesh that layers fill: cells that are turned over, or if there are none, faces
/// outside that cross.
std::vector<Index> points_at_fault(const VolumeMesh& mesh, bool may_cross) {
  std::vector<Index> points = points_of_inverted_cells(mesh);
  if (points.empty() && may_cross) points = points_of_crossing_faces(mesh);
  return points;
}

/// Where points go with layers that make room. The last attempt without a cell turned over, or else `moved`.
std::vector<Vec3> mended_points(const VolumeMesh& mesh, const std::vector<Vec3>& moved, CarriedLayers& layers) {
  VolumeMesh mended = mesh;
  std::vector<Vec3> best = moved;
  for (int attempt = 0; attempt <= kMostThinnings; ++attempt) {
    mended.points = layers.points();
    mend_cells(mended, mesh.points);
    if (find_inverted_cells(mended).count == 0) best = mended.points;
    const std::vector<Index> at_fault = points_at_fault(mended, layers.are_outside());
    if (at_fault.empty() || !layers.make_room(at_fault)) break;
  }
  return best;
}

}  // namespace

std::vector<Vec3> follow_edit(const VolumeMesh& mesh, const Centerline& centerline, const CenterlineEdit& edit) {
  check_volume_mesh(mesh);
  VolumeMesh moved = mesh;
  moved.points = follow_edit_within(mesh.points, centerline, edit);
  const std::vector<double> widening = widening_within(mesh.points, centerline, edit);
  CarriedLayers layers(mesh, widening, moved.points);
  if (find_inverted_cells(moved).count == 0 && points_at_fault(moved, layers.are_outside()).empty()) {
    make_less_flat(moved, mesh.points);
    return std::move(moved.points);
  }
  if (layers.wall_crosses()) return std::move(moved.points);
  return mended_points(mesh, moved.points, layers);
}

}  // namespace vmesh
