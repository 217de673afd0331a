#include "render/shown_tiles.h"

#include <algorithm>
#include <cmath>

namespace vmesh {

ShownTiles::ShownTiles(const TriMesh& mesh, const Camera& camera, int width, int height)
    : columns_((width + kTile - 1) / kTile),
      rows_((height + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {
  for (const Triangle& face : mesh.faces) mark(mesh, camera, face);
}

// Marks the tiles under the box around the face; all of them for a face that reaches behind the eye.
void ShownTiles::mark(const TriMesh& mesh, const Camera& camera, const Triangle& face) {
  const auto& [a, b, c] = face;
  const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
  if (!camera.is_in_front(p) || !camera.is_in_front(q) || !camera.is_in_front(r)) {
    std::fill(tiles_.begin(), tiles_.end(), 1);
    return;
  }
  const Vec2 x = camera.project(p), y = camera.project(q), z = camera.project(r);
  const Vec2 low = x.cwiseMin(y).cwiseMin(z), high = x.cwiseMax(y).cwiseMax(z);
  const auto tile = [](double pixel, int count) {
    return static_cast<int>(std::clamp(std::floor(pixel / kTile), -1.0, static_cast<double>(count)));
  };
  const int left = std::max(tile(low.x() - 1, columns_), 0),
            right = std::min(tile(high.x() + 1, columns_), columns_ - 1);
  const int top = std::max(tile(low.y() - 1, rows_), 0), bottom = std::min(tile(high.y() + 1, rows_), rows_ - 1);
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      tiles_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)] = 1;
    }
  }
}

}  // namespace vmesh
