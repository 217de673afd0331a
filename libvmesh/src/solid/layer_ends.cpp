#include "solid/layer_ends.h"

#include <algorithm>
#include <map>

#include "vmesh/mesh/volume_faces.h"

namespace vmesh {
namespace {

class EndTaker {
 public:
  EndTaker(const WallFrame& frame, const LayerStack& layers, CoreSurface& surface)
      : frame_(frame),
        layers_(layers),
        surface_(surface),
        first_(static_cast<Index>(surface.mesh.vertices.size())),
        number_(frame.position.size(), kNone) {}

  std::vector<Tetrahedron> run() {
    for (const Triangle& face : frame_.faces) {
      if (is_layer_end(layers_, face)) take(face);
    }
    find_outside();
    return std::move(cells_);
  }

 private:
  void take(Triangle face) {
    while (layers_.ends_at(face[0])) std::rotate(face.begin(), face.begin() + 1, face.end());
    const auto& [a, b, c] = face;
    for (Index level = 0; level < layers_.count(); ++level)
      cells_.push_back({point(a, level + 1), b, c, point(a, level)});
  }

  Index point(Index v, Index level) {
    if (level == layers_.count()) return v;  // which stands for it in the core's surface
    if (number_[v] == kNone) {
      number_[v] = first_ + static_cast<Index>(surface_.beside.size());
      for (Index k = 0; k < layers_.count(); ++k)
        surface_.beside.push_back({v, k, layers_.at(frame_, v, layers_.level[k])});
    }
    return number_[v] + level;
  }

  // Faces of one cell alone; those that the cells share with the core's surface are within from now on.
  void find_outside() {
    std::map<Triangle, std::pair<Triangle, int>> seen;  // by sorted corners
    const auto see = [&](const Triangle& face) {
      Triangle key = face;
      std::sort(key.begin(), key.end());
      ++seen.try_emplace(key, face, 0).first->second.second;
    };
    for (const Tetrahedron& cell : cells_) {
      for (const CellFace& face : faces_of(cell)) see({face[0], face[1], face[2]});
    }
    for (const Triangle& face : frame_.faces) {
      if (is_layer_end(layers_, face)) see(face);
    }
    for (const auto& [key, face] : seen) {
      if (face.second == 1) surface_.faces_beside.push_back(face.first);
    }
  }

  const WallFrame& frame_;
  const LayerStack& layers_;
  CoreSurface& surface_;
  Index first_;                // number of the first point beside the surface
  std::vector<Index> number_;  // of the first of the points over a vertex
  std::vector<Tetrahedron> cells_;
};

}  // namespace

bool is_layer_end(const LayerStack& layers, const Triangle& face) {
  return std::count_if(face.begin(), face.end(), [&](Index v) { return layers.ends_at(v); }) == 2;
}

void take_layer_ends(const WallFrame& frame, const LayerStack& layers, CoreSurface& surface, Core& core) {
  if (layers.count() == 0) return;
  const std::vector<Tetrahedron> cells = EndTaker(frame, layers, surface).run();
  const auto first = static_cast<Index>(surface.mesh.vertices.size());
  for (Tetrahedron& cell : core.tetrahedra) {
    for (Index& v : cell) v += v < first ? 0 : static_cast<Index>(surface.beside.size());
  }
  core.tetrahedra.insert(core.tetrahedra.end(), cells.begin(), cells.end());
}

}  // namespace vmesh
