#pragma once

#include <vector>

#include "quality/triangle_tree.h"

namespace vmesh {

/// Faces that lie close together, and a ball around them.
struct FaceBlock {
  Index first = 0, last = 0;  // of FaceBlocks::order
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

struct FaceBlocks {
  std::vector<Index> order;  // all faces, along a space-filling curve
  std::vector<FaceBlock> blocks;
};

/// Cuts a mesh into blocks of at most `faces_per_block` faces.
FaceBlocks cut_into_blocks(const TriMesh& mesh, const Extent& extent, Index faces_per_block);

}  // namespace vmesh
