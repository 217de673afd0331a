#pragma once

#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/solid/make_volume.h"

#include "solid/wall_frame.h"

namespace vmesh {

/// On which side of the wall layers lie.
enum class LayerSide { inside, outside };

/// Layers along a wall: every vertex moves along a straight way, the same share of it for all layers. Where no layers
/// fit the thickness is 0: they end there, in cells with fewer corners.
struct LayerStack {
  LayerSide side = LayerSide::inside;
  double reach = 1;                 ///< this many times the thickness is kept free of those of other places
  double reach_if_thin = 1;         ///< the same where they are thinner than a tenth of what was asked for
  double reach_at_ends = 1;         ///< the same at faces where they end
  std::vector<double> level = {0};  ///< share of the thickness at which layers begin and end: 0, ..., 1
  std::vector<Vec3> way;            ///< of every vertex of the wall, per thickness; about unit length
  std::vector<double> asked_mm;     ///< thickness
  std::vector<double> reached_mm;   ///< of it, what there is room for
  std::vector<double> least_mm;     ///< thickness below which layers end
  std::vector<LayerLimit> limit;    ///< why what is reached is less than what was asked for

  bool ends_at(Index v) const { return reached_mm[v] == 0; }
  std::size_t count() const { return level.size() - 1; }
  Vec3 at(const WallFrame& frame, Index v, double share) const {
    return frame.position[v] + share * reached_mm[v] * way[v];
  }
};

/// As thick as they are to be, or as there is room for. Throws Cancelled.
LayerStack lay_layers(const WallFrame& frame, const LayerOptions& options, LayerSide side, const Progress& progress);

/// The same, thinner at these vertices.
LayerStack thinned(const WallFrame& frame, const LayerStack& stack, const std::vector<Index>& vertices,
                   const Progress& progress);

/// None anywhere.
LayerStack without_layers(const WallFrame& frame, LayerSide side);

/// How thick they are.
LayerSummary summarize(const WallFrame& frame, const LayerStack& stack);

/// A cap filled within the ring of its innermost layer.
Disc disc_within(const WallFrame& frame, const Cap& cap, const LayerStack& stack);

}  // namespace vmesh
