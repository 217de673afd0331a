#include "verbs/part_origins.h"

#include "vmesh/surface/branch_labels.h"

namespace vmesh::tool {

SplitCenterline::SplitCenterline(PreparedCenterline prepared, const GenerateOptions& options)
    : prepared_(std::move(prepared)),
      cleaned_segments_(static_cast<Index>(prepared_.original->segments().size())),
      segments_(static_cast<Index>(prepared_.grown().segments().size())),
      unseparated_nodes_(static_cast<Index>(prepared_.unseparated().nodes().size())),
      options_(prepared_.simplified ? after_simplification(options, *prepared_.simplified) : options),
      label_(branch_label_of_cones(*prepared_.original)) {
  if (options_.simplification == 0) return;
  again_ = simplify_for_growth(prepared_.grown(), options_);
  if (!again_->is_simpler()) again_.reset();
  if (again_) segments_ = static_cast<Index>(again_->centerline.segments().size());
  options_.simplification = 0;
}

Centerline SplitCenterline::take_centerline() {
  if (again_) return std::move(again_->centerline);
  if (prepared_.separated) return std::move(prepared_.separated->centerline);
  if (prepared_.simplified) return std::move(prepared_.simplified->centerline);
  return *prepared_.original;
}

ConeOrigins SplitCenterline::origins_of(const std::vector<Index>& nodes, const std::vector<Index>& cones) const {
  ConeOrigins origins;
  origins.offsets.push_back(0);
  for (const Index cone : cones) {
    if (cone < segments_) {
      add(cone, origins);
    } else {  // an isolated node
      origins.stretch.emplace_back();
      origins.pieces.push_back({cone - segments_ + cleaned_segments_, 0, 0, 1});
      origins.within.emplace_back();
    }
    origins.branch.push_back(label_[origins.pieces.back().segment]);
    origins.offsets.push_back(static_cast<Index>(origins.pieces.size()));
  }
  for (Index n : nodes) {
    if (again_) n = again_->node[n];
    if (prepared_.separated && n >= unseparated_nodes_) {
      origins.node.push_back(kNone);
    } else {
      origins.node.push_back(prepared_.simplified ? prepared_.simplified->node[n] : n);
    }
  }
  return origins;
}

void SplitCenterline::add(Index cone, ConeOrigins& origins) const {
  const auto& separated = prepared_.separated;
  if (again_) {
    origins.stretch.emplace_back();
    for (Index p = again_->offsets[cone]; p < again_->offsets[cone + 1]; ++p) {
      SimplifiedCenterline::Piece piece = again_->pieces[p];
      ConeOrigins::Stretch within;
      if (separated) {
        const SegmentPiece& of = separated->pieces[piece.segment];
        within = {of.t_first, of.t_last};
        piece.segment = of.segment;
      }
      origins.pieces.push_back(piece);
      origins.within.push_back(within);
    }
    return;
  }
  Index segment = cone;
  origins.stretch.emplace_back();
  if (separated) {
    const SegmentPiece& of = separated->pieces[cone];
    origins.stretch.back() = {of.t_first, of.t_last};
    segment = of.segment;
  }
  const auto& simplified = prepared_.simplified;
  const Index begin = simplified ? simplified->offsets[segment] : 0,
              end = simplified ? simplified->offsets[segment + 1] : 1;
  for (Index p = begin; p < end; ++p) {
    origins.pieces.push_back(simplified ? simplified->pieces[p] : SimplifiedCenterline::Piece{segment, 0, 0, 1});
    origins.within.emplace_back();
  }
}

}  // namespace vmesh::tool
