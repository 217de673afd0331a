#include "vmesh/solid/make_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"

#include "solid/core.h"
#include "solid/core_improvement.h"
#include "solid/layer_ends.h"
#include "solid/layer_stack.h"
#include "solid/volume_assembly.h"
#include "solid/wall_bridges.h"
#include "solid/wall_frame.h"

namespace vmesh {
namespace {

constexpr double kLeastGrowth = 0.5, kMostGrowth = 5;
// Tetrahedra with an angle of less than 10 degrees, see BadPlaces, are worth thinner layers, that many times.
constexpr double kGoodEnough = 0.174;
constexpr int kThinnings = 4;
// With one of less than 12 degrees, layers become thinner than they may be otherwise.
constexpr double kWorthVeryThin = 0.208;
// A thinning that makes the worst tetrahedron better by less than this is the last.
constexpr double kLeastThinningGain = 1.05;

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
  if (options.layers.merged) throw InvalidInput("layers inside cannot be merged, only those of the shell");
  check_layers(options.layers, "layers");
  check_layers(options.shell, "layers of the shell");
  if (options.shell_only && options.shell.count == 0) throw InvalidInput("a shell alone needs a layer at least");
  if (!(options.core_size >= 0 && std::isfinite(options.core_size)))
    throw InvalidInput("the size of cells in the core must be positive");
}

VolumeDefect not_filled(const CoreSurface& surface, const Core& core) {
  const auto crossings = self_intersections(surface.mesh);
  const Index at = crossings.empty() ? 0 : surface.mesh.faces[crossings[0].first][0];
  const Vec3& p = surface.mesh.vertices[at];
  return {VolumeDefectKind::not_filled, p, std::max<std::size_t>(crossings.size(), 1),
          "the core could not be divided into tetrahedra: " + core.failure + "; " +
              counted(crossings.size(), "pair", "pairs") + " of its faces cross, near " + point_text(p)};
}

class VolumeMaker {
 public:
  VolumeMaker(const VesselWall& wall, const VolumeOptions& options, const Progress& progress)
      : wall_(wall), options_(options), progress_(progress), frame_(frame_of(wall)) {
    parts_.wall = &wall_;
    parts_.frame = &frame_;
    parts_.with_lumen = !options.shell_only;
    lap("caps");
  }

  VolumeResult run() {
    if (parts_.with_lumen && !can_mesh_lumen()) fill_core({});  // throws
    if (options_.shell.merged && !can_mesh_lumen()) fill_around({}, {});
    parts_.layers = lay(parts_.with_lumen ? options_.layers : LayerOptions{}, LayerSide::inside);
    parts_.shell = lay(options_.shell, LayerSide::outside);
    lap("layers");
    if (options_.shell.merged && parts_.shell.count() > 0) merge_walls();
    Filling filling;
    if (parts_.with_lumen) filling = fill();
    result_.layers = summarize(frame_, parts_.layers);
    result_.shell = summarize(frame_, parts_.shell);
    if (!filling.is_there()) {
      result_.defects.push_back(not_filled(filling.surface, filling.core));
      return std::move(result_);
    }
    if (!result_.defects.empty()) return std::move(result_);
    result_.mesh = assemble(parts_, filling.surface, filling.core);
    check();
    lap("proof");
    return std::move(result_);
  }

 private:
  struct Filling {
    LayerStack layers;
    CoreSurface surface;
    Core core;
    BadPlaces bad;

    bool is_there() const { return core.failure.empty(); }
    double shape() const { return is_there() ? bad.least : 0; }
  };

  void merge_walls() {
    report_progress(progress_, "merging", 0);
    parts_.bridges = bridge_walls(frame_, parts_.shell);
    if (!parts_.bridges.failure.empty())
      result_.defects.push_back({VolumeDefectKind::not_filled, frame_.position[0], 1,
                                 "what is between walls could not be divided into tetrahedra: " +
                                     parts_.bridges.failure + "; leave them apart"});
    result_.merged = merged_places(frame_, parts_.shell, parts_.bridges);
    lap("merging");
  }

  // Where tetrahedra are bad, or everywhere if there are none, layers are made thinner, as long as that helps.
  Filling fill() {
    Filling best = fill_once(parts_.layers);
    for (int round = 0; round < kThinnings; ++round) {
      const std::vector<Index> due = vertices_to_thin(best);
      if (due.empty()) break;
      Filling next = fill_once(thinned(frame_, best.layers, due, progress_));
      if (next.shape() < kLeastThinningGain * best.shape()) break;
      best = std::move(next);
    }
    if (best.is_there() && best.layers.count() > 0 && best.shape() < kWorthVeryThin)
      best.bad = thin_at_bad_places(best.surface, best.core, frame_, best.layers, kWorthVeryThin);
    parts_.layers = best.layers;
    return best;
  }

  Filling fill_once(const LayerStack& layers) {
    report_progress(progress_, "core", 0);
    Filling filling;
    filling.layers = layers;
    filling.surface = core_surface(frame_, layers, options_.core_size);
    filling.core = fill_core(filling.surface);
    lap("core");
    if (!filling.is_there()) return filling;
    take_layer_ends(frame_, layers, filling.surface, filling.core);
    filling.bad = improve_core(filling.surface, filling.core, frame_, filling.layers, kGoodEnough);
    lap("improvement");
    return filling;
  }

  std::vector<Index> vertices_to_thin(const Filling& filling) const {
    const LayerStack& stack = filling.layers;
    std::vector<Index> due;
    if (stack.count() == 0) return due;
    const auto add = [&](Index v) {
      if (v < frame_.position.size() && stack.reached_mm[v] > stack.least_mm[v]) due.push_back(v);
    };
    if (filling.is_there()) {
      for (const Index v : filling.bad.vertices) add(v);
    } else {
      for (Index v = 0; v < frame_.position.size(); ++v) add(v);
    }
    return due;
  }

  LayerStack lay(const LayerOptions& options, LayerSide side) const {
    return options.count > 0 ? lay_layers(frame_, options, side, progress_) : without_layers(frame_, side);
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
