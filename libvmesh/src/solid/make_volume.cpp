#include "vmesh/solid/make_volume.h"

#include <cmath>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

#include "solid/core.h"
#include "solid/layer_stack.h"
#include "solid/volume_assembly.h"
#include "solid/wall_frame.h"

namespace vmesh {
namespace {

constexpr double kLeastGrowth = 0.5, kMostGrowth = 5;

void check_layers(const LayerOptions& options, const std::string& what) {
  if (options.count < 0 || options.count > kMostLayers)
    throw InvalidInput(what + ": their number must be from 0 to " + std::to_string(kMostLayers));
  if (options.count == 0) return;
  if (!(options.growth >= kLeastGrowth && options.growth <= kMostGrowth))
    throw InvalidInput(what + formatted(": their growth must be from %g to %g", kLeastGrowth, kMostGrowth));
  if (!(options.first_mm >= 0 && std::isfinite(options.first_mm)))
    throw InvalidInput(what + ": the thickness of the first must be positive");
  if (!(options.first_mm > 0 || (options.thickness > 0 && std::isfinite(options.thickness))))
    throw InvalidInput(what + ": their thickness must be positive");
}

void check_options(const VolumeOptions& options) {
  check_layers(options.layers, "layers");
  check_layers(options.shell, "layers of the shell");
  if (options.shell_only && options.shell.count == 0) throw InvalidInput("a shell alone needs a layer at least");
  if (!(options.core_size >= 0 && std::isfinite(options.core_size)))
    throw InvalidInput("the size of cells in the core must be positive");
  if (!options.shell_only && !can_mesh_lumen()) fill_core({});  // throws
}

class VolumeMaker {
 public:
  VolumeMaker(const VesselWall& wall, const VolumeOptions& options, const Progress& progress)
      : wall_(wall), options_(options), progress_(progress), frame_(frame_of(wall)) {
    parts_.wall = &wall_;
    parts_.frame = &frame_;
    parts_.with_lumen = !options.shell_only;
    lap("surface");
  }

  VolumeResult run() {
    if (parts_.with_lumen) parts_.layers = lay(options_.layers, LayerSide::inside, result_.layers);
    parts_.shell = lay(options_.shell, LayerSide::outside, result_.shell);
    lap("layers");
    CoreSurface surface;
    Core core;
    if (parts_.with_lumen) {
      report_progress(progress_, "core", 0);
      surface = core_surface(parts_, options_.core_size);
      core = fill_core(surface);
      if (!core.failure.empty()) {
        result_.defects.push_back({VolumeDefectKind::not_filled, surface.mesh.vertices[0], 1,
                                   "the core could not be divided into tetrahedra: " + core.failure});
        return std::move(result_);
      }
      lap("core");
    }
    result_.mesh = assemble(parts_, surface, core);
    check();
    lap("check");
    return std::move(result_);
  }

 private:
  LayerStack lay(const LayerOptions& options, LayerSide side, LayerSummary& summary) {
    if (options.count == 0) return without_layers(frame_, side);
    LayerStack stack = lay_layers(frame_, options, side, progress_);
    summary = summarize(frame_, stack);
    return stack;
  }

  void check() {
    report_progress(progress_, "check", 0);
    result_.defects = find_volume_defects(result_.mesh);
    if (!result_.defects.empty() || !parts_.with_lumen) return;
    result_.defects = compare_with_wall(result_.mesh, "lumen", wall_);
  }

  void lap(const char* stage) { clock_.lap(stage, result_.stages); }

  const VesselWall& wall_;
  const VolumeOptions& options_;
  const Progress& progress_;
  StageClock clock_;
  WallFrame frame_;
  VolumeParts parts_;
  VolumeResult result_;
};

}  // namespace

std::string_view to_string(LayerLimit limit) {
  switch (limit) {
    case LayerLimit::gradation:
      return "gradation";
    case LayerLimit::shape:
      return "shape";
    case LayerLimit::room:
      return "room";
    case LayerLimit::none:
      break;
  }
  return "none";
}

VolumeResult make_volume(const VesselWall& wall, const VolumeOptions& options, const Progress& progress) {
  check_options(options);
  return VolumeMaker(wall, options, progress).run();
}

}  // namespace vmesh
