#pragma once

#include "solid/layer_stack.h"

namespace vmesh {

/// The largest difference of the thickness of layers at two vertices, by their distance: sizes that change by a fifth
/// from cell to cell, the gradation of volume meshers.
inline constexpr double kLayerGradation = 0.2;

/// Layers of which the thickness at single vertices is changed.
class LayerColumns {
 public:
  LayerColumns(const WallFrame& frame, LayerStack& stack);

  /// Whether it is a vertex of the wall with layers that are cells of their own on all faces, see take_layer_ends().
  bool may_move(Index v) const { return v < may_move_.size() && may_move_[v]; }
  double thickness_mm(Index v) const { return stack_.reached_mm[v]; }
  Vec3 end(Index v) const { return stack_.at(frame_, v, 1); }
  /// Unless the layers would be thicker than asked for, end, differ from those around by more than the gradation, or
  /// not be well-shaped. Whether it is done.
  bool set_thickness(Index v, double thickness_mm);
  /// Back to one that there was.
  void restore(Index v, double thickness_mm) { stack_.reached_mm[v] = thickness_mm; }

 private:
  bool is_gradual(Index v) const;
  bool is_good(Index v) const;

  const WallFrame& frame_;
  LayerStack& stack_;
  std::vector<char> may_move_;
};

}  // namespace vmesh
