#pragma once

namespace vmesh::io {

/// The face attribute that MeshLab is to show as "quality", and the comment by which the reader knows.
inline constexpr const char* kSkewnessName = "EquiangleSkewness";
inline constexpr const char* kSkewnessComment = "comment face quality is EquiangleSkewness";

}  // namespace vmesh::io
