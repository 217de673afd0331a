#pragma once

#include <array>
#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// Knows how far straight extensions of a surface's openings can go before they run into something.
class ExtensionRoom {
 public:
  /// In the way are the faces of the surface, its openings closed by lids.
  explicit ExtensionRoom(const GenerateResult& result);

  struct Room {
    double length = 0;       ///< mm, at most the limit
    Index vertex = kNone;    ///< of the surface, near what is in the way; kNone: nothing is
    Vec3 at = Vec3::Zero();  ///< on the axis, where something is in the way
  };
  /// From an opening whose ring has these positions, along its normal. A gap is left, to the sides and ahead.
  Room ahead(const Opening& opening, const std::vector<Vec3>& ring, double limit) const;

  /// From now on an extension is in the way as well: the faces of `mesh` from `first_face` on, and a lid on its ring.
  void add(const TriMesh& mesh, std::size_t first_face, const std::vector<Index>& ring);

 private:
  struct Obstacle {
    std::array<Vec3, 3> corners;
    Triangle vertices;
  };
  struct Extension {
    Extension();
    void add(const std::array<Vec3, 3>& corners, const Triangle& vertices);

    Vec3 low, high;  // of its box
    std::vector<Obstacle> faces;
  };

  TriMesh closed_;
  BoxTree tree_;
  std::vector<Extension> extensions_;
};

}  // namespace vmesh
