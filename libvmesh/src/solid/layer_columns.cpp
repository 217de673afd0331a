#include "solid/layer_columns.h"

#include <algorithm>

#include "solid/layer_ends.h"
#include "solid/layer_shape.h"

namespace vmesh {
namespace {

constexpr std::size_t kMostChanges = 40;
// Share of the thickness at first that is left at least: cells of far thinner ones are worse than what they make
// better.
constexpr double kLeastLeft = 0.3;
// At a crease between vertices of the wall, where nothing else helps and layers are thin anyway: also as a share of the
// thickness below which they end.
constexpr double kLeastLeftTogether = 0.05, kLeastShareTogether = 0.2;

}  // namespace

LayerColumns::LayerColumns(const WallFrame& frame, LayerStack& stack) : frame_(frame), stack_(stack) {
  may_move_.resize(frame.position.size(), stack.count() > 0);
  for (Index v = 0; v < stack.least_mm.size(); ++v)
    least_mm_.push_back(std::max(stack.least_mm[v], kLeastLeft * stack.reached_mm[v]));
  for (Index v = 0; v < stack.least_mm.size(); ++v)
    least_together_mm_.push_back(
        std::max(kLeastShareTogether * stack.least_mm[v], kLeastLeftTogether * stack.reached_mm[v]));
  for (const Triangle& face : frame.faces) {
    for (const Index v : face) may_move_[v] = may_move_[v] && !stack.ends_at(v) && !is_layer_end(stack, face);
  }
}

std::vector<LayerColumns::Change> LayerColumns::set_thickness(Index v, double thickness_mm) {
  std::vector<Change> changes;
  if (change(v, thickness_mm, changes) && spread(changes) && are_good(changes)) return changes;
  take_back(changes);
  return {};
}

std::vector<LayerColumns::Change> LayerColumns::thin_together(std::span<const Index> vertices, double factor) {
  std::vector<Change> changes;
  for (const Index v : vertices) {
    if (!may_move(v)) continue;
    const double before = thickness_mm(v), thinner = std::max(least_together_mm_[v], factor * before);
    if (!(thinner < before)) continue;
    changes.push_back({v, before});
    stack_.reached_mm[v] = thinner;
  }
  if (!changes.empty() && spread(changes) && are_good(changes)) return changes;
  take_back(changes);
  return {};
}

void LayerColumns::take_back(const std::vector<Change>& changes) {
  for (auto change = changes.rbegin(); change != changes.rend(); ++change)
    stack_.reached_mm[change->vertex] = change->before_mm;
}

bool LayerColumns::change(Index v, double thickness_mm, std::vector<Change>& changes) {
  if (!may_move(v) || !(thickness_mm <= stack_.asked_mm[v] && thickness_mm >= least_mm_[v])) return false;
  changes.push_back({v, stack_.reached_mm[v]});
  stack_.reached_mm[v] = thickness_mm;
  return true;
}

// Whether the thickness is gradual then. The first change alone may be one to more.
bool LayerColumns::spread(std::vector<Change>& changes) {
  const auto& position = frame_.position;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Index v = changes[i].vertex;
    for (const Index f : frame_.fan[v]) {
      for (const Index w : frame_.faces[f]) {
        const double step = kLayerGradation * (position[w] - position[v]).norm();
        if (stack_.reached_mm[v] > stack_.reached_mm[w] + step) return false;
        if (!(stack_.reached_mm[w] > stack_.reached_mm[v] + step)) continue;
        if (changes.size() == kMostChanges || !change(w, stack_.reached_mm[v] + step, changes)) return false;
      }
    }
  }
  return true;
}

bool LayerColumns::are_good(const std::vector<Change>& changes) const {
  return std::all_of(changes.begin(), changes.end(), [&](const Change& change) {
    const std::vector<Index>& fan = frame_.fan[change.vertex];
    return std::all_of(fan.begin(), fan.end(), [&](Index f) { return is_well_shaped(frame_, stack_, f); });
  });
}

}  // namespace vmesh
