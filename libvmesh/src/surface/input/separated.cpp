#include <algorithm>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/ascending.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"

namespace vmesh {
namespace {

CenterlineBinding original_place(const CenterlineBinding& place, const SeparatedCenterline& separated,
                                 const Centerline& original) {
  if (place.segment < separated.pieces.size()) {
    const SegmentPiece& piece = separated.pieces[place.segment];
    return {piece.segment, piece.original_t(place.t)};
  }
  // an isolated node
  return {static_cast<Index>(place.segment - separated.pieces.size() + original.segments().size()), place.t};
}

std::vector<Index> branch_of_segment(const Centerline& centerline) {
  std::vector<Index> result(centerline.segments().size(), kNone);
  const std::vector<Branch> branches = find_branches(centerline);
  for (Index b = 0; b < branches.size(); ++b) {
    for (const Index s : branches[b].segments) result[s] = b;
  }
  return result;
}

void renumber(std::vector<Defect>& defects, const SeparatedCenterline& separated, const Centerline& original) {
  if (defects.empty()) return;
  const std::vector<Index> branch = branch_of_segment(original);
  for (Defect& defect : defects) {
    if (defect.segment < separated.pieces.size()) defect.segment = separated.pieces[defect.segment].segment;
    if (defect.node >= original.nodes().size()) defect.node = kNone;
    defect.branch = defect.segment < branch.size() ? branch[defect.segment] : kNone;
  }
}

void renumber(GrowthSummary& growth, const SeparatedCenterline& separated, const Centerline& original) {
  for (GrowthSimplification& note : growth.simplifications) {
    std::erase_if(note.nodes, [&](Index n) { return n >= original.nodes().size(); });
    for (Index& s : note.segments) s = separated.pieces[s].segment;
    sort_unique(note.segments);
  }
}

}  // namespace

void refer_to_original(const SeparatedCenterline& separated, const Centerline& original, GenerateResult& result) {
  for (CenterlineBinding& place : result.binding) place = original_place(place, separated, original);
  renumber(result.growth, separated, original);
  renumber(result.defects, separated, original);
}

}  // namespace vmesh
