#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

#include "render/camera.h"

namespace vmesh {

/// The tiles of a picture that may show the mesh; rays through the others need not be cast.
class ShownTiles {
 public:
  ShownTiles(const TriMesh& mesh, const Camera& camera, int width, int height);

  bool may_show_mesh(int x, int y) const {
    return tiles_[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(x / kTile)] != 0;
  }

 private:
  static constexpr int kTile = 8;  // pixels

  void mark(const TriMesh& mesh, const Camera& camera, const Triangle& face);

  int columns_, rows_;
  std::vector<unsigned char> tiles_;
};

}  // namespace vmesh
