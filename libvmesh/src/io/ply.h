#pragma once

namespace vmesh::io {

/// The face attribute that is written as "quality" for MeshLab, and the comment by which the reader recognises it.
inline constexpr const char* kSkewnessName = "EquiangleSkewness";
inline constexpr const char* kSkewnessComment = "comment face quality is EquiangleSkewness";

/// "comment patch 1 wall": the name of the faces with ModelFaceID 1.
inline constexpr const char* kPatchComment = "comment patch ";

}  // namespace vmesh::io
