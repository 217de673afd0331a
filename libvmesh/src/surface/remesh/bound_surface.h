#pragma once

#include <memory>
#include <optional>

#include <CGAL/Surface_mesh.h>

#include "vmesh/core/types.h"
#include "vmesh/edit/crossing_guard.h"
#include "vmesh/edit/step.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/boundary_point.h"
#include "surface/remesh/elongated_metric.h"

namespace vmesh {

using SurfaceMesh = CGAL::Surface_mesh<Vec3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Edge = SurfaceMesh::Edge_index;
using Face = SurfaceMesh::Face_index;

/// What belongs to a vertex beside its position. When vertices are added or merged, this follows by itself.
struct BoundVertex {
  /// What may happen to it. Edges between two held vertices are kept as well. A lid is the centre of the faces that
  /// close a hole while the surface is worked on; it is never exported.
  enum class Role : char { free, held, lid };

  Vec3 gradient = Vec3::Zero();  ///< outward unit normal of the boundary
  double t = 0;                  ///< parameter on the axis of its cone
  double distance = 0;           ///< signed, to the boundary, mm
  /// Signed distance to the boundary at which the vertex belongs, mm. 0 except in balanced placement.
  double lift = 0;
  /// Factor on the target edge length: 1, or less in narrow places where full-size triangles do not fit.
  double fineness = 1;
  double size = 0;  ///< target edge length, mm, see SweepState
  /// Vector of the metric in which triangles are to be equilateral, see ElongatedMetric; zero where they are even.
  Vec3 elongation = Vec3::Zero();
  /// Share of what the elongation exceeds 1 by that is left to a vertex: less where the limit on the error asks for it.
  double elongation_share = 1;
  Index cone = kNone;  ///< closest round cone; the hint for the next query
  Role role = Role::free;

  /// Of a vertex added between two, bound like `a`.
  static BoundVertex between(const BoundVertex& a, const BoundVertex& b);
  /// Of the vertex that two become, bound like `a`.
  static BoundVertex merged(const BoundVertex& a, const BoundVertex& b);
};

/// A step on a halfedge mesh; the vertex is null_vertex() where one is to be added.
using SurfaceStep = Step<Vertex, Face, BoundaryPoint>;

/// A ball in which edges are no longer than `edge`; around it they may be, the more the farther away.
struct FinePlace {
  Vec3 center = Vec3::Zero();
  double reach = 0, edge = 0;  ///< mm

  bool operator==(const FinePlace&) const = default;
};

/// A surface under construction: a halfedge mesh whose vertices know their place on the centerline.
class BoundSurface {
 public:
  using Role = BoundVertex::Role;

  explicit BoundSurface(const VesselField& vessel_field);
  BoundSurface(const BoundSurface&) = delete;
  BoundSurface& operator=(const BoundSurface&) = delete;

  const VesselField& field;
  /// Around a node of very many branches: many faces lie in pits too narrow for good ones, so that not everything is
  /// tried at each of them.
  bool crowded = false;
  bool has_limit = false;  ///< on the error, which is to be proven
  ErrorLimit refined_to;   ///< what the finished surface is refined to, if set
  SurfaceMesh mesh;

  BoundVertex& operator[](Vertex v) { return vertex_[v]; }
  const BoundVertex& operator[](Vertex v) const { return vertex_[v]; }

  /// Where triangles may be longer than wide. Without (nullptr) they are not. To be set before vertices are placed.
  const ElongationField* elongation_field = nullptr;

  /// The metric of an edge, and of a triangle.
  ElongatedMetric metric(Vertex a, Vertex b) const {
    return ElongatedMetric(0.5 * (vertex_[a].elongation + vertex_[b].elongation));
  }
  ElongatedMetric metric(Vertex a, Vertex b, Vertex c) const {
    return ElongatedMetric((vertex_[a].elongation + vertex_[b].elongation + vertex_[c].elongation) / 3);
  }
  /// Sets the elongation of all vertices to what is allowed where they are bound; graded along the surface.
  void update_elongation();

  struct Spot {
    Vec3 position;
    double radius;
  };
  /// Spots around which edges are as short as on a vessel of that radius; the target length grows with the distance.
  std::vector<Spot> fine_spots;
  /// Where a surface that is refined later must be fine from the beginning.
  std::vector<FinePlace> fine_places;
  /// Balls in which nothing is refined for the error limit.
  std::vector<Spot> calm_spots;

  bool held(Vertex v) const { return vertex_[v].role != Role::free; }
  bool is_lid(Face f) const;

  /// Closes the loop of vertices (counter-clockwise about the outward direction) with a lid at `center`, and holds
  /// them.
  void close_with_lid(const std::vector<Vertex>& loop, const Vec3& center);

