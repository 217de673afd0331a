#include "verbs/prepared_centerline.h"

#include <algorithm>

#include "vmesh/core/memory.h"
#include "vmesh/volume/cone_relations.h"

#include "report/generate_log.h"

namespace vmesh::tool {
namespace {

/// Leaves out the nodes that the surface does not need; nullopt if all are needed, or if a budget decides for every
/// trial.
std::optional<SimplifiedCenterline> simplify(const Centerline& centerline, const GenerateArguments& arguments) {
  const GenerateOptions& options = arguments.options;
  if (arguments.budget || options.growth == GrowthMethod::paper || options.simplification == 0) return std::nullopt;
  std::optional<SimplifiedCenterline> simplified = simplify_for_growth(centerline, options);
  if (!simplified->is_simpler()) return std::nullopt;
  return simplified;
}

/// Finds where vessels touch and, if requested, narrows or moves them; nullopt if the vessels stay as they are.
std::optional<SeparatedCenterline> handle_contacts(GenerateReport& report, const Centerline& centerline,
                                                   Console& console) {
  const GenerateArguments& arguments = *report.arguments;
  if (arguments.overlap == OverlapHandling::keep) {
    report.contacts = find_contacts(ConeRelations(centerline, arguments.options.blend), arguments.gap);
    if (!report.contacts.empty()) warn_of_contacts(report, console);
    return std::nullopt;
  }
  SeparationOptions options;
  options.gap = arguments.gap;
  options.blend = arguments.options.blend;
  SeparatedCenterline separated = separate_contacts(centerline, options, console.progress());
  const SeparationReport& separation = separated.report;
  report.contacts = separation.before;
  log_separation(separation, console);
  warn_of_contacts_left(report, separation.left, console);
  report.separation = separation;
  return separated;
}

void refer_to_original(const SimplifiedCenterline& simplified, ContactSide& side) {
  const auto [segment, t] = simplified.original(side.segment, side.t);
  side.segment = segment;
  side.t = t;
}

/// Converts contacts and moves from a simplified centerline to the original. Branches are the same.
void refer_to_original(const SimplifiedCenterline& simplified, GenerateReport& report) {
  const auto refer = [&](std::vector<Contact>& contacts) {
    for (Contact& contact : contacts) {
      for (ContactSide& side : contact.sides) refer_to_original(simplified, side);
    }
  };
  refer(report.contacts);
  if (!report.separation) return;
  refer(report.separation->before);
  refer(report.separation->left);
  for (VesselMove& move : report.separation->moves) {
    refer_to_original(simplified, move.moved);
    refer_to_original(simplified, move.other);
  }
}

}  // namespace

PreparedCenterline prepare_centerline(GenerateReport& report, Console& console) {
  PreparedCenterline prepared;
  prepared.cleaned = &report.cleaned->centerline;
  prepared.simplified = simplify(*prepared.cleaned, *report.arguments);
  if (prepared.simplified) log_simplification(*prepared.simplified, console);
  release_freed_memory();
  prepared.separated = handle_contacts(report, prepared.unseparated(), console);
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

void refer_to_cleaned(const PreparedCenterline& prepared, GenerateResult& result, GenerateReport& report) {
  if (prepared.separated) vmesh::refer_to_original(*prepared.separated, prepared.unseparated(), result);
  if (prepared.simplified) {
    vmesh::refer_to_original(*prepared.simplified, result);
    refer_to_original(*prepared.simplified, report);
  }
}

}  // namespace vmesh::tool
