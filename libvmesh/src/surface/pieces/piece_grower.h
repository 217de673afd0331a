#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "surface/pieces/gathering.h"
#include "surface/pieces/parting.h"

namespace vmesh {

/// A surface as its pieces have grown.
struct Grown {
  Division division;
  std::vector<PieceSurface> pieces;  ///< their vertices and faces are in the surface
  GatheredSurface surface;
  BeforeParting before_parting;
  std::vector<std::pair<Index, Index>> crossings;  ///< pairs of faces
  std::vector<Index> unproven;                     ///< faces, with a limit on the error
};

/// Grows a surface piece by piece. Walls of different pieces that cross each other are parted in place. Where that
/// fails, or where pieces are not sound at their seam, they are made again as one.
class PieceGrower {
 public:
  /// Keeps references to `field`, `open` (for every node, whether the surface is to be open there) and `progress`.
  /// `refined_to`: what the surface is refined to when it has grown, if set; the limit of the options is proven piece
  /// by piece.
  PieceGrower(const VesselField& field, const std::vector<char>& open, const GenerateOptions& options,
              const ErrorLimit& refined_to, const Progress& progress);

  Grown grow();
  /// The same, but that these pieces of it are made anew, finer at some places.
  Grown grow_anew(const Grown& first, const std::vector<Index>& pieces, const std::vector<FinePlace>& fine_places);
  /// Some pieces by themselves, likewise: a surface with openings where others join them. Nothing if a piece that was
  /// sound is not on the first few rungs. `progress`: polled for cancellation.
  std::optional<FinishedSurface> grow_some(const Grown& first, const std::vector<Index>& pieces,
                                           const std::vector<FinePlace>& fine_places, const Progress& progress);

  const VesselRings& tubes() const { return tubes_; }

 private:
  void begin(const std::vector<FinePlace>& fine_places, int most_rungs, const Progress* polled);
  std::vector<Opening> outer_seams() const;
  void make_all(double expected_vertices);
  template <class Finished>
  void make_pieces(const std::vector<Index>& missing, const Finished& finished);
  void settle();
  void change_to(Division next, const std::vector<Index>& known, std::vector<PieceSurface> pieces);
  void divide_anew(Division next);
  std::vector<std::pair<Index, Index>> find_crossings() const;
  bool regroup();
  bool vessels_overlap(Index f, Index g) const;
  void put_together(Index p, Index q, std::vector<RingPlace>& dissolved,
                    std::vector<std::pair<Anchor, Anchor>>& joined) const;
  template <class Visit>
  void for_seams_of_faulty_pieces(Visit&& visit) const;
  void lay_rings_of_faulty_pieces();
  bool has_fault_near(const PieceSurface& piece, const RingPlace& seam) const;
  std::optional<RingPlace> seam_of_vertex(Index v) const;

  VesselRings tubes_;
  RingCounts rings_;
  const GenerateOptions options_;
  const Progress& progress_;
  std::mutex reporting_;
  std::size_t done_ = 0, all_ = 0;
  const Progress* polled_ = nullptr;  // instead of reporting
  // Every sweep of a piece polls for cancellation; the progress reported is the share of finished pieces.
  const Progress ask_;
  PieceContext context_;
  Grown now_;  // while it grows
};

}  // namespace vmesh