  enum class Axes {
    none,   ///< while a surface grows over them
    bound,  ///< of the cones that vertices are bound to
    all     ///< for a surface around all vessels: the shortest cones may have no vertex
  };
  /// From now on only guarded steps are taken (CrossingGuard), which keep these axes inside. The surface has faces.
  void guard_crossings(Axes kept = Axes::bound);
  SurfaceStep moving(Vertex v, const BoundaryPoint& target) const;
  /// Collapses the edge ab; the vertex that is left is called a.
  SurfaceStep collapsing(Vertex a, Vertex b, const BoundaryPoint& target) const;
  /// Its vertex is one of those that become neighbours, and stays.
  SurfaceStep flipping(Halfedge h) const;
  /// At the midpoint.
  SurfaceStep splitting(Edge e) const;

  /// Whether a step is allowed: always, unless guarded.
  bool allows(const SurfaceStep& step) const;
  bool may_place(Vertex v, const Vec3& p) const { return !guard_ || allows(moving(v, {p})); }
  bool may_collapse(Vertex a, Vertex b, const Vec3& p) const { return !guard_ || allows(collapsing(a, b, {p})); }
  bool may_flip(Halfedge h) const { return !guard_ || allows(flipping(h)); }
  /// Splits leave the surface where it is, but for rounding, which turns the halves of a sliver over.
  bool may_split(Edge e) const { return !guard_ || allows(splitting(e)); }
  bool may_split_edge_centric(Face f) const;
  /// The steps that were not.
  RefusedSteps refused() const { return guard_ ? guard_->refused() : RefusedSteps{}; }

  /// Throws std::logic_error unless the surface is closed and 2-manifold (see ExecutionParams). `what` it is.
  void require_closed(const std::string& what) const;

  const Vec3& position(Vertex v) const { return mesh.point(v); }
  std::array<Vertex, 3> corners(Face f) const {
    const Halfedge h = mesh.halfedge(f);
    return {mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))};
  }
  /// The field at the vertex, as of its last placement. The gradient is a unit vector.
  FieldSample sample(Vertex v) const {
    const BoundVertex& at = vertex_[v];
    return {at.distance, at.gradient, at.cone, at.t};
  }
  double radius(Vertex v) const { return field.relations().radius_at(vertex_[v].cone, vertex_[v].t); }

  /// Curvature of the boundary between two neighbours towards the outside, 1/mm: greater than 0 in a valley.
  double valley_curvature(Vertex a, Vertex b) const {
    const Vec3 way = position(b) - position(a);
    return (vertex_[a].gradient - vertex_[b].gradient).dot(way) / way.squaredNorm();
  }

  /// Places `v` at `p`, bound as `sample` says.
  void place(Vertex v, const Vec3& p, const FieldSample& sample);

  /// Places `v` at its lift from the boundary, starting from `p` (project_to_boundary).
  void place_on_boundary(Vertex v, const Vec3& p, Index hint);

  Vec3 face_area_normal(Face f) const;
  Vec3 vertex_normal(Vertex v) const;
  /// Unit, weighted by angles (angle_normal).
  Vec3 middle_normal(Vertex v) const;

  /// Edge-centric split of a face: its edges are halved, it becomes four faces and each neighbour two.
  /// The three new vertices stay at the edges' midpoints.
  std::array<Vertex, 3> split_edge_centric(Face f);

  /// Splits an edge at its midpoint, and both its faces. The new vertex stays there.
  Vertex split_edge(Edge e);

  /// Collapses an edge to a vertex placed at `target`; returns that. Requires the link condition.
  Vertex collapse_edge(Edge e, const BoundaryPoint& target);

  void flip_edge(Halfedge h);

  /// The finished mesh with its binding, without lids. Vertices and faces in the order of the halfedge mesh. Returns
  /// the new number of every vertex by its old index; kNone for removed ones.
  std::vector<Index> export_to(GenerateResult& result) const;

 private:
  Vec3 middle_of(Halfedge h) const { return 0.5 * (mesh.point(mesh.source(h)) + mesh.point(mesh.target(h))); }
  Vertex halve(Halfedge h);
  void touch_faces(Vertex v);
  std::optional<PlacedFace> placed(Face f) const;

  SurfaceMesh::Property_map<Vertex, BoundVertex> vertex_;
  std::unique_ptr<CrossingGuard> guard_;
};

/// Follows the gradient from `p` by Newton steps to the signed distance `lift`, until it is within `tolerance` local
/// radii or no longer comes closer.
BoundaryPoint project_to_boundary(const VesselField& field, const Vec3& p, Index hint, double tolerance = 1e-6,
                                  double lift = 0);

/// The same from a point at which the field is already known.
BoundaryPoint project_to_boundary(const VesselField& field, BoundaryPoint start, double tolerance, double lift);

}  // namespace vmesh
