#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/centerline/validation.h"

namespace vmesh {

struct CleaningOptions {
  /// Points closer than this times the smaller of their radii count as one.
  double tolerance = 1e-3;
  /// Polylines that begin or end at the same place are merged as long as their positions and radii differ by less than
  /// this times the radius (temporarily up to twice that): paths from one inlet to every outlet repeat the trunk, and
  /// after resampling or smoothing not with the same points. The earlier polyline's geometry is kept. Overlaps shorter
  /// than two radii are left as they are. 0 disables merging.
  double overlap_tolerance = 0.1;
  /// Join the start of a branch to the nearest node of another component if it is closer than that node's radius.
  /// Unset: only for files whose kind has loose branches (RawCenterline::loose_branches).
  std::optional<bool> join_gaps;
  /// Round positions and radii to a decimal grid: 1e-6 mm, or the power of ten below 1e-4 of the smallest radius if
  /// that is finer. A tree stored with six decimals thus becomes the same as one stored with all digits.
  bool round = true;
  /// Renumber nodes and segments by geometry alone, so that their order in the file does not matter: depth first,
  /// thicker neighbours first, every component from its thickest end; components by the radius of that end, thickest
  /// first; ties by position (x, then y, then z). A segment runs from its lower to its higher node. Otherwise the
  /// file's order is kept.
  bool canonical_order = true;
};

/// One thing that cleaning did. Positions and indices are those of the raw centerline.
struct CleaningAction {
  enum class Kind {
    rounded,                    ///< all positions and radii were rounded
    removed_self_loop,          ///< a segment from a node to itself
    merged_trunk,               ///< the beginning of a polyline repeats an earlier one
    merged_overlap,             ///< one end of a polyline runs along earlier ones
    contracted_segment,         ///< a segment of zero length: its nodes became one
    merged_node,                ///< a node at the position of another
    kept_crossing,              ///< two nodes at one position were left apart: merging them would close a loop
    removed_duplicate_segment,  ///< a segment between nodes that are joined already
    repaired_radius,            ///< a zero radius was interpolated along the graph
    joined_gap,                 ///< a segment was added from a branch's loose end to its parent
    joined_ends,                ///< a segment was added between two ends (RawCenterline::join_ends)
    dropped_end_section,        ///< a flat end is at no end of the centerline any more, or beside it
  };
  using Element = CenterlineProblem::Element;

  Kind kind;
  Element element;
  Index index;          ///< of the raw node or segment; kNone for the graph
  std::string message;  ///< file and line or element, what was done, and why
};

/// "rounded", "merged_trunk" ...
std::string_view to_string(CleaningAction::Kind kind);

/// Everything cleaning did, in the order done.
struct CleaningReport {
  std::vector<CleaningAction> actions;

  std::size_t count(CleaningAction::Kind kind) const;
  /// At most one line per kind, for logs: the first action's message and how many more there are.
  std::vector<std::string> summary() const;
};

struct CleanedCenterline {
  Centerline centerline;
  CleaningReport report;
  std::vector<Index> raw_node;     ///< for every node, the raw node it stems from (the first of those merged)
  std::vector<Index> raw_segment;  ///< for every segment, the raw segment; kNone for joined gaps and ends
  std::vector<EndSection> end_sections = {};  ///< ascending in their nodes, at most one per end; of `centerline`
};

/// Turns a raw centerline into a valid one. Deterministic; time near linear in the number of nodes. Nodes are merged
/// where polylines begin with the same points (VMTK repeats the trunk for every target), where a segment has zero
/// length, and where two nodes coincide of which at least one is an end. Coinciding interior nodes, and all nodes of a
/// format that only knows trees, are merged only if that closes no loop. A zero radius becomes the distance-weighted
/// mean of the two nearest radii along the graph. A flat end
/// (EndSection) stays if its node still is an end, and within the radius of its area from its centre. Precondition:
/// `raw` is in mm and LPS (convert_to_internal), else InvalidInput. Throws InvalidInput naming file and line or element
/// for: no nodes, non-finite numbers, negative radii, segments to unknown nodes, invalid flat ends, a component without
/// any radius.
CleanedCenterline clean(const RawCenterline& raw, const CleaningOptions& options = {});

}  // namespace vmesh
