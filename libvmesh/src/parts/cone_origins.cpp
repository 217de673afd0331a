#include "vmesh/core/ascending.h"
#include "vmesh/parts/part_files.h"

namespace vmesh {

SimplifiedCenterline::Place ConeOrigins::original(Index cone, double t) const {
  const double u = stretch[cone].at(t);
  const auto of_cone = std::span(pieces).subspan(offsets[cone], offsets[cone + 1] - offsets[cone]);
  const auto [segment, v] = place_on(of_cone, u);
  return {segment, within[offsets[cone] + piece_at(of_cone, u)].at(v)};
}

void ConeOrigins::refer_to_original(GrowthSimplification& note) const {
  for (Index& n : note.nodes) n = node[n];
  std::erase(note.nodes, kNone);
  std::vector<Index> segments;
  for (const Index cone : note.segments) {
    for (Index p = offsets[cone]; p < offsets[cone + 1]; ++p) segments.push_back(pieces[p].segment);
  }
  sort_unique(segments);
  note.segments = std::move(segments);
}

StoredPartSurface refer_to_read(const StoredPart& part, PartSurface surface) {
  StoredPartSurface stored;
  stored.id = part.id;
  const std::vector<Index>& cones = part.part.field.cone;
  for (const CenterlineBinding& binding : surface.binding) {
    const Index cone = place_in(cones, binding.segment);
    stored.place.push_back(part.origins.original(cone, binding.t));
    stored.branch.push_back(part.origins.branch[cone]);
  }
  for (GrowthSimplification& note : surface.simplifications) {
    for (Index& n : note.nodes) n = place_in(part.part.field.node, n);
    for (Index& c : note.segments) c = place_in(cones, c);
    part.origins.refer_to_original(note);
  }
  stored.surface = std::move(surface);
  return stored;
}

}  // namespace vmesh
