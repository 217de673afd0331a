#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/sampled_distance.h"

namespace vmesh {

/// The ways to a vessel surface that Table 2 of the paper compares, in its order: marching cubes, which is the
/// reference; truncated cones; vmesh with the presets low and high.
enum class SurfaceMethod { marching_cubes, truncated_cones, low_resolution, high_resolution };

/// "marching cubes", "truncated cones", "low resolution", "high resolution".
std::string_view to_string(SurfaceMethod method);

/// A surface against the reference, both ways.
struct ReferenceDistance {
  Hausdorff hausdorff;  ///< forward: from the surface to the reference
  SampledDistance from_surface, from_reference;
};

/// What one method made and how good it is.
struct MethodRow {
  SurfaceMethod method = SurfaceMethod::marching_cubes;
  TriMesh mesh;
  SkewnessSummary skewness;
  std::optional<ReferenceDistance> distance;  ///< none for the reference itself
};

struct MethodComparison {
  std::array<MethodRow, 4> rows;      ///< in the order of SurfaceMethod
  std::vector<std::string> warnings;  ///< of the methods

  const MethodRow& row(SurfaceMethod method) const { return rows[static_cast<std::size_t>(method)]; }
};

struct MethodOptions {
  int sides = 18;                 ///< of a truncated cone
  double tolerance = 1e-4;        ///< of the Hausdorff distances, mm
  std::size_t samples = 100'000;  ///< on each surface
};

/// Puts truncated cones and the surfaces of both presets around `centerline` and measures all of them against
/// `reference`, which becomes the first row. The reference need not be closed. Deterministic. Throws InvalidInput for
/// what truncated_cones(), generate_surface() and hausdorff() refuse; Cancelled.
MethodComparison compare_methods(TriMesh reference, const Centerline& centerline, const MethodOptions& options = {},
                                 const Progress& progress = {});

}  // namespace vmesh
