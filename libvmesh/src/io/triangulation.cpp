#include "triangulation.h"

#include "vmesh/core/error.h"
#include "vmesh/mesh/polygon_triangulation.h"

#include "formats.h"

namespace vmesh::io {

void FaceCollector::add(const std::vector<std::int64_t>& corners, const std::string& place) {
  const auto count = static_cast<std::int64_t>(surface_.mesh.vertices.size());
  for (const std::int64_t c : corners) {
    if (c >= 0 && c < count) continue;
    throw InvalidInput(source_ + ": " + place + ": its corner " + std::to_string(c) + " is not a vertex; there are " +
                       std::to_string(count));
  }
  const auto face = static_cast<Index>(faces_++);
  if (corners.size() > 3) ++polygons_;
  if (corners.size() < 3) ++degenerate_;
  const auto corner = [&](Index i) { return static_cast<Index>(corners[i]); };
  if (corners.size() == 3 || corners.size() > static_cast<std::size_t>(count)) {  // a triangle, or corners repeat
    for (Index i = 2; i < corners.size(); ++i) add_triangle({corner(0), corner(i - 1), corner(i)}, face);
    return;
  }
  polygon_.clear();
  for (const std::int64_t c : corners) polygon_.push_back(surface_.mesh.vertices[static_cast<std::size_t>(c)]);
  for (const auto& [a, b, c] : triangulate_polygon(polygon_)) add_triangle({corner(a), corner(b), corner(c)}, face);
}

void FaceCollector::add_triangle(const Triangle& triangle, Index face) {
  if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
    ++degenerate_;
    return;
  }
  surface_.mesh.faces.push_back(triangle);
  face_of_triangle_.push_back(face);
}

void FaceCollector::finish() {
  const auto& vertices = surface_.mesh.vertices;
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v].allFinite()) continue;
    throw InvalidInput(source_ + ": vertex " + std::to_string(v) + ": the position is not finite (NaN or infinity)");
  }
  if (surface_.mesh.faces.empty()) {
    throw InvalidInput(source_ + ": it contains no triangle (" + std::to_string(vertices.size()) + " vertices, " +
                       std::to_string(faces_) + " faces); a surface is needed");
  }
  if (polygons_ > 0) {
    surface_.warnings.push_back(source_ + ": " + std::to_string(polygons_) +
                                " faces with more than three corners were split into triangles");
  }
  if (degenerate_ > 0) {
    surface_.warnings.push_back(source_ + ": " + std::to_string(degenerate_) +
                                " faces with less than three different corners were left out");
  }
}

}  // namespace vmesh::io
