#pragma once

#include <mutex>

#include "surface/pieces/piece.h"
#include "surface/proof/finished_surface.h"

namespace vmesh {

/// A surface put together from its pieces: vertices of the seams first, then those of the pieces in their order.
struct GatheredSurface : FinishedSurface {
  std::vector<Index> first_vertex;  ///< of every piece, then the total
  std::vector<Index> first_face;    ///< likewise

  Index piece_of(Index face) const;
};

/// Puts a surface together while its pieces are made. Vertices and faces of a piece are taken out of it as soon as all
/// pieces before it are finished, so that they are in memory once. Holes stay with the pieces.
class Gatherer {
 public:
  /// The rings at the seams must be laid now, and need not be later. `vertices`: about how many there will be; more
  /// cost a copy. All arguments must outlive it.
  Gatherer(const VesselRings& tubes, const Division& division, std::vector<PieceSurface>& pieces, double vertices);

  /// Notes that a piece is finished. Pieces may be added in any order, by different threads.
  void add(Index piece);

  /// After all have been added.
  GatheredSurface finish();

 private:
  void add_seams();
  void append(PieceSurface& piece);

  const VesselRings& tubes_;
  const Division& division_;
  std::vector<PieceSurface>& pieces_;
  std::mutex adding_;
  std::vector<char> finished_;
  Index around_ = 0;            // vertices of every seam
  Index next_ = 0;              // piece to be appended
  std::size_t release_at_ = 0;  // vertices, when freed memory is returned next
  std::size_t release_step_ = 0;
  GatheredSurface surface_;
};

GatheredSurface gather(const VesselRings& tubes, const Division& division, std::vector<PieceSurface> pieces);

/// Puts the pieces of another division together, whose seams are some of `before`. For every piece of it `known` has
/// the number of the same piece before, whose vertices and faces are in `surface`, or kNone: then `pieces` has them.
GatheredSurface gather_again(GatheredSurface surface, const Division& before, const Division& division,
                             const std::vector<Index>& known, std::vector<PieceSurface>& pieces,
                             const Centerline& centerline);

}  // namespace vmesh
