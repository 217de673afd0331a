// What the surface readers share, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/io/surface_io.h"

namespace vmesh::io {

/// Collects the faces of a file: checks corners, splits polygons into fans, leaves out degenerate faces, and remembers
/// which face of the file every triangle came from.
class FaceCollector {
 public:
  FaceCollector(LoadedSurface& surface, std::string source) : surface_(surface), source_(std::move(source)) {}

  /// The next polygon of the file. Throws InvalidInput for a corner that is no vertex; `place` ("line 12", "face 7")
  /// names the polygon in messages.
  void add(const std::vector<std::int64_t>& corners, const std::string& place);

  /// Throws InvalidInput when there is no triangle, or a position is not finite. Adds the warnings.
  void finish();

  const std::vector<Index>& face_of_triangle() const { return face_of_triangle_; }

 private:
  LoadedSurface& surface_;
  std::string source_;
  std::vector<Index> face_of_triangle_;
  std::size_t faces_ = 0, polygons_ = 0, degenerate_ = 0;
};

/// Warns when the file does not say its unit or frame.
void warn_without_tags(LoadedSurface& surface, const std::string& source);

}  // namespace vmesh::io
