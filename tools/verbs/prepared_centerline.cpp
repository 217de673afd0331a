#include "verbs/prepared_centerline.h"

#include <algorithm>

#include "vmesh/centerline/branches.h"
#include "vmesh/volume/vessel_field.h"

#include "report/generate_log.h"

namespace vmesh::tool {
namespace {

/// Leaves out the nodes that the surface does not need. Without a value all are needed; or the budget decides, for
/// every surface that is tried, which are.
std::optional<SimplifiedCenterline> simplify(const Centerline& centerline, const GenerateArguments& arguments) {
  const GenerateOptions& options = arguments.options;
  if (arguments.budget || options.growth == GrowthMethod::paper || options.simplification == 0) return std::nullopt;
  std::optional<SimplifiedCenterline> simplified = simplify_for_growth(centerline, options);
  if (!simplified->is_simpler()) return std::nullopt;
  return simplified;
}

/// Finds where vessels touch and, when asked to, narrows or moves them. Without a value the vessels stay as they are.
std::optional<SeparatedCenterline> handle_contacts(GenerateReport& report, const Centerline& centerline,
                                                   Console& console) {
  const GenerateArguments& arguments = *report.arguments;
  if (arguments.overlap == OverlapHandling::keep) {
    report.contacts = find_contacts(VesselField(centerline, arguments.options.blend), arguments.gap);
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

/// A binding to segments of a separated centerline, as one to those of the original.
std::vector<CenterlineBinding> original_binding(const std::vector<CenterlineBinding>& binding,
                                                const SeparatedCenterline& separated, const Centerline& original) {
  std::vector<CenterlineBinding> result;
  result.reserve(binding.size());
  for (const auto& [segment, t] : binding) {
    if (segment < separated.pieces.size()) {
      const SegmentPiece& piece = separated.pieces[segment];
      result.push_back({piece.segment, piece.original_t(t)});
    } else {  // an isolated node
      result.push_back({static_cast<Index>(segment - separated.pieces.size() + original.segments().size()), t});
    }
  }
  return result;
}

/// Nodes and segments of a separated centerline, as those of the original; nodes that were added are left out.
void renumber(std::vector<Defect>& defects, const SeparatedCenterline& separated, const Centerline& original) {
  const std::vector<Branch> branches = find_branches(original);
  for (Defect& defect : defects) {
    if (defect.segment < separated.pieces.size()) defect.segment = separated.pieces[defect.segment].segment;
    if (defect.node >= original.nodes().size()) defect.node = kNone;
    defect.branch = kNone;
    for (Index b = 0; b < branches.size(); ++b) {
      const auto& segments = branches[b].segments;
      if (std::find(segments.begin(), segments.end(), defect.segment) != segments.end()) defect.branch = b;
    }
  }
}

void renumber(GrowthSummary& growth, const SeparatedCenterline& separated, const Centerline& original) {
  for (GrowthSimplification& note : growth.simplifications) {
    std::erase_if(note.nodes, [&](Index n) { return n >= original.nodes().size(); });
    for (Index& s : note.segments) s = separated.pieces[s].segment;
    std::sort(note.segments.begin(), note.segments.end());
    note.segments.erase(std::unique(note.segments.begin(), note.segments.end()), note.segments.end());
  }
}

void refer_to_original(const SimplifiedCenterline& simplified, ContactSide& side) {
  const auto [segment, t] = simplified.original(side.segment, side.t);
  side.segment = segment;
  side.t = t;
}

/// Contacts and moves of a simplified centerline, as those of the original. Branches are the same.
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
  prepared.separated = handle_contacts(report, prepared.unseparated(), console);
  return prepared;
}

void refer_to_cleaned(const PreparedCenterline& prepared, GenerateResult& result, GenerateReport& report) {
  if (prepared.separated) {
    result.binding = original_binding(result.binding, *prepared.separated, prepared.unseparated());
    renumber(result.growth, *prepared.separated, prepared.unseparated());
    renumber(result.defects, *prepared.separated, prepared.unseparated());
  }
  if (prepared.simplified) {
    vmesh::refer_to_original(*prepared.simplified, result);
    refer_to_original(*prepared.simplified, report);
  }
}

}  // namespace vmesh::tool
