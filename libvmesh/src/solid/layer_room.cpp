#include "solid/layer_room.h"

#include <algorithm>

#include "vmesh/edit/crossing_guard.h"

namespace vmesh {
namespace {

// The surface on which layers end, closed by the caps: it crosses itself where layers have no room. The wall is not
// part of it: layers that ran into it would have run into those along it before.
class LayerSurface {
 public:
  LayerSurface(const WallFrame& frame, const LayerStack& stack, const std::vector<char>& has_changed)
      : frame_(frame), stack_(stack), has_changed_(has_changed), last_(static_cast<Index>(frame.position.size())) {
    mesh_.vertices = frame.position;
    for (Index v = 0; v < last_; ++v) mesh_.vertices.push_back(stack.at(frame, v, reach_at(v)));
    for (const auto& [a, b, c] : frame.faces) {
      add({moved(a), moved(b), moved(c)}, has_changed[a] || has_changed[b] || has_changed[c]);
    }
    for (const Cap& cap : frame.caps) add_cap(cap);
  }

  /// Vertices of the wall whose layers a crossing face depends on.
  std::vector<char> crossing_vertices() const {
    std::vector<char> crosses(last_, 0);
    for (const auto& [f, g] : crossing_pairs(mesh_.vertices, mesh_.faces, changed_)) {
      for (const Index face : {f, g}) {
        for (const Index v : mesh_.faces[face]) mark(v, crosses);
      }
    }
    return crosses;
  }

 private:
  double reach_at(Index v) const {
    for (const Index f : frame_.fan[v]) {
      const auto& [a, b, c] = frame_.faces[f];
      if (stack_.ends_at(a) || stack_.ends_at(b) || stack_.ends_at(c)) return stack_.reach_at_ends;
    }
    constexpr double kThin = 0.5;
    return stack_.reached_mm[v] < kThin * stack_.asked_mm[v] ? stack_.reach_if_thin : stack_.reach;
  }

  void add(const Triangle& face, bool has_changed) {
    if (has_changed) changed_.push_back(static_cast<Index>(mesh_.faces.size()));
    mesh_.faces.push_back(face);
  }

  // Where the layers at a vertex end: at itself if there are none.
  Index moved(Index v) const { return stack_.ends_at(v) ? v : last_ + v; }

  void mark(Index v, std::vector<char>& crosses) const {
    if (v < last_) return;
    if (v < 2 * last_) {
      crosses[v - last_] = 1;
    } else if (const Cap* cap = filled_cap_[v - 2 * last_]) {
      for (const Index rim : cap->rim) crosses[rim] = 1;
    }
  }

  void add_cap(const Cap& cap) {
    for (std::size_t j = 0; j < cap.rim.size(); ++j) {
      const Index a = cap.rim[j], b = cap.rim[(j + 1) % cap.rim.size()];
      if (moved(b) != b) add({a, b, moved(b)}, has_changed_[b]);
      if (moved(a) != a) add({a, moved(b), moved(a)}, has_changed_[a] || has_changed_[b]);
    }
    const bool inside = stack_.side == LayerSide::inside;
    std::vector<Vec3> ring;
    for (const Index v : cap.rim) ring.push_back(mesh_.vertices[last_ + v]);
    const Disc disc = inside ? fill_ring(ring, cap.normal) : cap.disc;
    const auto added = static_cast<Index>(mesh_.vertices.size()), rim = static_cast<Index>(cap.rim.size());
    mesh_.vertices.insert(mesh_.vertices.end(), disc.vertices.begin(), disc.vertices.end());
    filled_cap_.resize(filled_cap_.size() + disc.vertices.size(), inside ? &cap : nullptr);
    const auto number = [&](Index i) { return i >= rim ? added + i - rim : inside ? moved(cap.rim[i]) : cap.rim[i]; };
    const bool has_changed =
        inside && std::any_of(cap.rim.begin(), cap.rim.end(), [&](Index v) { return has_changed_[v]; });
    for (const auto& [a, b, c] : disc.faces) add({number(a), number(b), number(c)}, has_changed);
  }

  const WallFrame& frame_;
  const LayerStack& stack_;
  const std::vector<char>& has_changed_;
  Index last_;  // where the vertices on which layers end begin
  TriMesh mesh_;
  std::vector<Index> changed_;          // faces
  std::vector<const Cap*> filled_cap_;  // of every vertex within caps; null where layers do not move it
};

}  // namespace

std::vector<char> vertices_without_room(const WallFrame& frame, const LayerStack& stack,
                                        const std::vector<char>& has_changed) {
  return LayerSurface(frame, stack, has_changed).crossing_vertices();
}

}  // namespace vmesh
