#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/progress.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {

/// One of the two vessels at a contact.
struct ContactSide {
  Index segment = kNone;  ///< cone of the field: a segment, or segments().size() + the rank of an isolated node
  double t = 0;           ///< parameter on its axis, in [0, 1]
  Index branch = kNone;   ///< in find_branches(); kNone for an isolated node
  double radius = 0;      ///< of the vessel there, mm
};

/// A region where two vessels come close in space without being neighbours along the graph: their cones are not local
/// to each other (ConeRelations::local_cones), so each gets a wall of its own and the walls meet.
struct Contact {
  Vec3 position =
      Vec3::Zero();  ///< midway between the two walls where they are closest relative to the smaller radius, mm
  double depth = 0;  ///< sum of the radii minus the distance of the axes, mm; negative where there is a gap
  std::array<ContactSide, 2> sides;
  std::size_t cone_pairs = 0;  ///< pairs of cones in this region, each sharing a node with the next on either side
};

/// All regions where vessels that are not neighbours come closer than `gap` times the smaller of their radii. Each is
/// described at its deepest pair of cones. Deepest first, ties by segments. Time is near linear in the cones and linear
/// in the pairs of cones whose boxes overlap. At a fork, the walls count as two vessels once more is between them than
/// rounding at branches fills: the blend, at least 0.1 and at most 0.5 smaller radii. A gap of at most 0.8 of that is
/// required of them there. Rounding counts where it narrows the gap, up to a fifth of the sum of the radii. Throws
/// InvalidInput unless `gap` is in [0, 1].
std::vector<Contact> find_contacts(const ConeRelations& cones, double gap);

struct SeparationOptions {
  double gap = 0.1;         ///< gap to be left between two vessels, in smaller (narrowed) radii; in (0, 1]
  double blend = 0.5;       ///< blend of the field that the surface will be grown in
  double taper = 0.25;      ///< how fast the radius may return: narrowed share of the radius lost per radius of length
  double most_taken = 0.9;  ///< a contact that needs a larger share of a radius is left as it is; in (0, 1)
  int max_rounds = 40;      ///< rounds of finding contacts and narrowing at them
  /// Where a contact would take a larger share of a radius, the vessels are first moved apart until no more than this
  /// is taken; in (0, 1]. From most_taken on, or with max_moves 0, no vessel is moved.
  double move_beyond = 0.5;
  double slope = 0.5;  ///< largest sideways displacement of an axis per length of it; in (0, 0.5]
  int max_moves = 40;  ///< rounds of finding contacts and moving vessels
};

/// One vessel that was moved away from another at a contact.
struct VesselMove {
  Vec3 position = Vec3::Zero();      ///< on the axis of the original vessel
  Vec3 displacement = Vec3::Zero();  ///< the largest displacement of the axis by this move, mm
  ContactSide moved, other;          ///< of the original centerline
};

/// The interval of an original segment that a segment of the narrowed centerline covers.
struct SegmentPiece {
  Index segment = kNone;
  double t_first = 0, t_last = 1;  ///< parameters on it of the narrowed segment's nodes a and b

  double original_t(double t) const { return t_first + t * (t_last - t_first); }
};

/// What separating vessels changed. Segments are those of the original centerline.
struct SeparationReport {
  std::vector<Contact> before;  ///< contacts of the original centerline
  /// Remaining contacts: the axes are so close that no radius, or too little of it, would remain, and they could not be
  /// moved apart, or the rounds ran out.
  std::vector<Contact> left;
  double max_taken = 0;                                    ///< the largest loss of a node's radius, mm
  double max_taken_relative = 0, mean_taken_relative = 0;  ///< of the original radius; the mean is over changed nodes
  Vec3 max_taken_at = Vec3::Zero();                        ///< where max_taken_relative was taken
  std::size_t nodes_narrowed = 0;  ///< nodes of the result narrower than the original vessel there
  std::vector<VesselMove> moves;   ///< farthest first, in radii; a vessel may be moved more than once
  /// The largest displacement of an axis by all moves together, in mm and in original local radii.
  double max_moved = 0, max_moved_relative = 0;
  Vec3 max_moved_at = Vec3::Zero();  ///< where max_moved_relative was reached, on the original axis
  double steepest_move = 0;          ///< the largest change of the displacement per length of an axis
  std::size_t nodes_moved = 0;       ///< nodes of the result that are off the original axis
  std::size_t nodes_added = 0;
  int rounds = 0;
};

struct SeparatedCenterline {
  /// The original nodes in their order, then those added on segments.
  Centerline centerline;
  std::vector<SegmentPiece> pieces;  ///< one per segment of `centerline`
  SeparationReport report;
};

/// Narrows the vessels of `centerline` where they touch without being neighbours, both by the same share, until
/// `options.gap` is free between them. From there the radius returns along the graph, also across branching nodes, with
/// a bounded slope: over a stretch of length l it grows by at most taper * l more than it did before. Nodes are added
/// so that this stays local. Where that would take more than options.move_beyond of a radius, the thinner vessel is
/// first moved aside: away from the other's axis, or perpendicular to both where they cross, far enough that no more
/// than this share is needed, at most 2.2 times the sum of the radii. Along the graph, also across branching nodes, a
/// move fades out with a slope of at most options.slope; where several moves meet, the slope of the axis is at most
/// 0.95. Moves are kept only if they leave fewer contacts, or none; where they were in vain, the other vessel or the
/// opposite direction is tried. The result has no contacts at that gap except those reported as left: axes that cross
/// close to a common node or coincide over a long distance may stay. Deterministic. Throws InvalidInput for options out
/// of range, Cancelled when `progress` asks to stop.
SeparatedCenterline separate_contacts(const Centerline& centerline, const SeparationOptions& options = {},
                                      const Progress& progress = {});

/// "at (x, y, z): segments i and j (branches k and l) overlap by 0.4 mm, 32 % of the radius".
std::string describe(const Contact& contact);

}  // namespace vmesh
