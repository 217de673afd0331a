#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "surface/pieces/fine_places.h"
#include "surface/pieces/piece_grower.h"
#include "surface/proof/refine_to_limit.h"

namespace vmesh {

/// Finds out how fine a surface is to be grown where it could not be refined to a limit: by trials with the pieces
/// around these places alone.
class PlaceTrials {
 public:
  /// Keeps references. Progress is reported as "try". `first`: what has grown without fine places.
  /// `most_draws`: for places that are tried together.
  PlaceTrials(PieceGrower& grower, const Grown& first, const RefinementGoal& goal, const Progress& progress,
              int most_draws = 12);

  /// Tries until all is proven around these places, or no draw is left: takes what leaves the fewest faces then, and
  /// leaves these places alone from then on. Returns whether there was any to try.
  bool run(const std::vector<UnprovenPlace>& unproven);

  /// What the surface is to be grown with.
  const std::vector<FinePlace>& fine_places() const { return fine_.places(); }
  /// Pieces that are not the same with these fine places, ascending.
  std::vector<Index> changed_pieces() const;

 private:
  struct Group {
    std::vector<Index> pieces;
    std::vector<UnprovenPlace> places;
  };
  struct Trial {
    FinePlaces fine;
    std::size_t unproven_faces;
    std::vector<UnprovenPlace> unproven;
  };

  std::vector<Index> pieces_near(const Vec3& place) const;
  std::vector<Group> groups_of(const std::vector<UnprovenPlace>& unproven) const;
  void try_group(const Group& group);
  bool is_known(const Trial& trial) const;
  std::optional<Trial> try_with(const FinePlaces& fine, const Group& group);
  static bool draw(FinePlaces& fine, const std::vector<UnprovenPlace>& unproven, std::size_t in_vain);

  PieceGrower& grower_;
  const Grown& first_;
  const RefinementGoal& goal_;
  const Progress poll_;
  const int most_draws_;
  double done_ = 0;                         // share of the groups
  std::vector<Eigen::AlignedBox3d> boxes_;  // of the pieces
  std::vector<char> is_given_up_;           // by piece
  FinePlaces fine_;
  bool was_run_ = false;
};

}  // namespace vmesh
