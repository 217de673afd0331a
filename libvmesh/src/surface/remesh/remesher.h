#pragma once

#include <limits>

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// The operations of a sweep that change connectivity. All keep the surface closed, manifold and oriented; none turns
/// an upright face over.
class Remesher {
 public:
  explicit Remesher(SweepState& state)
      : state_(state), surface_(state.surface), mesh_(state.mesh), field_(state.field) {}

  /// Splits edges, the longest relative to their target first: a chord over a bend must be split before other edges
  /// settle along it.
  void split_long_edges();
  /// Collapses edges much shorter than their target where the faces around stay upright.
  void collapse_short_edges();
  /// Collapses the shortest edge of bad faces that no flip and no move mends, if the result is better.
  void collapse_bad_faces();
  /// The paper's accuracy step: splits faces whose centre is too far from the boundary.
  void split_far_faces(double max_distance);
  /// Flips edges that bridge a crotch or cut through a vessel.
  void repair_strays();
  /// Flips where the two triangles' energy plus `regularity` times the valence defects falls and both stay upright.
  void flip_edges(double regularity);
  /// Flips one edge where that makes the two triangles better.
  bool flip_for_shape(Edge e) { return try_flip(e, 0); }
  /// Flips one edge whatever becomes of the shape, unless a face would turn over or valences get much worse.
  bool flip_with_foresight(Edge e);
  /// Undoes that flip.
  void flip_back(Edge e) { flip(mesh_.halfedge(e)); }

  /// Stops all refinement once the mesh has `count` vertices.
  void limit_vertices(std::size_t count) { max_vertices_ = count; }
  /// Whether something was not refined because of that.
  bool limited() const { return limited_; }

 private:
  bool full() {
    const bool is_full = mesh_.number_of_vertices() >= max_vertices_;
    limited_ = limited_ || is_full;
    return is_full;
  }
  // Folded faces are not refined: it is unclear where their new vertices would belong.
  bool upright(Edge e) const;
  bool held(Edge e) const;
  Vertex split(Edge e);
  // Projects a new vertex; stays at the edge's midpoint when that would fold a face.
  void move_to_boundary(Vertex v);
  bool collapse(Edge e);
  // The largest energy of the faces of `v` without `other` after a move of `v` to `p`.
  double worst_energy(Vertex v, Vertex other, const Vec3& p) const;
  // Whether the faces of `v` without `other` stay upright and no edge becomes too long when `v` moves to target.
  bool collapsible_to(Vertex v, Vertex other, const BoundaryPoint& target) const;
  // How far the edge ab strays from the boundary at its middle, in edge lengths: about length / (8 r) where it
  // follows a vessel round, more where it cuts a corner or bridges a crotch.
  double bulge(Vertex a, Vertex b) const;
  bool can_flip(Halfedge h) const;
  // Whether the faces left and right of ab, with apexes c and d, may be exchanged for those of cd.
  bool flip_stays_upright(Vertex a, Vertex b, Vertex c, Vertex d) const;
  // How much the sum of squared valence defects (valence - 6) of the four vertices falls when ab becomes cd.
  int valence_gain(Vertex a, Vertex b, Vertex c, Vertex d) const;
  // Flips h from a to b, between the apexes c and d, if both triangles stay upright and the new edge does not stray.
  bool flip_if_upright(Halfedge h, Vertex a, Vertex b, Vertex c, Vertex d);
  void flip(Halfedge h);
  bool try_flip(Edge e, double regularity);

  SweepState& state_;
  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const VesselField& field_;
  std::size_t max_vertices_ = std::numeric_limits<std::size_t>::max();
  bool limited_ = false;
};

}  // namespace vmesh
