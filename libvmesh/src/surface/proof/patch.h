#pragma once

#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/face_pair.h"
#include "vmesh/surface/generate.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// A finished surface.
struct FinishedSurface {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;
  std::vector<double> radius;
  std::vector<Opening> openings;
};

/// An edge of a surface, by its ends.
struct MeshEdge {
  Index a, b;
  auto operator<=>(const MeshEdge&) const = default;
};

/// Changes a finished surface step by step, none of which makes faces cross or changes the topology. Numbers of
/// vertices stay as they are until remove_dead().
class Patch {
 public:
  /// Keeps references.
  Patch(FinishedSurface& surface, const VesselField& field);

  /// A replacement for some faces of the surface.
  struct Step {
    Index vertex = kNone;  ///< the vertex that is added or moved; kNone: none
    BoundaryPoint at;      ///< its new position
    std::vector<Index> gone;
    std::vector<Triangle> faces;  ///< that replace them
  };

  Step splitting(const MeshEdge& e, const BoundaryPoint& at) const;
  Step moving(Index v, const BoundaryPoint& at) const;
  /// Collapses the edge to its end b. Requires may_collapse().
  Step collapsing(const MeshEdge& e, const BoundaryPoint& at) const;
  /// Flips the edge. Requires may_flip().
  Step flipping(const MeshEdge& e) const;

  bool may_collapse(const MeshEdge& e) const;
  bool may_flip(const MeshEdge& e) const;
  /// Whether the edge exists and has a face on either side.
  bool is_inner(const MeshEdge& e) const { return faces_of(e).size() == 2; }
  /// Whether there are faces all around the vertex.
  bool is_inner(Index v) const { return around(v).size() == faces_at_[v].size() + 1; }
  /// The corners of an inner edge's faces that are not its ends.
  std::array<Index, 2> opposite(const MeshEdge& e) const;

  /// Takes the allowed step that leaves the best triangles, if it leaves none of a skewness above `worst`. Returns the
  /// vertex that it placed, or any corner of what it changed; kNone: no step was taken.
  Index take_best(const std::vector<Step>& steps, double worst);

  /// Flips and collapses triangles of a skewness above `worst` that the steps left, where that leaves none.
  void mend(double worst);

  /// Renumbers vertices and faces in their order, without the removed ones. Returns the new number of every old vertex.
  std::vector<Index> remove_dead();

 private:
  std::vector<Index> faces_of(const MeshEdge& e) const;
  std::vector<Index> around(Index v) const;
  PlacedFace placed(const Triangle& f) const;
  PlacedFace placed(const Triangle& f, const Step& step) const;
  double worst_skewness(const Step& step) const;
  bool may_take(const Step& step) const;
  bool is_crossed(const PlacedFace& face, const std::vector<Index>& gone) const;
  void take(const Step& step);
  void place(const Step& step);
  bool mend_face(Index f, double worst);

  FinishedSurface& surface_;
  const VesselField& field_;
  std::vector<std::vector<Index>> faces_at_;
  BoxTree tree_;
  std::vector<char> changed_;  // faces whose entries in the tree are outdated ...
  std::vector<Index> latest_;  // ... except removed ones
};

}  // namespace vmesh
