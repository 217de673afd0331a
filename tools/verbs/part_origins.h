#pragma once

#include "vmesh/parts/part_files.h"

#include "verbs/prepared_centerline.h"

namespace vmesh::tool {

/// The prepared centerline that is split, and the origins of its cones on the cleaned one. Like generate_surface(),
/// leaves nodes out of separated vessels if none were left out before.
class SplitCenterline {
 public:
  SplitCenterline(const PreparedCenterline& prepared, const GenerateOptions& options);

  const Centerline& centerline() const { return again_ ? again_->centerline : prepared_.grown(); }
  const GenerateOptions& options() const { return options_; }
  /// Origins of nodes and cones of the centerline that is split.
  ConeOrigins origins_of(const std::vector<Index>& nodes, const std::vector<Index>& cones) const;

 private:
  void add(Index cone, ConeOrigins& origins) const;
  SimplifiedCenterline::Piece piece_of(Index segment) const;

  const PreparedCenterline& prepared_;  // its cleaned centerline, if simplified, is not asked again
  Index cleaned_segments_;
  std::optional<SimplifiedCenterline> again_;
  GenerateOptions options_;
  std::vector<Index> label_;  // of cones of the cleaned centerline
};

}  // namespace vmesh::tool
