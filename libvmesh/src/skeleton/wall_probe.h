// Distances to a surface and what is in sight of it, internal to the module.
#pragma once

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// A surface that is asked for its nearest points. The mesh must outlive it.
class WallProbe {
 public:
  explicit WallProbe(const TriMesh& mesh);

  struct Nearest {
    Index face = kNone;
    Vec3 point = Vec3::Zero();
    double distance = 0;  ///< mm; infinite without a face
  };
  Nearest nearest(const Vec3& p) const;

  /// Whether the segment between two points meets a face; in plain arithmetic.
  bool meets(const Vec3& from, const Vec3& to) const;

 private:
  const TriMesh& mesh_;
  BoxTree tree_;
};

}  // namespace vmesh::skeleton
