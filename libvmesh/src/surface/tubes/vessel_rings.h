#pragma once

#include <span>
#include <vector>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/remesh/elongated_metric.h"
#include "surface/tubes/branch_axis.h"
#include "surface/tubes/elongation_profile.h"

namespace vmesh {

/// A plane across a branch.
struct CrossSection {
  double place = 0;  ///< on the branch
  Vec3 center = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< along the branch, towards its last node
  double radius = 0;
};

/// A point on the boundary of a cone.
struct RingPoint {
  Vec3 position;
  Index cone = kNone;
};

/// A ring of vertices around a branch, on the vessel boundary, counter-clockwise about `normal`.
struct Ring : CrossSection {
  std::span<const RingPoint> points;  ///< empty if any of them is not visible from the axis
  double radii = 0, step = 0;         ///< its place and the distance of rings, as integrals of ds / radius
  double elongation = 1;  ///< how much longer than wide triangles may be here, see GenerateOptions::elongation
  /// Vector of the metric in which bands are even, see ElongatedMetric.
  Vec3 metric() const { return ElongatedMetric::vector(normal, elongation); }
  bool clear = false;  ///< no other vessel, nor a far part of this one, covers the cross-section or comes close
  bool free = false;   ///< clear, and the boundary is visible from the axis all around
};

/// The cross-section half a step before a ring or, with `after`, after it.
CrossSection section_beside(const BranchAxis& axis, const Ring& ring, bool after);

/// Rings and their points. Movable, not copyable: rings refer to the points by address.
struct Rings {
  Rings() = default;
  Rings(Rings&&) = default;
  Rings& operator=(Rings&&) = default;

  std::vector<Ring> rings;
  std::vector<RingPoint> points;
  ElongationProfile elongation;
};

/// Distance in radii between rings of `around` vertices whose band consists of nearly equilateral triangles.
double ring_pitch(int around);

/// How rings are laid.
struct RingOptions {
  int around;
  Placement placement = Placement::inscribed;
  ErrorLimit limit = {};       ///< no ring is lifted beyond it
  double elongation = 1;       ///< the most that rings lie farther apart than evenly
  bool ring_per_node = false;  ///< they lie no farther apart than nodes
  double spacing = 1;          ///< times the distance of even triangles

  double pitch() const { return spacing * ring_pitch(around); }
  static RingOptions of(const GenerateOptions& o) {
    return {o.around, o.placement, o.max_error, o.elongation, o.deformable, o.ring_spacing};
  }
};

/// Where a segment lies: its branch and its number there.
struct BranchPlace {
  Index branch = kNone;
  Index nth = kNone;
};

/// Lays rings of `around` vertices along branches, evenly in units of the local radius, each turned half a step against
/// the one before: bands of nearly equilateral triangles. The first and the last ring lie at the branch's ends. Rings
/// that are clear but not free (at a step in the radius or a sharp bend) are left out where the band between their
/// neighbours stays short. Where a run of free rings begins or ends away from a tip, the cross-section half a step
/// further out is free as well. With an elongation, the rings of every such run are laid again, as far apart as the
/// error allows.
class RingLayer {
 public:
  RingLayer(const VesselField& field, const std::vector<BranchAxis>& axes, const std::vector<BranchPlace>& places,
            const RingOptions& options);

  Rings lay(Index branch) const;

  /// The direction of the vessel, bends smoothed.
  Vec3 direction_at(Index branch, double place) const;

  /// The ring's points as balanced placement lifts them off the boundary, so that the volume is kept.
  std::vector<RingPoint> lifted(Index branch, const Ring& ring) const;

  /// Keeps free only rings that can end a tube: where a run of free rings begins or ends away from a tip, the
  /// cross-section half a step further out must be free as well. `loop`: the first ring follows the last one.
  void clear_ends(Index branch, std::vector<Ring>& rings, bool loop) const;

 private:
  Rings lay_evenly(Index branch, std::vector<Vec3>& sides) const;
  Vec3 reference(Index branch, const Vec3& normal) const;
  Index segment_at(Index branch, const CrossSection& section) const;
  // Appends its points to `points`, which must have capacity for them.
  Ring lay_one(Index branch, const CrossSection& section, const Vec3& side, double phase,
               std::vector<RingPoint>& points) const;

  static void leave_out_steps(std::vector<Ring>& rings, std::vector<Vec3>& sides, double least_gap);
  Rings spread(Index branch, const Rings& even, const std::vector<Vec3>& sides) const;
  // Rings in place of those of a run; none where one of them would not be free.
  std::vector<Ring> spread_run(Index branch, std::span<const Ring> run, const Vec3& side, double step,
                               ElongationProfile& profile, std::vector<RingPoint>& points) const;
  // Whether no other vessel, nor a far part of this one, covers the cross-section or comes close.
  bool is_clear(Index branch, const CrossSection& section, const BranchAxis::Point& axis, const Vec3& side,
                const Vec3& up) const;
  bool goes_through(Index branch, const CrossSection& section) const;
  bool may_be_foreign(Index branch, const CrossSection& section, Index cone) const;
  bool is_own(Index branch, const CrossSection& section, const FieldSample& sample) const;
  // Finds the boundary point visible from `center` in direction `way`; false if it does not belong to this ring alone.
  bool see(Index branch, const Ring& ring, const BranchAxis::Point& axis, const Vec3& way, RingPoint& seen) const;

  const VesselField& field_;
  const std::vector<BranchAxis>& axes_;
  const std::vector<BranchPlace>& places_;
  RingOptions options_;
};

}  // namespace vmesh
