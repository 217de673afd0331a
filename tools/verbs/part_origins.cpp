#include "verbs/part_origins.h"

#include "vmesh/surface/branch_labels.h"

namespace vmesh::tool {

SplitCenterline::SplitCenterline(const PreparedCenterline& prepared, const GenerateOptions& options)
    : prepared_(prepared),
      cleaned_segments_(static_cast<Index>(prepared.cleaned->segments().size())),
      options_(prepared.simplified ? after_simplification(options, *prepared.simplified) : options),
      label_(branch_label_of_cones(*prepared.cleaned)) {
  if (options_.simplification == 0) return;
  again_ = simplify_for_growth(prepared.grown(), options_);
  if (!again_->is_simpler()) again_.reset();
  options_.simplification = 0;
}

ConeOrigins SplitCenterline::origins_of(const std::vector<Index>& nodes, const std::vector<Index>& cones) const {
  ConeOrigins origins;
  origins.offsets.push_back(0);
  const auto segments = static_cast<Index>(centerline().segments().size());
  for (const Index cone : cones) {
    if (cone < segments) {
      add(cone, origins);
    } else {  // an isolated node
      origins.stretch.emplace_back();
      origins.pieces.push_back({cone - segments + cleaned_segments_, 0, 0, 1});
      origins.within.emplace_back();
    }
    origins.branch.push_back(label_[origins.pieces.back().segment]);
    origins.offsets.push_back(static_cast<Index>(origins.pieces.size()));
  }
  for (Index n : nodes) {
    if (again_) n = again_->node[n];
    if (prepared_.separated && n >= prepared_.unseparated().nodes().size()) {
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
