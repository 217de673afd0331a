#include "vmesh/surface/generate.h"

#include <chrono>
#include <optional>

#include "vmesh/core/error.h"

#include "surface/bound_surface.h"
#include "surface/optimize.h"
#include "surface/paper_growth.h"

namespace vmesh {
namespace {

class StageClock {
 public:
  explicit StageClock(std::vector<StageTime>& stages) : stages_(stages) {}

  template <class Work>
  void time(std::string stage, Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    stages_.push_back(
        {std::move(stage), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
  }

 private:
  std::vector<StageTime>& stages_;
};

void check_options(const GenerateOptions& o) {
  if (!(o.beta >= 0 && o.beta <= 1)) throw InvalidInput("beta must be in [0, 1]");
  if (!(o.around >= 3 && o.around <= 200)) throw InvalidInput("around must be in [3, 200]");
  if (!(o.max_center_distance > 0)) throw InvalidInput("max_center_distance must be > 0");
  if (o.sweeps < 0) throw InvalidInput("sweeps must be >= 0");
}

void add_warnings(const PaperGrowthReport& growth, std::vector<std::string>& warnings) {
  if (growth.refused > 0) {
    warnings.push_back(
        "growth: " + std::to_string(growth.refused) +
        " faces were crossed by the centerline behind its front, or too often, and left alone; branch nodes crowd "
        "there, expect overlapping faces");
  }
  if (growth.unclosed > 0) {
    warnings.push_back("growth: " + std::to_string(growth.unclosed) +
                       " segments close a loop, which a single seed cannot do; the surface is open there");
  }
  if (growth.forced > 0) {
    warnings.push_back("growth: " + std::to_string(growth.forced) +
                       " vertices did not reach the boundary by themselves and were projected");
  }
}

}  // namespace

GenerateResult generate_surface(const Centerline& centerline, const GenerateOptions& options,
                                const Progress& progress) {
  check_options(options);
  GenerateResult result;
  StageClock clock(result.stages);
  std::optional<VesselField> field;
  clock.time("volume", [&] { field.emplace(centerline, options.blend); });
  BoundSurface surface(*field);
  clock.time("grow", [&] { add_warnings(grow_from_single_seeds(surface, options.beta, progress), result.warnings); });
  clock.time("optimize", [&] {
    if (options.sweeps > 0) optimize(surface, options, progress);
  });
  surface.export_to(result);
  return result;
}

}  // namespace vmesh
