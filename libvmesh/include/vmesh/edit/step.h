#pragma once

#include <array>
#include <vector>

namespace vmesh {

/// A change of a surface: faces are replaced by others, around a vertex that is added or moved. Whether it is allowed
/// is asked before it is taken.
template <class VertexId, class FaceId, class Target>
struct Step {
  VertexId vertex;  ///< what is added or moved
  Target target;    ///< where it goes, with what is known of the place
  std::vector<FaceId> gone;
  std::vector<std::array<VertexId, 3>> faces;  ///< that replace them
};

}  // namespace vmesh
