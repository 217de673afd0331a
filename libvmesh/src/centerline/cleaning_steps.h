// The steps of clean(), internal to the module.
#pragma once

#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/core/disjoint_sets.h"

namespace vmesh::cleaning {

/// Adjacency of a list of segments, each node's segments in ascending order.
struct Adjacency {
  std::vector<Index> offsets, segments;

  Adjacency(std::size_t node_count, const std::vector<CenterlineSegment>& list);
  std::size_t degree(Index n) const { return offsets[n + 1] - offsets[n]; }
};

/// The graph while it is cleaned. Nodes keep their raw indices; merged nodes share a representative.
struct Workspace {
  const RawCenterline& raw;
  const CleaningOptions& options;
  std::vector<CenterlineNode> nodes;        // a representative's radius is the first one > 0 of its set
  std::vector<CenterlineSegment> segments;  // between raw nodes; see compact()
  std::vector<Index> raw_segment;           // of every segment; kNone for added ones
  std::vector<char> is_path_start;          // per node: a polyline begins here
  DisjointSets merged;
  CleaningReport report;

  Workspace(const RawCenterline& raw_centerline, const CleaningOptions& cleaning_options);

  void add(CleaningAction::Kind kind, CleaningAction::Element element, Index index, std::string message) {
    report.actions.push_back({kind, element, index, std::move(message)});
  }
  /// Distance below which nodes `a` and `b` count as one.
  double tolerance(Index a, Index b) const { return options.tolerance * std::min(nodes[a].radius, nodes[b].radius); }
  double distance(Index a, Index b) const { return (nodes[a].position - nodes[b].position).norm(); }
  /// Joins the sets of `a` and `b`; the lower representative's position is kept.
  void merge(Index a, Index b);
  /// Replaces the ends of all segments by their representatives; drops segments whose ends coincide.
  void compact();
};

void round_to_grid(Workspace& work);
void merge_trunks(Workspace& work);
void merge_overlaps(Workspace& work);
void contract_short_segments(Workspace& work);
void merge_coincident_nodes(Workspace& work);
void remove_duplicate_segments(Workspace& work);
void repair_radii(Workspace& work);
/// As RawCenterline::join_ends asks for.
void join_ends(Workspace& work);
void join_gaps(Workspace& work);
/// The sections of the raw centerline that are at ends of the cleaned one; the others are reported.
void keep_end_sections(Workspace& work, CleanedCenterline& cleaned);
CleanedCenterline build(Workspace& work);

}  // namespace vmesh::cleaning
