#pragma once

#include <memory>

#include <CGAL/Surface_mesh.h>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/crossing_guard.h"
#include "surface/remesh/elongated_metric.h"

namespace vmesh {

using SurfaceMesh = CGAL::Surface_mesh<Vec3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Edge = SurfaceMesh::Edge_index;
using Face = SurfaceMesh::Face_index;

/// A surface under construction: a halfedge mesh whose vertices know their place on the centerline.
class BoundSurface {
 public:
  explicit BoundSurface(const VesselField& vessel_field);
  BoundSurface(const BoundSurface&) = delete;
  BoundSurface& operator=(const BoundSurface&) = delete;

  const VesselField& field;
  SurfaceMesh mesh;
  SurfaceMesh::Property_map<Vertex, Index> cone;     ///< closest round cone; the hint for the next query
  SurfaceMesh::Property_map<Vertex, double> t;       ///< parameter on its axis
  SurfaceMesh::Property_map<Vertex, Vec3> gradient;  ///< outward normal of the boundary

  SurfaceMesh::Property_map<Vertex, double> distance;  ///< signed distance to the boundary, mm

  /// Signed distance to the boundary at which the vertex belongs, mm. 0 except in balanced placement.
  SurfaceMesh::Property_map<Vertex, double> lift;

  /// Factor on the target edge length: 1, or less in narrow places where full-size triangles do not fit.
  SurfaceMesh::Property_map<Vertex, double> fineness;

  /// Where triangles may be longer than wide. Without (nullptr) they are not. To be set before vertices are placed.
  const ElongationField* elongation_field = nullptr;
  /// Vector of the metric in which triangles are to be equilateral, see ElongatedMetric; zero where they are even.
  SurfaceMesh::Property_map<Vertex, Vec3> elongation;
  /// Share of what the elongation exceeds 1 by that is left to a vertex: less where the limit on the error asks for it.
  SurfaceMesh::Property_map<Vertex, double> elongation_share;

  /// The metric of an edge, and of a triangle.
  ElongatedMetric metric(Vertex a, Vertex b) const { return ElongatedMetric(0.5 * (elongation[a] + elongation[b])); }
  ElongatedMetric metric(Vertex a, Vertex b, Vertex c) const {
    return ElongatedMetric((elongation[a] + elongation[b] + elongation[c]) / 3);
  }
  /// Sets the elongation of all vertices to what is allowed where they are bound; graded along the surface.
  void update_elongation();

  struct Spot {
    Vec3 position;
    double radius;
  };
  /// Spots around which edges are as short as on a vessel of that radius; the target length grows with the distance.
  std::vector<Spot> fine_spots;
  /// Balls in which nothing is refined for the error limit.
  std::vector<Spot> calm_spots;

  /// What may happen to a vertex. Edges between two held vertices are kept as well. A lid is the centre of the faces
  /// that close a hole while the surface is worked on; it is never exported.
  enum class Role : char { free, held, lid };
  SurfaceMesh::Property_map<Vertex, Role> role;
  bool held(Vertex v) const { return role[v] != Role::free; }
  bool is_lid(Face f) const;

  /// Closes the loop of vertices (counter-clockwise about the outward direction) with a lid at `center`, and holds
  /// them.
  void close_with_lid(const std::vector<Vertex>& loop, const Vec3& center);

  enum class Axes {
    bound,  ///< of the cones that vertices are bound to
    all     ///< for a surface around all vessels: the shortest cones may have no vertex
  };
  /// From now on only guarded steps are taken (CrossingGuard), which keep these axes inside.
  void guard_crossings(Axes kept = Axes::bound);
  /// Whether the steps are allowed: always, unless guarded.
  bool may_place(Vertex v, const Vec3& p) const { return !guard_ || guard_->may_move(v, p); }
  bool may_collapse(Vertex a, Vertex b, const Vec3& p) const { return !guard_ || guard_->may_collapse(a, b, p); }
  bool may_flip(Halfedge h) const { return !guard_ || guard_->may_flip(h); }
  /// Tells the guard that the faces around `v` are new.
  void touch_faces(Vertex v) {
    if (guard_) guard_->touch(v);
  }

  const Vec3& position(Vertex v) const { return mesh.point(v); }
  /// The field at the vertex, as of its last placement. The gradient is a unit vector.
  FieldSample sample(Vertex v) const { return {distance[v], gradient[v], cone[v], t[v]}; }
  double radius(Vertex v) const { return field.radius_at(cone[v], t[v]); }

  /// Places `v` at `p`, bound as `sample` says.
  void place(Vertex v, const Vec3& p, const FieldSample& sample);

  /// Places `v` at its lift from the boundary, starting from `p` (project_to_boundary).
  void place_on_boundary(Vertex v, const Vec3& p, Index hint);

  Vec3 face_area_normal(Face f) const;
  Vec3 vertex_normal(Vertex v) const;

  /// Edge-centric split of a face: its edges are halved, it becomes four faces and each neighbour two.
  /// The three new vertices are bound like one of their edge's ends and stay at the edges' midpoints.
  std::array<Vertex, 3> split_edge_centric(Face f);

  /// Splits an edge at its midpoint, and both its faces. The new vertex lies at the midpoint, bound like an end of the
  /// edge.
  Vertex split_edge(Edge e);

  /// The finished mesh with its binding, without lids. Vertices and faces in the order of the halfedge mesh. Returns
  /// the new number of every vertex by its old index; kNone for removed ones.
  std::vector<Index> export_to(GenerateResult& result) const;

 private:
  Vertex halve(Halfedge h);

  std::unique_ptr<CrossingGuard> guard_;
};

/// A point and what the field says about it.
struct BoundaryPoint {
  Vec3 position;
  FieldSample sample;
};

/// Follows the gradient from `p` by Newton steps to the signed distance `lift`, until it is within `tolerance` local
/// radii or no longer comes closer.
BoundaryPoint project_to_boundary(const VesselField& field, const Vec3& p, Index hint, double tolerance = 1e-6,
                                  double lift = 0);

/// The same from a point at which the field is already known.
BoundaryPoint project_to_boundary(const VesselField& field, BoundaryPoint start, double tolerance, double lift);

}  // namespace vmesh
