#pragma once

#include "vmesh/core/progress.h"

#include "surface/junction/disc_cutter.h"
#include "surface/junction/junction_centerline.h"
#include "surface/junction/lattice_growth.h"
#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Lift of a vertex that keeps its present distance from the boundary.
inline constexpr double kAsLaid = std::numeric_limits<double>::infinity();

/// A vertex with the cone it is bound to, which is the hint for its next query.
struct SurfacePoint {
  Vec3 position;
  Index cone;
  double fineness = 1;          ///< factor on the target edge length
  double lift = 0;              ///< signed distance to the boundary at which it belongs, mm; or kAsLaid
  double elongation_share = 1;  ///< see BoundSurface
};

/// Vertices and faces of a surface, whole or in part.
struct SurfacePatch {
  std::vector<SurfacePoint> vertices;
  std::vector<Triangle> faces;
};

/// A junction's surface with a hole for every dock of its bare stretches, in their order.
struct JunctionSurface {
  SurfacePatch patch;
  std::vector<std::vector<Index>> rims;  ///< counter-clockwise about the direction away from the junction
};

/// Grows the surface of a junction from its widest place in a lattice graded to the local radius (grow_in_lattice),
/// moves it onto the boundary, remeshes it to a size field, and cuts it at its docks.
class JunctionGrowth {
 public:
  /// `fine_places`: where the lattice and edges are finer.
  JunctionGrowth(const VesselField& field, const std::vector<BranchAxis>& axes, const GrowthSkeleton& skeleton,
                 const Junction& junction, const GenerateOptions& options,
                 const std::vector<FinePlace>& fine_places = {}, const Progress& progress = {});

  /// The surface at `finer` times the requested resolution. `smooth_rims`: rims are moved onto the boundary and lose
  /// their short edges; otherwise they stay as cut. `guarded`: faces never cross on the way from the lattice to the
  /// boundary.
  JunctionSurface make(double finer, bool smooth_rims, bool guarded) const;

  /// The surface as it comes out of the lattice, closed: before it is brought onto the boundary and cut.
  const LatticeSurface& lattice() const { return lattice_; }

  /// Loops of the centerline that are too short to have a hole.
  std::size_t filled_loops() const { return centerline_.cycle_rank() - lattice_.handles; }
  double length_in_radii() const { return centerline_.length_in_radii(); }
  /// Whether faces are crowded (BoundSurface::crowded).
  bool is_crowded() const;
  const std::vector<FinePlace>& fine_places() const { return fine_places_; }
  /// Resolution, in vertices around a vessel, at which the junction is to be joined to its tubes.
  int docked_around() const { return docked_around_; }

 private:
  GenerateResult onto_boundary(double finer, bool guarded) const;
  CrossSection way_out(const TubeEnd& dock) const;
  // `own`: the vertices bound to the bare stretch.
  std::vector<Index> cut_at_dock(DiscCutter& cutter, const GenerateResult& closed, const std::vector<Index>& own,
                                 Index bare, bool at_end, bool smooth) const;
  std::vector<std::vector<Index>> vertices_by_bare_stretch(const GenerateResult& closed) const;
  Index original_cone(Index cone) const;
  std::vector<Index> vertices_near_end(const GenerateResult& closed, const std::vector<Index>& own, Index bare,
                                       bool at_end, double reach) const;
  void move_onto_boundary(DiscCutter& cutter, const std::vector<Index>& rim, const GenerateResult& closed,
                          double longest) const;

  const VesselField& field_;
  const std::vector<BranchAxis>& axes_;
  const GrowthSkeleton& skeleton_;
  const Junction& junction_;
  const GenerateOptions& options_;
  const std::vector<FinePlace> fine_places_;
  const Progress progress_;
  const int docked_around_;
  JunctionCenterline local_;
  Centerline centerline_;
  VesselField local_field_;
  LatticeSurface lattice_;
};

}  // namespace vmesh
