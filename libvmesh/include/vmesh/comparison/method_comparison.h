#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/sampled_distance.h"

namespace vmesh {

/// The surfaces of a comparison: those of the paper's Table 2 in its order, that is marching cubes, which is the
/// reference, truncated cones and the paper's two resolutions; then vmesh's presets where they are finer than these,
/// the presets fitted to the reference, the preset low fitted with long triangles, and grown as published.
enum class SurfaceMethod {
  marching_cubes,
  truncated_cones,
  low_resolution,
  high_resolution,
  low_preset,
  high_preset,
  low_fitted,
  high_fitted,
  low_fitted_long,
  paper_growth
};

/// "marching cubes", "truncated cones", "low resolution", "high resolution", "preset low", "preset high",
/// "low, fitted", "high, fitted", "low, fitted, long triangles", "growth as published".
std::string_view to_string(SurfaceMethod method);

/// The distance between a surface and the reference, both ways.
struct ReferenceDistance {
  Hausdorff hausdorff;  ///< forward: from the surface to the reference
  SampledDistance from_surface, from_reference;
};

/// Whether a surface is sound.
struct SurfaceSoundness {
  Topology topology;
  std::size_t self_intersections = 0;  ///< pairs of faces
};

/// The surface of one method and its quality.
struct MethodRow {
  SurfaceMethod method = SurfaceMethod::marching_cubes;
  int around = 0;  ///< vertices around a vessel; 0 for what vmesh did not grow
  TriMesh mesh;
  SkewnessSummary skewness;                   ///< of long triangles, that of metric_skewness()
  std::vector<Vec3> elongation;               ///< of every vertex, see GenerateResult; empty where triangles are even
  std::optional<ReferenceDistance> distance;  ///< none for the reference itself
  std::optional<SurfaceSoundness> soundness;  ///< of what vmesh grew
  std::vector<std::string> warnings;          ///< of its growth
};

struct MethodComparison {
  std::vector<MethodRow> rows;  ///< in the order of SurfaceMethod: the first four, then those requested

  /// The row of one of the first four methods.
  const MethodRow& row(SurfaceMethod method) const { return rows.at(static_cast<std::size_t>(method)); }
};

struct MethodOptions {
  int sides = 18;                 ///< of a truncated cone
  double tolerance = 1e-4;        ///< of the Hausdorff distances, mm
  std::size_t samples = 100'000;  ///< on each surface
  bool fitted = false;            ///< the presets once more, fitted to the reference: both, and low with long triangles
  bool paper_growth = false;      ///< the preset low once more, grown as published
};

/// Makes truncated cones and vmesh's surfaces around `centerline` and measures all of them against `reference`, which
/// becomes the first row. The low resolution is the preset low, unless that has a larger share of the vertices of
/// marching cubes or of the cones than the paper's low resolution; then it is the finest that does not, or 3 vertices
/// around a vessel. Likewise for the high one; the presets themselves then follow as rows of their own. The reference
/// need not be closed. Deterministic. Throws InvalidInput for what truncated_cones(), generate_surface() and
/// hausdorff() refuse; Cancelled.
MethodComparison compare_methods(TriMesh reference, const Centerline& centerline, const MethodOptions& options = {},
                                 const Progress& progress = {});

}  // namespace vmesh
