#pragma once

#include <functional>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A closed surface from which discs are cut.
class DiscCutter {
 public:
  DiscCutter(std::vector<Vec3> vertices, std::vector<Triangle> faces);

  /// Cuts off the tip of a vessel: the region beyond the plane through `center` that is connected to the vertex of
  /// `own` farthest along `normal`. Only vertices of `own` are removed; faces that cross the plane are cut. If the
  /// region is not a disc, only the farthest vertex is removed; if there is none, a hole is cut in the face nearest to
  /// the tip. Returns the rim, counter-clockwise about `normal`; no two rims touch. Rim edges shorter than `shortest`
  /// are collapsed where that keeps the topology.
  std::vector<Index> cut(const Vec3& center, const Vec3& normal, const std::vector<Index>& own, double shortest);

  void move(Index v, const Vec3& position) { vertices_[v] = position; }

  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// The original vertex that `v` is a copy of or was created next to.
  Index source(Index v) const { return source_[v]; }
  /// The remaining faces.
  std::vector<Triangle> rest() const;

 private:
  using Height = std::function<double(const Vec3&)>;  // above the cutting surface

  Index farthest(const Vec3& normal, const std::vector<Index>& own) const;
  std::vector<Index> region_above(Index apex, const Height& height, const std::vector<Index>& own) const;
  bool is_disc(const std::vector<Index>& region) const;
  std::vector<Index> cut_off(const std::vector<Index>& region, const Height& height);
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
