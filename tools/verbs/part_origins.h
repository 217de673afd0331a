#pragma once

#include "vmesh/parts/part_files.h"
#include "vmesh/production/prepared_centerline.h"

namespace vmesh::tool {

/// The prepared centerline that is split, and the origins of its cones on the cleaned one. Like generate_surface(),
/// leaves nodes out of separated vessels if none were left out before.
class SplitCenterline {
 public:
  SplitCenterline(PreparedCenterline prepared, const GenerateOptions& options);

  /// The centerline that is split; to be called once. A copy only if it is the cleaned one.
  Centerline take_centerline();
  const GenerateOptions& options() const { return options_; }
  /// Origins of nodes and cones of the centerline that is split.
  ConeOrigins origins_of(const std::vector<Index>& nodes, const std::vector<Index>& cones) const;

 private:
  void add(Index cone, ConeOrigins& origins) const;

  PreparedCenterline prepared_;
  std::optional<SimplifiedCenterline> again_;
  Index cleaned_segments_, segments_, unseparated_nodes_;  // how many
  GenerateOptions options_;
  std::vector<Index> label_;  // of cones of the cleaned centerline
};

}  // namespace vmesh::tool
