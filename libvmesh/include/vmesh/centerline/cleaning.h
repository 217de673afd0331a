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
  /// Polylines that begin or end in one place count as one for as long as their positions and radii differ by less than
  /// this times the radius, or by twice that before they come back: paths from one inlet to every outlet repeat the
  /// trunk, and once they are resampled or smoothed not with the same points. The earlier one's geometry is kept. What
  /// runs side by side for less than two radii is left as it is. 0: all is.
  double overlap_tolerance = 0.1;
  /// Join the start of a branch to the nearest node of another component that is closer than that node's radius.
  /// Unset: when the file's kind has loose branches (RawCenterline::loose_branches).
  std::optional<bool> join_gaps;
  /// Round positions and radii to a decimal grid: 1e-6 mm, or the power of ten below 1e-4 of the smallest radius where
  /// that is finer. It makes a tree that was stored with six decimals and with all digits the same tree.
  bool round = true;
  /// Renumber nodes and segments by geometry alone, so that the order of the file does not matter: depth first, the
  /// thicker neighbour first, every component from its thickest end; components by the radius of that end, thickest
  /// first; ties by position (x, then y, then z). A segment runs from its lower to its higher node.
  /// Otherwise the order is the file's.
  bool canonical_order = true;
};

/// One thing that cleaning did. Positions and indices are those of the raw centerline.
struct CleaningAction {
  enum class Kind {
    rounded,                    ///< all positions and radii were rounded
    removed_self_loop,          ///< a segment from a node to itself
    merged_trunk,               ///< the beginning of a polyline repeats an earlier one
    merged_overlap,             ///< one end of a polyline runs along earlier ones
    contracted_segment,         ///< a segment of no length: its nodes became one
    merged_node,                ///< a node at the place of another
    kept_crossing,              ///< two nodes at one place were left apart: joining them would close a loop
    removed_duplicate_segment,  ///< a segment between nodes that are joined already
    repaired_radius,            ///< a zero radius was interpolated along the graph
    joined_gap,                 ///< a segment was added from a branch's loose end to its parent
  };
  using Element = CenterlineProblem::Element;

  Kind kind;
  Element element;
  Index index;          ///< of the raw node or segment; kNone for the graph
  std::string message;  ///< names file and line or element, what was done, and why
};

/// "rounded", "merged_trunk" ...
std::string_view to_string(CleaningAction::Kind kind);

/// Everything cleaning did, in the order done.
struct CleaningReport {
  std::vector<CleaningAction> actions;

  std::size_t count(CleaningAction::Kind kind) const;
  /// At most one line per kind: the first action's message and how many more there are. For logs.
  std::vector<std::string> summary() const;
};

struct CleanedCenterline {
  Centerline centerline;
  CleaningReport report;
  std::vector<Index> raw_node;     ///< for every node, the raw node it stems from (the first of those merged)
  std::vector<Index> raw_segment;  ///< for every segment, the raw segment; kNone for a joined gap
};

/// Turns a raw centerline into a valid one. Deterministic; time near linear in the number of nodes.
/// Nodes are merged where polylines begin with the same points (VMTK repeats the trunk for every target), where a
/// segment has no length, and where a node coincides with another one of which at least one is an end. Interior nodes
/// that coincide, and all nodes of a format that knows trees only, are merged only when that closes no loop. A zero
/// radius becomes the distance-weighted mean of the two nearest radii along the graph. Precondition: `raw` is in mm and
/// LPS (convert_to_internal), else InvalidInput. Throws InvalidInput that names file and line or element for: no nodes,
/// non-finite numbers, negative radii, segments to unknown nodes, a component without any radius.
CleanedCenterline clean(const RawCenterline& raw, const CleaningOptions& options = {});

}  // namespace vmesh
