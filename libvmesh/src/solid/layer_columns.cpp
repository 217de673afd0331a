#include "solid/layer_columns.h"

#include <algorithm>
#include <cmath>

#include "solid/layer_ends.h"
#include "solid/layer_shape.h"

namespace vmesh {

LayerColumns::LayerColumns(const WallFrame& frame, LayerStack& stack) : frame_(frame), stack_(stack) {
  may_move_.resize(frame.position.size(), stack.count() > 0);
  for (const Triangle& face : frame.faces) {
    for (const Index v : face) may_move_[v] = may_move_[v] && !stack.ends_at(v) && !is_layer_end(stack, face);
  }
}

bool LayerColumns::set_thickness(Index v, double thickness_mm) {
  if (!(thickness_mm <= stack_.asked_mm[v] && thickness_mm >= stack_.least_mm[v])) return false;
  const double before = stack_.reached_mm[v];
  stack_.reached_mm[v] = thickness_mm;
  if (is_gradual(v) && is_good(v)) return true;
  stack_.reached_mm[v] = before;
  return false;
}

bool LayerColumns::is_gradual(Index v) const {
  const auto& position = frame_.position;
  for (const Index f : frame_.fan[v]) {
    for (const Index w : frame_.faces[f]) {
      const double most = kLayerGradation * (position[w] - position[v]).norm();
      if (std::abs(stack_.reached_mm[w] - stack_.reached_mm[v]) > most) return false;
    }
  }
  return true;
}

bool LayerColumns::is_good(Index v) const {
  return std::all_of(frame_.fan[v].begin(), frame_.fan[v].end(),
                     [&](Index f) { return is_well_shaped(frame_, stack_, f); });
}

}  // namespace vmesh
