#pragma once

#include <cstddef>
#include <vector>

#include "fit/correspondence.h"
#include "fit/guarded_step.h"

namespace vmesh::fitting {

/// Cubic mean (mm) of the distances of the matches around every vertex of a packed surface, smoothed: between a mean
/// and a maximum. Negative where there are no matches.
std::vector<double> errors_around(const FitMesh& surface, const Matches& matches);

/// Of the edges: a chord across a right angle cuts off half of its length. A larger error has other causes, such as a
/// wall that the reference lacks.
inline constexpr double kNotOfSize = 0.4;

struct SizeLimits {
  double step = 1.25;                   ///< largest factor by which a size changes at once
  double finest = 0.4, coarsest = 1.6;  ///< relative to the sizes of the given surface
  double grading = 0.4;                 ///< largest difference of sizes over distance
};

/// Sets the intended sizes: for the least sum of squared errors with about `vertices` vertices if that is not 0, else
/// so that errors become `error` everywhere. Errors are proportional to the square of the edges. Returns the
/// approximate number of faces.
double set_sizes(FitMesh& surface, const std::vector<double>& errors, std::size_t vertices, double error,
                 const SizeLimits& limits);

/// Splits edges that are too long for their ends' sizes, collapses those that are too short.
void split_edges(FitMesh& surface, const std::vector<char>& frozen);
void collapse_edges(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard);

}  // namespace vmesh::fitting
