#pragma once

#include "vmesh/parts/part_files.h"

#include "verbs/prepared_centerline.h"

namespace vmesh::tool {

/// The centerline that is split: the prepared one, and what of the cleaned one its cones stand for. As
/// generate_surface() does, nodes are left out of vessels that were separated if none were before.
class SplitCenterline {
 public:
  SplitCenterline(const PreparedCenterline& prepared, const GenerateOptions& options);

  const Centerline& centerline() const { return again_ ? again_->centerline : prepared_.grown(); }
  const GenerateOptions& options() const { return options_; }
  /// Of nodes and cones of the centerline that is split.
  ConeOrigins origins_of(const std::vector<Index>& nodes, const std::vector<Index>& cones) const;

 private:
  void add(Index cone, ConeOrigins& origins) const;
  SimplifiedCenterline::Piece piece_of(Index segment) const;

  const PreparedCenterline& prepared_;
  std::optional<SimplifiedCenterline> again_;
  GenerateOptions options_;
  std::vector<Index> label_;  // of cones of the cleaned centerline
};

}  // namespace vmesh::tool
