#pragma once

#include <array>
#include <span>

#include "vmesh/surface/part.h"

#include "surface/tubes/ring_blocks.h"

namespace vmesh {

/// Branches of a centerline, ready for rings to be laid along them.
class VesselAxes {
 public:
  /// Axes of all branches, or of these. `field` must outlive it.
  VesselAxes(const VesselField& field, const RingOptions& rings);
  VesselAxes(const VesselField& field, const RingOptions& rings, std::vector<Branch> branches);
  VesselAxes(const VesselAxes&) = delete;
  VesselAxes& operator=(const VesselAxes&) = delete;

  const VesselField& field() const { return field_; }
  const Centerline& centerline() const { return field_.relations().centerline(); }
  const std::vector<Branch>& branches() const { return branches_; }
  const std::vector<BranchAxis>& axes() const { return axes_; }
  const RingLayer& layer() const { return layer_; }

 protected:
  const BranchPlace& place_of(Index segment) const { return places_[segment]; }
  Index segment_count() const { return static_cast<Index>(places_.size()); }

 private:
  const VesselField& field_;
  std::vector<Branch> branches_;
  std::vector<BranchAxis> axes_;
  std::vector<BranchPlace> places_;
  RingLayer layer_;
};

/// The rings laid along all branches of VesselAxes, and how far apart they may be.
class VesselRings : public VesselAxes, public ElongationField {
 public:
  VesselRings(const VesselField& field, const RingOptions& rings);
  VesselRings(const VesselField& field, const RingOptions& rings, std::vector<Branch> branches);

  /// None while they are released.
  std::span<const Ring> rings(Index branch) const { return rings_.of(branch); }
  Index ring_count(Index branch) const { return counts_[branch]; }
  /// Frees the rings of a branch. What elongation_at() needs stays.
  void release(Index branch) { rings_.release(branch); }
  /// Lays those that were released, as they were; `branches`: different ones.
  void lay_again(const std::vector<Index>& branches);
  Elongation elongation_at(Index cone, double t) const override;
  /// `times` along the vessel, whatever the error; none on an isolated node.
  Elongation longest_at(Index cone, double t, double times) const;
  /// Itself, or nullptr where triangles are no longer than wide anywhere.
  const ElongationField* elongation_field() const { return elongated_ ? this : nullptr; }

 private:
  void lay_all();
  void lay(std::span<const Index> branches);

  RingBlocks rings_;
  std::vector<Index> counts_;                // rings of every branch, released or not
  std::vector<ElongationProfile> profiles_;  // likewise
  bool elongated_;
};

/// A run of consecutive free rings along a branch.
struct Tube {
  Index branch = kNone;
  std::span<const Ring> rings;                      ///< a run of GrowthSkeleton::rings
  bool starts_at_tip = false, ends_at_tip = false;  ///< closed by a cap there
  bool periodic = false;                            ///< the last ring is followed by the first
  bool starts_at_seam = false, ends_at_seam = false;

  bool starts_at_junction() const { return !starts_at_tip && !periodic && !starts_at_seam; }
  bool ends_at_junction() const { return !ends_at_tip && !periodic && !ends_at_seam; }
};

/// Rings that the tube would have if they lay evenly.
double even_rings(const Tube& tube);

/// Whether ring `k` of the tube is a seam.
inline bool is_seam(const Tube& tube, std::size_t k) {
  return (tube.starts_at_seam && k == 0) || (tube.ends_at_seam && k + 1 == tube.rings.size());
}

/// The open end of a tube at which a junction docks.
struct TubeEnd {
  Index tube = kNone;
  bool at_end = false;  ///< at its last ring; at its first otherwise
};

/// A stretch of a branch without rings, between tubes, branching nodes or both. An end without a dock is an end of the
/// branch.
struct BareStretch {
  Index branch = kNone;
  double begin = 0, end = 0;  ///< places
  std::array<TubeEnd, 2> docks;
};

/// A connected remainder of the graph that no tube covers: branching nodes and the bare stretches around them.
struct Junction {
  std::vector<Index> nodes;
  std::vector<BareStretch> bare_stretches;
};

/// The ends of tubes at which a junction docks, in the order of its bare stretches.
std::vector<TubeEnd> docks_of(const Junction& junction);

/// The graph that steers growth: junctions joined by tubes. Crowded branching nodes share a junction, sibling branches
/// become separate tubes where their cross-sections separate, and a branch without a cross-section of its own belongs
/// to a junction.
struct GrowthSkeleton {
  std::vector<std::vector<Ring>> rings;             ///< of the plan's stretches
  std::vector<std::vector<RingPoint>> seam_points;  ///< of the rings that are seams, lifted
  std::vector<Tube> tubes;
  std::vector<Junction> junctions;

  std::size_t cycle_rank() const;
  std::size_t component_count() const;
};

/// The plan of the whole surface as one piece.
PiecePlan whole_plan(const VesselRings& rings);

/// The skeleton of a piece. Rings in `covered` (ascending) are left to junctions; seams cannot be. Isolated nodes
/// become junctions without bare stretches.
GrowthSkeleton make_growth_skeleton(const VesselRings& rings, const PiecePlan& plan,
                                    const std::vector<RingPlace>& covered = {});

}  // namespace vmesh
