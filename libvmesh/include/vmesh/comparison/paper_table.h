#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "vmesh/comparison/method_comparison.h"

namespace vmesh {

/// A row of Table 2 as printed in the paper. The paper's liver was not published: its millimetres are those of other
/// vessels.
struct PaperRow {
  std::size_t vertices = 0, faces = 0;
  double skewness_mean = 0, skewness_max = 0;
  std::optional<double> hausdorff_mm;  ///< none for marching cubes, its reference
};
/// The row of one of the first four methods; the presets are not in the paper.
const PaperRow& paper_row(SurfaceMethod method);

/// One of our figures beside the paper's. For all of them, less is better.
struct PaperFigure {
  SurfaceMethod method = SurfaceMethod::marching_cubes;
  std::string_view what;
  double ours = 0;   ///< for a Hausdorff distance, the upper bound
  double paper = 0;  ///< as printed; for a share, from the printed counts
  bool worse() const { return ours > paper; }
};

/// For every row in the paper: mean and maximum skewness and Hausdorff distance; for vmesh's surfaces also the number
/// of vertices as a share of those of marching cubes and of truncated cones.
std::vector<PaperFigure> compare_with_paper(const MethodComparison& comparison);

/// A requirement for the low-resolution surface.
struct TableDemand {
  std::string_view what;
  double found = 0;
  double limit = 0;
  bool below = false;  ///< `found` must be less than the limit; otherwise it may equal it
  bool met() const { return below ? found < limit : found <= limit; }
};

/// At most 13 % of the vertices of marching cubes and 20 % of those of the cones, as the paper states; mean skewness
/// below 0.12, maximum below 0.5; Hausdorff distance no larger than that of the cones, whose lower bound is the limit
/// for our upper bound: both ways together, and from the reference alone, where it does not count that cones have walls
/// within the vessel.
std::vector<TableDemand> check_demands(const MethodComparison& comparison);

}  // namespace vmesh
