#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// A surface in a trade-off of time and vertices against accuracy. Errors are distances from the plain union of the
/// centerline's round cones, both ways: means over both surfaces, the larger maximum. All errors are sampled.
struct TradeoffPoint {
  std::string curve;    ///< what made it and what varies: "around", "marching cubes", ...
  std::string setting;  ///< the option or number that varies
  double seconds = 0;   ///< to make the surface, from the centerline on: the median of a few runs if they are short
  std::size_t vertices = 0;
  double skewness_mean = 0, skewness_max = 0;
  double error_mean_mm = 0, error_rms_mm = 0, error_max_mm = 0;
  double error_mean_relative = 0, error_rms_relative = 0, error_max_relative = 0;  ///< in local vessel radii
  bool sound = false;              ///< closed, manifold, facing outwards, without intersections
  bool best_for_time = false;      ///< no other point has a smaller mean error in no more time ...
  bool best_for_vertices = false;  ///< ... or with no more vertices
};

struct TradeoffOptions {
  GenerateOptions generate;  ///< options that do not vary on a curve
  bool beta = true, resolution = true, max_error = true, blend = true, effort = true;  ///< curves of vmesh
  bool fine = false;              ///< also up to 96 around, limits down to .25 % and finer voxels; many times as long
  bool marching_cubes = true;     ///< at several voxel sizes, and decimated
  bool cones = true;              ///< truncated cones
  std::size_t samples = 100'000;  ///< on each surface
};

/// Makes the surfaces of every curve and measures them. Times depend on the machine and its load. Throws what
/// generate_surface() throws. Reports one progress over all of them.
std::vector<TradeoffPoint> sweep_tradeoff(const Centerline& centerline, const TradeoffOptions& options = {},
                                          const Progress& progress = {});

/// Fills in the measurements, `sound` included, of a surface from another source.
void measure_tradeoff_point(TradeoffPoint& point, const TriMesh& mesh, const Centerline& centerline,
                            std::size_t samples = 100'000);

/// Marks the points on the Pareto fronts (best_for_time, best_for_vertices).
void mark_best(std::vector<TradeoffPoint>& points);

/// Mean error against time and against vertices, as an SVG image. Points with a mean error of more than half a radius,
/// which do not represent the vessels, are left out.
std::string plot_tradeoff(const std::vector<TradeoffPoint>& points);

/// A point of one curve compared with the other curve at the same number of vertices or the same maximum error,
/// interpolated between its points on logarithmic scales. NaN beyond its ends.
struct CurveComparison {
  TradeoffPoint theirs;
  double our_error_mean_mm = 0;  ///< at as many vertices
  double our_skewness_mean = 0;  ///< at as many vertices
  double our_vertices = 0;       ///< at the same maximum error
};
std::vector<CurveComparison> compare_curves(const std::vector<TradeoffPoint>& points, const std::string& ours,
                                            const std::string& theirs);

}  // namespace vmesh
