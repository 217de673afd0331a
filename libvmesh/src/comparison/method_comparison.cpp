#include "vmesh/comparison/method_comparison.h"

#include "vmesh/reference/cones.h"
#include "vmesh/surface/generate.h"

namespace vmesh {
namespace {

TriMesh grow(const Centerline& centerline, Preset preset, std::vector<std::string>& warnings,
             const Progress& progress) {
  GenerateOptions options;
  options.around = vertices_around(preset);
  GenerateResult result = generate_surface(centerline, options, progress);
  const SurfaceMethod method = preset == Preset::low ? SurfaceMethod::low_resolution : SurfaceMethod::high_resolution;
  for (const std::string& warning : result.warnings)
    warnings.push_back(std::string(to_string(method)).append(": ").append(warning));
  return std::move(result.mesh);
}

ReferenceDistance measure_distance(const TriMesh& surface, const TriMesh& reference,
                                   const ClosestPointIndex& reference_index, const MethodOptions& options,
                                   const Progress& progress) {
  ReferenceDistance distance;
  distance.hausdorff = hausdorff(surface, reference, {options.tolerance, progress});
  distance.from_surface = sample_distance(surface, reference_index, options.samples, progress);
  distance.from_reference = sample_distance(reference, ClosestPointIndex(surface), options.samples, progress);
  return distance;
}

}  // namespace

std::string_view to_string(SurfaceMethod method) {
  switch (method) {
    case SurfaceMethod::marching_cubes:
      return "marching cubes";
    case SurfaceMethod::truncated_cones:
      return "truncated cones";
    case SurfaceMethod::low_resolution:
      return "low resolution";
    case SurfaceMethod::high_resolution:
      return "high resolution";
  }
  return "";
}

MethodComparison compare_methods(TriMesh reference, const Centerline& centerline, const MethodOptions& options,
                                 const Progress& progress) {
  using Method = SurfaceMethod;
  MethodComparison comparison;
  const ClosestPointIndex reference_index(reference);
  std::array meshes = {TriMesh(), truncated_cones(centerline, options.sides).mesh,
                       grow(centerline, Preset::low, comparison.warnings, progress),
                       grow(centerline, Preset::high, comparison.warnings, progress)};
  meshes[0] = std::move(reference);
  for (const Method method :
       {Method::marching_cubes, Method::truncated_cones, Method::low_resolution, Method::high_resolution}) {
    const TriMesh& mesh = meshes[static_cast<std::size_t>(method)];
    MethodRow& row = comparison.rows[static_cast<std::size_t>(method)];
    row.method = method;
    row.skewness = summarize_skewness(mesh);
    if (method != Method::marching_cubes)
      row.distance = measure_distance(mesh, meshes[0], reference_index, options, progress);
  }
  for (std::size_t m = 0; m < meshes.size(); ++m) comparison.rows[m].mesh = std::move(meshes[m]);
  return comparison;
}

}  // namespace vmesh
