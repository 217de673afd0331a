#include "vmesh/production/prepared_centerline.h"

#include <algorithm>

#include "vmesh/core/memory.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {
namespace {

/// Without the nodes that the surface does not need; nullopt if it needs all.
std::optional<SimplifiedCenterline> simplified(const Centerline& centerline, const GenerateOptions& growth) {
  if (growth.growth == GrowthMethod::paper || growth.simplification == 0) return std::nullopt;
  std::optional<SimplifiedCenterline> simplified = simplify_for_growth(centerline, growth);
  if (!simplified->is_simpler()) return std::nullopt;
  return simplified;
}

void refer(const SimplifiedCenterline& simplified, ContactSide& side) {
  const auto [segment, t] = simplified.original(side.segment, side.t);
  side.segment = segment;
  side.t = t;
}

}  // namespace

PreparedCenterline prepare_centerline(const Centerline& original, const GenerateOptions& growth,
                                      const PreparationOptions& options, const Progress& progress) {
  PreparedCenterline prepared;
  prepared.original = &original;
  if (options.simplify) prepared.simplified = simplified(original, growth);
  release_freed_memory();
  if (!options.separate) {
    prepared.kept_contacts = find_contacts(ConeRelations(prepared.unseparated(), growth.blend), options.gap);
    return prepared;
  }
  SeparationOptions separation;
  separation.gap = options.gap;
  separation.blend = growth.blend;
  prepared.separated = separate_contacts(prepared.unseparated(), separation, progress);
  return prepared;
}

// Separation keeps the numbers; simplification keeps all ends.
std::vector<EndSection> sections_of_grown(const PreparedCenterline& prepared, std::vector<EndSection> sections) {
  if (!prepared.simplified) return sections;
  const std::vector<Index>& kept = prepared.simplified->node;  // ascending
  for (EndSection& section : sections)
    section.node = static_cast<Index>(std::lower_bound(kept.begin(), kept.end(), section.node) - kept.begin());
  return sections;
}

void refer_to_original(const PreparedCenterline& prepared, GenerateResult& result) {
  if (prepared.separated) refer_to_original(*prepared.separated, prepared.unseparated(), result);
  if (prepared.simplified) refer_to_original(*prepared.simplified, result);
}

void refer_to_original(const PreparedCenterline& prepared, std::vector<Contact>& contacts) {
  if (!prepared.simplified) return;
  for (Contact& contact : contacts) {
    for (ContactSide& side : contact.sides) refer(*prepared.simplified, side);
  }
}

void refer_to_original(const PreparedCenterline& prepared, SeparationReport& report) {
  refer_to_original(prepared, report.before);
  refer_to_original(prepared, report.left);
  if (!prepared.simplified) return;
  for (VesselMove& move : report.moves) {
    refer(*prepared.simplified, move.moved);
    refer(*prepared.simplified, move.other);
  }
}

}  // namespace vmesh
