#pragma once

#include "surface/junction/docked_junction.h"
#include "surface/junction/junction_growth.h"
#include "surface/remesh/bound_surface.h"
#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// The vertices around a hole in a piece of surface: at an end of a vessel that is left open, or at a seam.
struct PieceLoop {
  Index node = kNone;  ///< the vessel's end; kNone at a seam
  RingPlace seam;
  std::vector<Vertex> vertices;  ///< counter-clockwise about the direction out of the piece at an end, in the order of
                                 ///< the ring at a seam
};

/// Joins tubes and the junctions between them into one halfedge mesh.
class Assembly {
 public:
  /// `plan` is the one `skeleton` was made of; `open` says for every node whether the surface is to be open there.
  Assembly(const VesselRings& tubes, const PiecePlan& plan, const GrowthSkeleton& skeleton,
           const std::vector<char>& open);

  void add_junction(const Junction& junction, const DockedJunction& docked);

  /// Builds the surface. Holes are closed by lids; returns the loops around them.
  std::vector<PieceLoop> build(BoundSurface& surface) const;

 private:
  struct Loop {
    Index node;
    RingPlace seam;
    std::vector<Index> vertices;  // counter-clockwise about the direction out of the piece
    bool reversed;                // runs against the order of the ring
  };

  void add_tube(Index number);
  void end_at_tip(const Tube& tube, std::size_t k, double side, std::vector<Index> loop);
  RingPlace seam_at(const Tube& tube, bool at_last) const;
  Index size() const { return static_cast<Index>(vertices_.size()); }
  std::vector<Index> ring_vertices(Index tube, std::size_t k) const;
  std::vector<Vec3> positions(const std::vector<Index>& loop) const;
  void band(const std::vector<Index>& bottom, const std::vector<Index>& top);
  void cap(const Ring& ring, double side, std::vector<Index> loop);

  const VesselRings& tubes_;
  const PiecePlan& plan_;
  const GrowthSkeleton& skeleton_;
  const std::vector<char>& open_;
  std::vector<Loop> loops_;
  std::vector<SurfacePoint> vertices_;
  std::vector<Triangle> faces_;
  std::vector<std::vector<Index>> first_;  // vertex of every ring of every tube
};

}  // namespace vmesh
