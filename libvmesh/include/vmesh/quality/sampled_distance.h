#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/quality/closest_point.h"
#include "vmesh/quality/distribution.h"

namespace vmesh {

/// A point on a face of a mesh.
struct SurfaceSample {
  Vec3 position = Vec3::Zero();
  Index face = kNone;
};

/// `count` points spread evenly over the area of `mesh`: every face gets its share of them to within one, placed by a
/// low-discrepancy sequence (Roberts' R2). Deterministic; in the order of the faces. No points if there is no area.
/// Throws InvalidInput when a face names a vertex that does not exist, or a corner is not finite.
std::vector<SurfaceSample> sample_surface(const TriMesh& mesh, std::size_t count);

/// Area of all faces, mm^2.
double surface_area(const TriMesh& mesh);

/// Distances of samples: area-weighted mean, RMS and percentiles. Their maximum is only a lower bound of the one-sided
/// Hausdorff distance. This and the following run on the threads of the caller's arena (oneTBB); the result does not
/// depend on their number. Throws what sample_surface() throws, and Cancelled.
struct SampledDistance {
  Distribution distance;       ///< mm
  double samples_per_mm2 = 0;  ///< of the area of the sampled surface
};
SampledDistance sample_distance(const TriMesh& from, const ClosestPointIndex& to, std::size_t samples,
                                const Progress& progress = {});

/// Distance of every vertex, mm; NaN for a vertex that has no finite position.
std::vector<double> vertex_distances(const TriMesh& from, const ClosestPointIndex& to);

}  // namespace vmesh
