#include "vmesh/comparison/paper_table.h"

namespace vmesh {
namespace {

constexpr const char* kOfMarchingCubes = "vertices / those of marching cubes";
constexpr const char* kOfCones = "vertices / those of truncated cones";
constexpr const char* kMeanSkewness = "mean skewness";
constexpr const char* kMaxSkewness = "maximum skewness";

double ratio(std::size_t a, std::size_t b) { return static_cast<double>(a) / static_cast<double>(b); }

double vertex_share(const MethodComparison& comparison, SurfaceMethod method, SurfaceMethod of) {
  return ratio(comparison.row(method).mesh.vertices.size(), comparison.row(of).mesh.vertices.size());
}

double paper_share(SurfaceMethod method, SurfaceMethod of) {
  return ratio(paper_row(method).vertices, paper_row(of).vertices);
}

void add_shares(const MethodComparison& comparison, SurfaceMethod method, std::vector<PaperFigure>& figures) {
  using enum SurfaceMethod;
  for (const auto& [of, what] : {std::pair{marching_cubes, kOfMarchingCubes}, std::pair{truncated_cones, kOfCones}})
    figures.push_back({method, what, vertex_share(comparison, method, of), paper_share(method, of)});
}

}  // namespace

const PaperRow& paper_row(SurfaceMethod method) {
  static const PaperRow rows[] = {{89'406, 178'712, 0.48, 0.90, std::nullopt},
                                  {58'070, 119'430, 0.50, 0.99, 7.24},
                                  {11'571, 23'138, 0.23, 0.70, 7.67},
                                  {51'979, 103'952, 0.17, 0.98, 7.08}};
  return rows[static_cast<std::size_t>(method)];
}

std::vector<PaperFigure> compare_with_paper(const MethodComparison& comparison) {
  using enum SurfaceMethod;
  std::vector<PaperFigure> figures;
  for (const MethodRow& row : comparison.rows) {
    if (row.method > high_resolution) break;
    const PaperRow& paper = paper_row(row.method);
    if (row.method == low_resolution || row.method == high_resolution) add_shares(comparison, row.method, figures);
    figures.push_back({row.method, kMeanSkewness, row.skewness.mean, paper.skewness_mean});
    figures.push_back({row.method, kMaxSkewness, row.skewness.max, paper.skewness_max});
    if (row.distance && paper.hausdorff_mm)
      figures.push_back({row.method, "Hausdorff distance, mm, of other vessels", row.distance->hausdorff.upper(),
                         *paper.hausdorff_mm});
  }
  return figures;
}

std::vector<TableDemand> check_demands(const MethodComparison& comparison) {
  using enum SurfaceMethod;
  const MethodRow& low = comparison.row(low_resolution);
  const Hausdorff& ours = low.distance.value().hausdorff;
  const Hausdorff& cones = comparison.row(truncated_cones).distance.value().hausdorff;
  return {{kOfMarchingCubes, vertex_share(comparison, low_resolution, marching_cubes), 0.13},
          {kOfCones, vertex_share(comparison, low_resolution, truncated_cones), 0.20},
          {kMeanSkewness, low.skewness.mean, 0.12, true},
          {kMaxSkewness, low.skewness.max, 0.5, true},
          {"Hausdorff distance, mm; limit: that of truncated cones", ours.upper(), cones.lower()},
          {"the same from the reference only", ours.backward.upper, cones.backward.lower}};
}

}  // namespace vmesh
