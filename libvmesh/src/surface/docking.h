#pragma once

#include <span>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Faces that join a loop of vertices to the next one along `direction of growth`: both counter-clockwise about it. Of
/// all bands that start at the bottom's vertex closest to the top, the one with the least sum of squared edges.
/// Indices are into `bottom` and, from bottom.size() on, into `top`. Each loop needs at least three vertices.
std::vector<Triangle> stitch(std::span<const Vec3> bottom, std::span<const Vec3> top);

/// A closed piece of surface from which discs are cut.
class DiscCutter {
 public:
  DiscCutter(std::vector<Vec3> vertices, std::vector<Triangle> faces);

  /// Cuts the faces at the tip of a vessel: around the vertex of `own` farthest along `normal` all vertices of `own`
  /// that lie beyond the plane through `center`, fewer where those are no disc; where nothing is left to cut, a window
  /// is opened in the face nearest to the tip. Returns the rim, counter-clockwise about `normal`; discs never overlap.
  std::vector<Index> cut(const Vec3& center, const Vec3& normal, double radius, const std::vector<Index>& own);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// The vertex of the piece that vertex `v` is, or that it was made next to.
  Index source(Index v) const { return source_[v]; }
  /// Faces that are left.
  std::vector<Triangle> rest() const;

 private:
  Index farthest(const Vec3& normal, const std::vector<Index>& own) const;
  std::vector<Index> tip_region(Index apex, const Vec3& center, const Vec3& normal, double height,
                                const std::vector<Index>& own) const;
  // The rim around the faces of `region`; empty if these are no disc or touch what was cut before.
  std::vector<Index> rim_around(const std::vector<Index>& region, std::vector<Index>& cut_faces) const;
  std::vector<Index> take(const std::vector<Index>& rim, const std::vector<Index>& cut_faces);
  std::vector<Index> open_window(const Vec3& near);

  std::vector<Vec3> vertices_;
  std::vector<Triangle> faces_;
  std::vector<Index> source_;
  std::vector<std::vector<Index>> faces_of_;
  std::vector<char> cut_;
};

}  // namespace vmesh
