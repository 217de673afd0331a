#include "vmesh/mesh/polygon_triangulation.h"

#include <algorithm>
#include <cmath>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<bool, Kernel>>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_tag>;
using FaceHandle = Triangulation::Face_handle;

std::vector<Triangle> fan(std::size_t count) {
  std::vector<Triangle> faces;
  for (Index i = 2; i < count; ++i) faces.push_back({0, i - 1, i});
  return faces;
}

/// The projection along the polygon's normal, counter-clockwise. Empty if there is no normal.
std::vector<Point2> projection(std::span<const Vec3> corners) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  if (!(normal.norm() > 0) || !std::isfinite(normal.norm())) return {};
  normal.normalize();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Point2> points;
  for (const Vec3& p : corners) points.emplace_back(u.dot(p - corners[0]), v.dot(p - corners[0]));
  return points;
}

/// The faces on the inner side of the polygon's edges. Empty if their number is not the expected one.
std::vector<Triangle> inner_faces(Triangulation& triangulation, std::size_t count) {
  for (const FaceHandle face : triangulation.all_face_handles()) face->info() = false;
  std::vector<FaceHandle> front;
  const auto take = [&](FaceHandle face) {
    if (face->info() || triangulation.is_infinite(face)) return;
    face->info() = true;
    front.push_back(face);
  };
  const auto follows = [&](Index a, Index b) { return b == a + 1 || (b == 0 && a + 1 == count); };
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    for (int i = 0; i < 3; ++i) {
      const Index a = face->vertex(Triangulation::ccw(i))->info(), b = face->vertex(Triangulation::cw(i))->info();
      if (face->is_constrained(i) && follows(a, b)) take(face);
    }
  }
  std::vector<Triangle> faces;
  while (!front.empty()) {
    const FaceHandle face = front.back();
    front.pop_back();
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      triangle[static_cast<std::size_t>(i)] = face->vertex(i)->info();
      if (!face->is_constrained(i)) take(face->neighbor(i));
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    faces.push_back(triangle);
  }
  if (faces.size() + 2 != count) return {};
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace

std::vector<Triangle> triangulate_polygon(std::span<const Vec3> corners) {
  if (corners.size() <= 3) return fan(corners.size());
  const std::vector<Point2> points = projection(corners);
  if (points.empty() || !CGAL::is_simple_2(points.begin(), points.end(), Kernel())) return fan(corners.size());
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> vertices;
  for (Index i = 0; i < points.size(); ++i) {
    vertices.push_back(triangulation.insert(points[i], i == 0 ? FaceHandle() : vertices.back()->face()));
    vertices.back()->info() = i;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i)
    triangulation.insert_constraint(vertices[i], vertices[(i + 1) % vertices.size()]);
  const std::vector<Triangle> faces = inner_faces(triangulation, corners.size());
  return faces.empty() ? fan(corners.size()) : faces;
}

}  // namespace vmesh
