#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "vmesh/edit/crossing_guard.h"
#include "vmesh/edit/edit_mesh.h"
#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {

/// Takes steps on a mesh, none of which makes faces cross.
template <class V>
class GuardedEdit {
 public:
  using Step = typename EditMesh<V>::Step;

  /// Keeps a reference. All changes of the mesh are to be made here.
  explicit GuardedEdit(EditMesh<V>& mesh)
      : mesh_(mesh), guard_(mesh.faces().size(), [&mesh](Index f) {
          return mesh.has_face(f) ? std::make_optional(mesh.placed(f)) : std::nullopt;
        }) {}

  /// Takes the allowed step that leaves the best triangles, if it leaves none of a skewness above `worst`. Returns the
  /// vertex that it placed, or any corner of what it changed; kNone: no step was taken.
  Index take_best(const std::vector<Step>& steps, double worst) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < steps.size(); ++i) order.emplace_back(worst_skewness(steps[i]), i);
    std::sort(order.begin(), order.end());
    for (const auto& [leaves, i] : order) {
      if (leaves > worst) break;
      if (!take_allowed(steps[i])) continue;
      return steps[i].vertex != kNone ? steps[i].vertex : steps[i].faces[0][0];
    }
    return kNone;
  }

  /// Takes a patch if it is allowed. Returns whether it was.
  bool take(const typename EditMesh<V>::Patch& patch) { return take_allowed(patch); }

  /// Flips and collapses triangles of a skewness above `worst` that steps left, where that leaves none.
  void mend(double worst) {
    bool any = true;
    for (int round = 0; any && round < kMendRounds; ++round) {
      any = false;
      const std::vector<Index> faces = changed_;
      for (const Index f : faces) {
        if (mesh_.has_face(f) && skewness(mesh_.placed(f)) > worst) any = mend_face(f, worst) || any;
      }
    }
  }

 private:
  static constexpr int kMendRounds = 4;  // idle 3 to 6

  static double skewness(const PlacedFace& f) { return equiangle_skewness(f.points[0], f.points[1], f.points[2]); }

  double worst_skewness(const Step& step) const {
    double worst = 0;
    for (const Triangle& f : step.faces) worst = std::max(worst, skewness(mesh_.placed(f, step)));
    return worst;
  }

  // Of a step or a patch.
  template <class Change>
  bool take_allowed(const Change& change) {
    std::vector<PlacedFace> faces;
    for (const Triangle& f : change.faces) faces.push_back(mesh_.placed(f, change));
    if (!guard_.allows(faces, change.gone)) return false;
    const auto first_new = static_cast<Index>(mesh_.faces().size());
    mesh_.take(change);
    std::vector<Index> changed = change.gone;
    for (Index f = first_new; f < mesh_.faces().size(); ++f) changed.push_back(f);
    is_changed_.resize(mesh_.faces().size(), 0);
    for (const Index f : changed) {
      guard_.touch(f);
      if (!std::exchange(is_changed_[f], char{1})) changed_.push_back(f);
    }
    return true;
  }

  bool mend_face(Index f, double worst) {
    const Triangle face = mesh_.faces()[f];
    std::vector<Step> steps;
    for (std::size_t k = 0; k < 3; ++k) {
      const MeshEdge e{face[k], face[(k + 1) % 3]};
      if (!mesh_.is_inner(e)) continue;
      if (mesh_.may_flip(e)) steps.push_back(mesh_.flipping(e));
      if (!mesh_.may_collapse(e)) continue;
      for (const Index v : {e.a, e.b}) steps.push_back(mesh_.collapsing(e.a, e.b, mesh_.vertex(v)));
    }
    return take_best(steps, worst) != kNone;
  }

  EditMesh<V>& mesh_;
  CrossingGuard guard_;
  std::vector<Index> changed_;    // faces, in the order in which they first were
  std::vector<char> is_changed_;  // by face
};

}  // namespace vmesh
