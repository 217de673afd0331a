#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

struct OptimizeReport {
  bool hopeless = false;       ///< very many tangles in a fine surface: nothing will mend them
  bool crosses = false;        ///< faces intersect at the end, including those of vessels that are not neighbours
  std::size_t tangles = 0;     ///< vertices where faces still intersect within the volume's own neighbourhood
  bool limited = false;        ///< refinement stopped at the bound on the number of vertices
  std::vector<Face> unproven;  ///< faces for which options.max_error is not proven
};

/// The number of vertices that the size field leads to, as expected_vertices() of a centerline.
double expected_vertices(double length_in_radii, double around);

/// Resolution, in vertices around a vessel, at which any grown mesh becomes even.
constexpr double kGrownAround = 6;  // safe 4.2 to 8.4

/// What optimisation starts from.
struct GrownMesh {
  /// grown: as growth leaves it. piece: the same for a single piece. assembled: joined from optimised surfaces.
  enum class Stage { grown, piece, assembled };

  double around;             ///< its resolution, in vertices around a vessel
  double expected_vertices;  ///< at the resolution asked for
  Stage stage = Stage::grown;
  bool to_be_proven = false;  ///< an error limit is to be proven, now or later
};

/// Turns a grown surface into a good one: edges are split, collapsed and flipped towards a size field proportional to
/// the local radius and towards regular valence, faces whose centre is too far from the boundary are split
/// edge-centrically, vertices move in their tangent plane to where their triangles' shape energy is least and are
/// reprojected. A surface that is whole is finished then: vertices are lifted off the boundary for balanced placement,
/// the worst triangles mended, and places refined where the limit on the error is not proven. Topology is kept. The
/// number of vertices is bounded, since folded surfaces could be refined for ever. Uses around, max_center_distance,
/// placement, max_error and sweeps of the options. Goes from the resolution of the grown mesh to the requested one in
/// steps of at most a factor of two: an even mesh is refined or coarsened safely, a grown one is not.
OptimizeReport optimize(BoundSurface& surface, const GenerateOptions& options, const GrownMesh& grown,
                        const Progress& progress);

}  // namespace vmesh
