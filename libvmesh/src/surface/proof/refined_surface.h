#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "vmesh/edit/guarded_edit.h"
#include "vmesh/surface/error_bound.h"

#include "surface/check/error_limit.h"
#include "surface/proof/by_slope.h"
#include "surface/proof/crease.h"
#include "surface/proof/finished_surface.h"
#include "surface/proof/refinement.h"

namespace vmesh {

/// Of the limit: what is farther at the middle of an edge or a face is not worth a proof.
inline constexpr double kWorthAProof = 0.97;
/// Radii, of vertices on the boundary.
inline constexpr double kRefinedTolerance = 1e-3;

/// A surface that is refined: how far it is from the boundary, and the flips and moves that keep its triangles good.
class RefinedSurface {
 public:
  using Step = FinishedMesh::Step;

  /// Keeps references, but for the surface.
  RefinedSurface(const FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal);

  FinishedMesh mesh;
  GuardedEdit<FinishedVertex> edit;
  std::vector<char> held;                        ///< by vertex: on openings, and others that stay
  std::vector<std::optional<Crease>> crease_at;  ///< of every vertex on one
  std::vector<char> at_kink;                     ///< by vertex: stays where the boundary bends sharply
  std::vector<Index> changed;                    ///< faces, by the steps of this pass
  const bool has_creases;

  const Vec3& point(Index v) const { return mesh.position(v); }
  Index cone(Index v) const { return mesh.vertex(v).binding.segment; }
  double limit_at(Index v) const { return shell_at(goal_.limit, mesh.vertex(v).radius); }
  double limit_of(const MeshEdge& e) const { return std::min(limit_at(e.a), limit_at(e.b)); }
  double limit_of(const Triangle& f) const { return std::min({limit_at(f[0]), limit_at(f[1]), limit_at(f[2])}); }
  double length(const MeshEdge& e) const { return (point(e.a) - point(e.b)).norm(); }
  static std::array<MeshEdge, 3> edges_of(const Triangle& f) {
    return {MeshEdge{f[0], f[1]}, MeshEdge{f[1], f[2]}, MeshEdge{f[2], f[0]}};
  }

  /// Decides what is tried, not what is proven: single precision will do. Not at creases, where the cones of two walls
  /// are equally near, and which of them is taken decides how much is tried in vain.
  FieldSample rough_sample(const Vec3& p, Index hint) const {
    return has_creases ? field_.sample(p, hint) : field_.sample_fast(p, hint);
  }

  /// How far a point is off the boundary, mm.
  double off_at(const Vec3& p, Index hint) const { return std::abs(distance_by_slope(rough_sample(p, hint))); }
  /// At the middle of an edge, by its limit.
  double off_at(const MeshEdge& e) const { return off_at(middle_of(e), cone(e.a)) / limit_of(e); }
  bool is_balanced() const { return goal_.placement == Placement::balanced; }
  double lift_of(Index v) const { return distance_by_slope(field_.sample(point(v), cone(v))); }
  Vec3 middle_of(const MeshEdge& e) const { return 0.5 * (point(e.a) + point(e.b)); }

  /// The point on the way from p to a target, no farther than `most`.
  BoundaryPoint towards(const BoundaryPoint& target, const Vec3& p, double most) const {
    const Vec3 way = target.position - p;
    const Vec3 at = p + std::min(1.0, most / way.norm()) * way;
    return {at, field_.sample(at, target.sample.cone)};
  }

  /// Takes the best of these steps, if it leaves no skewness above `worst`. Returns the vertex that it placed, or any
  /// corner of what it changed; kNone: no step was taken.
  Index take(const std::vector<Step>& steps, double worst);
  /// Notes that a vertex has new faces.
  void note_faces_around(Index v);
  /// Whether no face of the step turns over: the cosines of their normals with the gradient are more than `least`.
  bool stays_upright(const Step& step, double least) const;

  /// Flips edges and moves vertices of the faces that have changed. Adds all that change to `due`, ascending.
  void improve(std::vector<Index>& due);

 private:
  std::vector<MeshEdge> edges_of(const std::vector<Index>& faces) const;
  void flip(const MeshEdge& e);
  void move(Index v);
  int irregularity_after(const MeshEdge& e, Index c, Index d) const;
  double worst_skewness(const Step& step) const;
  double worst_now(const Step& step) const;
  double energy(const Step& step) const;
  bool is_at_crease(Index v) const;
  double off_around(Index v) const { return off_around(v, point(v)); }
  double off_around(Index v, const Vec3& p) const;

  const VesselField& field_;
  const RefinementGoal& goal_;
  const RefinementWay& way_;
};

}  // namespace vmesh
