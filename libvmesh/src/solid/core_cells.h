#pragma once

#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "vmesh/core/types.h"

#include "solid/core.h"

namespace vmesh {

/// The smaller of the smallest sine of an angle between faces, and 1.2 times 3 inradius / circumradius: two measures,
/// which find different faults, weighted so that both are about equal in shapes that are barely good. Negative if the
/// corners are the wrong way round.
double tetrahedron_shape(const std::array<Vec3, 4>& corners);
/// Without the second measure.
double least_sine(const std::array<Vec3, 4>& corners);

/// Tetrahedra of a core that can be replaced by others. Numbers of points are the core's.
class CoreCells {
 public:
  CoreCells(const CoreSurface& surface, const Core& core);

  std::size_t size() const { return cells_.size(); }  ///< removed ones included
  bool is_there(Index t) const { return cells_[t][0] != kNone; }
  const Tetrahedron& operator[](Index t) const { return cells_[t]; }
  Vec3& position(Index v) { return points_[v]; }
  const Vec3& position(Index v) const { return points_[v]; }
  Index point_count() const { return static_cast<Index>(points_.size()); }
  bool is_added(Index v) const { return v >= fixed_; }  ///< not of the surface
  const std::vector<Index>& around(Index v) const { return around_[v]; }
  bool is_edge_of_surface(Index a, Index b) const { return outside_.contains(std::minmax(a, b)); }

  Index add_point(const Vec3& position);
  void remove_last_point();

  /// tetrahedron_shape(); of cells with an edge across a layer, which are thin whatever the others do, angles alone.
  double shape(const Tetrahedron& cell) const;
  /// Of the worst cell, or of the first that is worse than `enough`.
  double worst_shape(std::span<const Tetrahedron> cells, double enough = -1) const;
  std::vector<Tetrahedron> cells_of(std::span<const Index> numbers) const;

  std::vector<Index> at_edge(Index a, Index b) const;
  bool has(Index t, Index v) const;
  /// The cell on the other side of the face opposite to a corner; kNone outside.
  Index beyond(Index t, std::size_t corner) const;
  /// The cell with this face on its other side: corners as of a cell's face, seen from outside of that.
  Index beyond(Index t, const Triangle& face) const;
  /// Outer faces of a set of cells, counter-clockwise seen from outside, and the cell of each.
  std::vector<std::pair<Triangle, Index>> outer_faces(std::span<const Index> cavity) const;
  /// The vertices around an inner edge, counter-clockwise seen from `b`; empty if the edge is at the outside.
  std::vector<Index> ring(Index a, Index b) const;

  /// In place of cells that fill the same space.
  void replace(std::span<const Index> cavity, std::span<const Tetrahedron> cells);

  void write_to(Core& core) const;

 private:
  void enter(Index t);
  bool crosses_layer(const Tetrahedron& cell) const;

  std::vector<Tetrahedron> cells_;
  Index fixed_;  // points of the surface
  std::vector<Vec3> points_;
  std::vector<std::vector<Index>> around_;     // cells at every point
  std::set<std::pair<Index, Index>> outside_;  // edges of the surface
  std::vector<Index> column_;                  // of points of the surface and beside it: vertex of the wall; or empty
};

}  // namespace vmesh
