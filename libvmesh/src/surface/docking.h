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

  /// Cuts off the tip of a vessel: what lies around the vertex of `own` farthest along `normal`, beyond the plane
  /// through `center`. Only vertices of `own` go; faces are cut where they cross the plane. Where that is no disc, the
  /// farthest vertex goes alone; without one, a window is opened in the face nearest to the tip. Returns the rim,
  /// counter-clockwise about `normal`; no two rims touch. Edges of the rim shorter than `shortest` are collapsed where
  /// that keeps the surface's topology.
  std::vector<Index> cut(const Vec3& center, const Vec3& normal, const std::vector<Index>& own, double shortest);

  void move(Index v, const Vec3& position) { vertices_[v] = position; }

  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// The vertex of the piece that vertex `v` is, or that it was made next to.
  Index source(Index v) const { return source_[v]; }
  /// Faces that are left.
  std::vector<Triangle> rest() const;

 private:
  struct Plane {
    Vec3 normal;
    double height;
    double above(const Vec3& p) const { return p.dot(normal) - height; }
  };

  Index farthest(const Vec3& normal, const std::vector<Index>& own) const;
  std::vector<Index> tip_region(Index apex, const Plane& plane, const std::vector<Index>& own) const;
  bool is_disc(const std::vector<Index>& region) const;
  std::vector<Index> cut_off(const std::vector<Index>& region, const Plane& plane);
  std::vector<Index> open_window(const Vec3& near);
  void collapse_short_edges(std::vector<Index>& rim, double shortest);
  bool collapsible(Index v, Index into) const;
  void collapse(Index v, Index into);
  std::vector<Index> neighbours(Index v) const;
  Index add_vertex(const Vec3& position, Index source);
  void add_face(const Triangle& face);
  void add_quad(Index a, Index b, Index c, Index d);
  std::vector<Index> faces_around(const std::vector<Index>& region) const;

  std::vector<Vec3> vertices_;
  std::vector<Triangle> faces_;
  std::vector<Index> source_;
  std::vector<std::vector<Index>> faces_of_;
  std::vector<char> removed_face_, removed_vertex_;
};

}  // namespace vmesh
