#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// What a surface may cost, or how accurate it must be: one of the three.
struct Budget {
  enum class Kind { vertices, time, error };
  Kind kind = Kind::vertices;
  std::size_t vertices = 0;  ///< at most
  double seconds = 0;        ///< that generate_surface() takes, at most
  ErrorLimit error;          ///< proven everywhere, as GenerateOptions::max_error
};

/// "vertices=5000", "time=50ms" (or s), "error=0.2mm", "error=5%". Throws InvalidInput for anything else.
Budget parse_budget(std::string_view text);
std::string to_string(const Budget& budget);

/// A choice of options and the resulting surface's figures.
struct OperatingPoint {
  GenerateOptions options;
  std::size_t vertices = 0;
  double seconds = 0;  ///< that generate_surface() took
  SkewnessSummary skewness;
  Deviation error;
  bool within_budget = false;
};

struct BudgetedSurface {
  GenerateResult result;
  std::vector<OperatingPoint> tried;  ///< ascending in GenerateOptions::around and ring_spacing
  std::size_t chosen = 0;             ///< index into `tried`; `result` is its surface
  const OperatingPoint& choice() const { return tried[chosen]; }
  bool met() const { return choice().within_budget; }
};

/// The best operating point within a budget: for vertices or time the finest surface within it, for an error the
/// surface with the fewest vertices. GenerateOptions::around varies, for vertices ring_spacing too, so that few are
/// missing; an error budget also sets max_error; the rest is as in `options`. Neighbours of the choice are tried, too.
/// If nothing is within the budget, the closest is chosen.
///
/// With an elongation above 1 (and not deformable), a surface within a budget of vertices is a much finer one of which
/// all but that number were left out, those that increase the mean error least (GenerateOptions::least_vertices).
///
/// Repeating the chosen options gives the same surface; a time budget may choose differently each time. Throws what
/// generate_surface() throws.
BudgetedSurface generate_within(const Budget& budget, const Centerline& centerline, GenerateOptions options = {},
                                const Progress& progress = {});

}  // namespace vmesh
