#pragma once

namespace vmesh::io {

/// The face attribute that is written as "quality" for MeshLab, and the comment by which the reader recognises it.
inline constexpr const char* kSkewnessName = "EquiangleSkewness";
inline constexpr const char* kSkewnessComment = "comment face quality is EquiangleSkewness";

}  // namespace vmesh::io
