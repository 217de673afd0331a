#pragma once

#include "surface/docking.h"
#include "surface/growth_skeleton.h"
#include "surface/lattice_growth.h"

namespace vmesh {

/// A vertex with the cone it is bound to, the hint of its next query.
struct SurfacePoint {
  Vec3 position;
  Index cone;
  double fineness = 1;  ///< factor on the target edge length
  double lift = 0;      ///< signed distance to the boundary at which it belongs, mm
};

/// A piece of surface.
struct SurfacePatch {
  std::vector<SurfacePoint> vertices;
  std::vector<Triangle> faces;
};

/// A junction's surface with a hole for every opening of its gaps, in their order.
struct JunctionSurface {
  SurfacePatch patch;
  std::vector<std::vector<Index>> rims;  ///< counter-clockwise about the direction away from the junction
};

/// The part of a centerline that belongs to a junction, cut at its openings. Segments know the place they come from.
struct JunctionCenterline {
  struct Origin {
    Index gap;
    double begin, end;  // places
  };

  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Origin> origins;  // of the segments
};

/// Grows the surface of a junction from its widest place, in a lattice as fine as its thinnest vessel
/// (grow_in_lattice), brings it onto the boundary and to a size field, and cuts its openings.
class JunctionGrowth {
 public:
  JunctionGrowth(const VesselField& field, const std::vector<BranchAxis>& axes, const GrowthSkeleton& skeleton,
                 const Junction& junction, const GenerateOptions& options);

  /// The surface, made at `finer` times the resolution asked for; with rims moved onto the boundary and rid of short
  /// edges, or as they were cut.
  JunctionSurface make(double finer, bool smooth_rims) const;

  /// Loops of the centerline that the junction closes itself.
  std::size_t handles() const { return lattice_.handles; }
  /// Loops that are too short to have a hole.
  std::size_t filled_loops() const { return centerline_.cycle_rank() - lattice_.handles; }
  double length_in_radii() const { return centerline_.length_in_radii(); }

 private:
  GenerateResult onto_boundary(double finer) const;
  Index original_cone(Index cone) const;
  std::vector<Index> vertices_near_end(const GenerateResult& piece, Index gap, bool at_end, double reach) const;
  void move_onto_boundary(DiscCutter& cutter, const std::vector<Index>& rim, const GenerateResult& piece,
                          double longest) const;

  const VesselField& field_;
  const std::vector<BranchAxis>& axes_;
  const GrowthSkeleton& skeleton_;
  const Junction& junction_;
  const GenerateOptions& options_;
  JunctionCenterline local_;
  Centerline centerline_;
  VesselField local_field_;
  LatticeSurface lattice_;
};

}  // namespace vmesh
