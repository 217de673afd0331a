#pragma once

#include <cstddef>
#include <vector>

#include "fit/correspondence.h"
#include "fit/guarded_step.h"

namespace vmesh {

/// Mean of the third power of the distances of the matches around every vertex of a packed surface, its root (mm),
/// smoothed: between a mean and a maximum. Negative where there are no matches.
std::vector<double> errors_around(const FitMesh& surface, const Matches& matches);

/// Of the edges: a chord across a right angle cuts off half of its length. A larger error has other reasons, as a wall
/// that the reference does not have.
inline constexpr double kNotOfSize = 0.4;

struct SizeLimits {
  double step = 1.25;                   ///< most that a size changes by at once
  double finest = 0.4, coarsest = 1.6;  ///< of the sizes that the surface came with
  double grading = 0.4;                 ///< difference of sizes over distance, at most
};

/// Sets the intended sizes so that errors become even at about `vertices` vertices, if that is not 0, else so that they
/// become `error`: an error goes with the square of the edges. Returns how many faces that will take, about.
double set_sizes(FitMesh& surface, const std::vector<double>& errors, std::size_t vertices, double error,
                 const SizeLimits& limits);

/// Splits edges that are too long for their ends' sizes, collapses those that are too short.
void split_edges(FitMesh& surface, const std::vector<char>& frozen);
void collapse_edges(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard);

}  // namespace vmesh
