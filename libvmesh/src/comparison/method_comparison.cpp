#include "vmesh/comparison/method_comparison.h"

#include <algorithm>
#include <limits>

#include "vmesh/comparison/paper_table.h"
#include "vmesh/core/error.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/reference/cones.h"
#include "vmesh/surface/generate.h"
#include "vmesh/surface/metric_skewness.h"

namespace vmesh {
namespace {

constexpr int kFewestAround = 3;

SurfaceMethod resolution_of(Preset preset) {
  return preset == Preset::low ? SurfaceMethod::low_resolution : SurfaceMethod::high_resolution;
}

SurfaceMethod row_of(Preset preset) {
  return preset == Preset::low ? SurfaceMethod::low_preset : SurfaceMethod::high_preset;
}

/// Grows the rows of a comparison.
class Grower {
 public:
  Grower(const Centerline& centerline, MethodComparison& comparison, const Progress& progress)
      : centerline_(centerline), comparison_(comparison), progress_(progress) {}

  /// Adds one of the paper's resolutions; keeps the preset's surface for add_presets() if that was too fine.
  void add_resolution(Preset preset) {
    const SurfaceMethod method = resolution_of(preset);
    const double most = most_vertices(method);
    GenerateOptions options;
    options.around = vertices_around(preset);
    MethodRow row = grow(method, options);
    if (too_fine(row, most)) {
      presets_.push_back(row);
      presets_.back().method = row_of(preset);
    }
    // With this small number of vertices, the centres of faces are far from the wall: splitting them for that would
    // undo the choice.
    options.max_center_distance = 1;
    while (too_fine(row, most)) {
      --options.around;
      row = grow(method, options);
    }
    comparison_.rows.push_back(std::move(row));
  }

  void add_presets() {
    for (MethodRow& row : presets_) comparison_.rows.push_back(std::move(row));
  }

  void add_fitted(SurfaceMethod method, Preset preset, const FitOptions& fit = {}) {
    GenerateOptions options;
    options.around = vertices_around(preset);
    GenerateResult result = generate_surface(centerline_, options, progress_);
    // A surface that crosses itself cannot be fitted; the row then has the surface as grown, and says why.
    std::string refused;
    try {
      fit_surface(result, centerline_, comparison_.rows[0].mesh, fit, progress_);
    } catch (const InvalidInput& error) {
      refused = std::string("not fitted: ") + error.what();
    }
    MethodRow row = row_of_result(method, options, std::move(result));
    if (!refused.empty()) row.warnings.push_back(refused);
    comparison_.rows.push_back(std::move(row));
  }

  void add_paper_growth() {
    GenerateOptions options;
    options.growth = GrowthMethod::paper;
    comparison_.rows.push_back(grow(SurfaceMethod::paper_growth, options));
  }

 private:
  double most_vertices(SurfaceMethod method) const {
    double most = std::numeric_limits<double>::infinity();
    for (const SurfaceMethod of : {SurfaceMethod::marching_cubes, SurfaceMethod::truncated_cones}) {
      const double share =
          static_cast<double>(paper_row(method).vertices) / static_cast<double>(paper_row(of).vertices);
      most = std::min(most, share * static_cast<double>(comparison_.row(of).mesh.vertices.size()));
    }
    return most;
  }

  static bool too_fine(const MethodRow& row, double most) {
    return row.around > kFewestAround && static_cast<double>(row.mesh.vertices.size()) > most;
  }

  MethodRow grow(SurfaceMethod method, const GenerateOptions& options) const {
    return row_of_result(method, options, generate_surface(centerline_, options, progress_));
  }

  static MethodRow row_of_result(SurfaceMethod method, const GenerateOptions& options, GenerateResult result) {
    MethodRow row;
    row.method = method;
    row.around = options.around;
    row.mesh = std::move(result.mesh);
    row.elongation = std::move(result.elongation);
    for (const GrowthWarning& warning : result.warnings) row.warnings.push_back(warning.message);
    for (const Defect& defect : result.defects) row.warnings.push_back("not sound: " + defect.message);
    return row;
  }

  const Centerline& centerline_;
  MethodComparison& comparison_;
  const Progress& progress_;
  std::vector<MethodRow> presets_;
};

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
    case SurfaceMethod::low_preset:
      return "preset low";
    case SurfaceMethod::high_preset:
      return "preset high";
    case SurfaceMethod::low_fitted:
      return "low, fitted";
    case SurfaceMethod::high_fitted:
      return "high, fitted";
    case SurfaceMethod::low_fitted_long:
      return "low, fitted, long triangles";
    case SurfaceMethod::paper_growth:
      return "growth as published";
  }
  return "";
}

MethodComparison compare_methods(TriMesh reference, const Centerline& centerline, const MethodOptions& options,
                                 const Progress& progress) {
  const ClosestPointIndex reference_index(reference);
  MethodComparison comparison;
  comparison.rows.resize(2);
  comparison.rows[0].mesh = std::move(reference);
  comparison.rows[1].method = SurfaceMethod::truncated_cones;
  comparison.rows[1].mesh = truncated_cones(centerline, options.sides).mesh;
  Grower grower(centerline, comparison, progress);
  for (const Preset preset : {Preset::low, Preset::high}) grower.add_resolution(preset);
  grower.add_presets();
  if (options.fitted) {
    grower.add_fitted(SurfaceMethod::low_fitted, Preset::low);
    grower.add_fitted(SurfaceMethod::high_fitted, Preset::high);
    FitOptions long_triangles;
    long_triangles.elongation = kMostElongation;
    grower.add_fitted(SurfaceMethod::low_fitted_long, Preset::low, long_triangles);
  }
  if (options.paper_growth) grower.add_paper_growth();
  for (MethodRow& row : comparison.rows) {
    row.skewness = summarize_skewness(metric_skewness(row.mesh, row.elongation));
    if (row.method == SurfaceMethod::marching_cubes) continue;
    if (row.around > 0) row.soundness = {measure_topology(row.mesh), self_intersections(row.mesh).size()};
    row.distance = measure_distance(row.mesh, comparison.rows[0].mesh, reference_index, options, progress);
  }
  return comparison;
}

}  // namespace vmesh
