#pragma once

#include "surface/pieces/assembly.h"
#include "surface/pieces/division.h"
#include "surface/pieces/piece.h"

namespace vmesh {

/// Checks the invariants of libvmesh/README.md while a piece is made, if ExecutionParams asks for it. Functions throw
/// std::logic_error.
class PieceInvariants {
 public:
  /// Remembers where the seams lie. `plan` is the piece's, `filled_loops` those of its junctions.
  PieceInvariants(const VesselRings& tubes, const PiecePlan& plan, std::size_t filled_loops,
                  const BoundSurface& surface, const std::vector<PieceLoop>& loops);

  /// Closed, of the plan's topology, with its seams where they were.
  void check(const BoundSurface& surface) const;

 private:
  bool on_;
  std::int64_t euler_characteristic_ = 0;
  std::vector<std::pair<Vertex, Vec3>> at_seams_;
};

/// Whether all seams lie between two pieces.
void check_division(const RingCounts& rings, const Division& division);

/// Whether everything that a piece refers to is there.
void check_numbers(const PieceSurface& piece);

/// Whether both are the same, to the bit.
void check_repeatable(const PieceSurface& piece, const PieceSurface& again);

}  // namespace vmesh
