#pragma once

#include "vmesh/surface/generate.h"

#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// A position in a division: a ring, or a node that is in no stretch.
struct Anchor {
  RingPlace ring;
  Index node = kNone;
};

/// The branches of a centerline by their ends, and how many rings lie along each.
class RingCounts {
 public:
  struct Ends {
    Index first = kNone, last = kNone;  ///< nodes
  };

  /// `centerline` must outlive it.
  RingCounts(const Centerline& centerline, std::vector<Ends> ends, std::vector<Index> counts)
      : centerline_(centerline), ends_(std::move(ends)), counts_(std::move(counts)) {}
  explicit RingCounts(const VesselRings& tubes);

  const Centerline& centerline() const { return centerline_; }
  std::size_t branch_count() const { return ends_.size(); }
  const Ends& ends(Index branch) const { return ends_[branch]; }
  /// Whether a branch is a loop without a branching node.
  bool is_loop(Index branch) const {
    return ends_[branch].first == ends_[branch].last && centerline_.degree(ends_[branch].first) == 2;
  }
  Index along(Index branch) const { return counts_[branch]; }

 private:
  const Centerline& centerline_;
  std::vector<Ends> ends_;
  std::vector<Index> counts_;
};

/// The seams at a piece's ends, in the order of its stretches.
std::vector<RingPlace> seams_of(const RingCounts& rings, const PiecePlan& plan);

Anchor anchor_of(const PiecePlan& plan);

/// A surface's pieces, and the seams at which they meet. Each seam lies between two pieces.
struct Division {
  std::vector<RingPlace> seams;                   ///< ascending
  std::vector<PiecePlan> plans;                   ///< by their first stretches; those of isolated nodes last
  std::vector<std::pair<Anchor, Anchor>> joined;  ///< anchors kept in one piece although no vessel joins them
};

/// The rings of a branch that may be seams, ascending: those where the tube is already as even as optimisation would
/// make it, so that keeping them as they are costs nothing. They lie about halfway between two junctions, with more of
/// them along long runs. A ring at which the options ask for refinement is not a seam.
std::vector<RingPlace> find_seams(const VesselAxes& axes, const GenerateOptions& options, Index branch,
                                  std::span<const Ring> rings);

/// Divides a surface at these seams.
Division divide(const RingCounts& rings, std::vector<RingPlace> seams);
/// Divides a surface at all seams that can be found.
Division divide(const VesselRings& tubes, const GenerateOptions& options);

/// The division without `dissolved` seams and with the pieces at each pair of anchors merged.
Division regrouped(const RingCounts& rings, const Division& division, const std::vector<RingPlace>& dissolved,
                   const std::vector<std::pair<Anchor, Anchor>>& joined);

}  // namespace vmesh
