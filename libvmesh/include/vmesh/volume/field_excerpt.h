#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "vmesh/core/box_tree.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {

/// What a VesselField needs to answer local queries around some of its cones as the whole field does, to the bit:
/// these cones, all that are local to them or near, and what the whole field knows of each.
/// Cones count as in VesselField: segments, then isolated nodes.
struct FieldExcerpt {
  double blend = 0;
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Index> node, cone;  ///< their numbers in the whole, ascending both
  /// For every cone: the run that it belongs to, and how far along it the cone ends (mm).
  std::vector<Index> run;
  std::vector<double> travel;
  /// For every cone: whether all cones local to it are in the excerpt. Only such cones may be hints.
  std::vector<char> complete;
  /// The cones local to cone c, ascending: local[local_offsets[c]] to before local[local_offsets[c + 1]], and whether
  /// they part.
  std::vector<Index> local_offsets, local;
  std::vector<char> parting;
  std::vector<std::pair<Index, Index>> apart;   ///< cones that are not blended, ascending
  std::vector<std::array<double, 2>> rounding;  ///< of cones, the shares of the blend at their ends

  Centerline centerline() const { return {nodes, segments}; }
};

/// Takes excerpts of the VesselField of a centerline without making that field: for centerlines too large for one.
class FieldExcerpts {
 public:
  /// `relations` must outlive it.
  explicit FieldExcerpts(const ConeRelations& relations);

  const ConeRelations& relations() const { return relations_; }

  /// What is needed to answer queries whose hints are among `cones` and the cones local to them: everything local to
  /// these, and all cones within `reach` radii of the walls of `cones`.
  FieldExcerpt take(std::span<const Index> cones, double reach) const;

 private:
  std::vector<Index> near_boxes(std::span<const Index> cones, double reach) const;

  const ConeRelations& relations_;
  BoxTree tree_;  // of cones
};

/// The union of several excerpts of one field. Throws InvalidInput for an inconsistent one.
FieldExcerpt merged(std::span<const FieldExcerpt> excerpts);

}  // namespace vmesh
