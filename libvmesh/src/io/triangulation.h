// Shared by the surface readers, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/io/surface_io.h"

namespace vmesh::io {

/// Collects the faces of a file: checks corners, triangulates polygons, leaves out degenerate faces, and remembers
/// which face of the file every triangle came from.
class FaceCollector {
 public:
  FaceCollector(LoadedSurface& surface, std::string source) : surface_(surface), source_(std::move(source)) {}

  /// Adds the next polygon of the file. Throws InvalidInput for a corner that is not a vertex; `place` ("line 12",
  /// "face 7") names the polygon in messages.
  void add(const std::vector<std::int64_t>& corners, const std::string& place);

  /// Adds VTK's polygons and triangle strips; returns the cell of every face added, counting from `first_cell`.
  template <class Cells>
  std::vector<std::size_t> add_cells(const Cells& polygons, const Cells& strips, std::size_t first_cell) {
    std::vector<std::size_t> cell_of_face;
    for (std::size_t c = 0; c < polygons.size(); ++c) {
      cell_of_face.push_back(first_cell + c);
      add({polygons[c].begin(), polygons[c].end()}, "polygon " + std::to_string(c));
    }
    for (std::size_t c = 0; c < strips.size(); ++c) {
      const auto& strip = strips[c];
      for (std::size_t i = 2; i < strip.size(); ++i) {
        cell_of_face.push_back(first_cell + polygons.size() + c);
        const bool odd = i % 2 == 1;
        add({strip[i - (odd ? 1 : 2)], strip[i - (odd ? 2 : 1)], strip[i]}, "strip " + std::to_string(c));
      }
    }
    return cell_of_face;
  }

  /// Throws InvalidInput if there is no triangle or a position is not finite. Adds the warnings.
  void finish();

  const std::vector<Index>& face_of_triangle() const { return face_of_triangle_; }

 private:
  void add_triangle(const Triangle& triangle, Index face);

  LoadedSurface& surface_;
  std::string source_;
  std::vector<Vec3> polygon_;
  std::vector<Index> face_of_triangle_;
  std::size_t faces_ = 0, polygons_ = 0, degenerate_ = 0;
};

}  // namespace vmesh::io
