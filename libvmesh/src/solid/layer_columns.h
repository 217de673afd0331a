#pragma once

#include <span>
#include <vector>

#include "vmesh/core/types.h"

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
  struct Change {
    Index vertex;
    double before_mm;
  };
  /// Changes the thickness, and where it then would differ by more than the gradation, makes layers around thinner too.
  /// Returns what has changed: nothing if layers would be thicker than asked for, far thinner than at first, or end, or
  /// not be well-shaped.
  std::vector<Change> set_thickness(Index v, double thickness_mm);
  /// Makes layers thinner by a factor at all of these vertices that may move, and around them as above. They may become
  /// thinner than by set_thickness().
  std::vector<Change> thin_together(std::span<const Index> vertices, double factor);
  void take_back(const std::vector<Change>& changes);

 private:
  bool spread(std::vector<Change>& changes);
  bool change(Index v, double thickness_mm, std::vector<Change>& changes);
  bool are_good(const std::vector<Change>& changes) const;

  const WallFrame& frame_;
  LayerStack& stack_;
  std::vector<char> may_move_;
  std::vector<double> least_mm_, least_together_mm_;
};

}  // namespace vmesh
