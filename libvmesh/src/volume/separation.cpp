#include <algorithm>
#include <cmath>
#include <set>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"
#include "vmesh/volume/contacts.h"

#include "volume/contact_pairs.h"
#include "volume/narrowing.h"

namespace vmesh {
namespace {

// More than the gap is aimed for, so that rounds of narrowing end.
constexpr double kSpare = 0.02;

void check(const SeparationOptions& options) {
  if (!(options.gap > 0 && options.gap <= 1)) throw InvalidInput("gap must be in (0, 1]");
  if (!(options.taper > 0 && options.taper <= 1)) throw InvalidInput("taper must be in (0, 1]");
  if (!(options.most_taken > 0 && options.most_taken < 1)) throw InvalidInput("most_taken must be in (0, 1)");
  if (options.max_rounds < 1) throw InvalidInput("max_rounds must be at least 1");
}

// What one vessel has to give up at a contact.
struct Hold {
  Index segment, leaf;  // of the original; or an isolated node and kNone
  double share;
};

// One look at the narrowed vessels: which shares must be held so that they come apart.
class Round {
 public:
  Round(const Centerline& original, const Narrowing& narrowing, const NarrowedCenterline& narrowed,
        const SeparationOptions& options)
      : original_(original),
        narrowing_(narrowing),
        narrowed_(narrowed),
        options_(options),
        field_(narrowed.centerline, options.blend) {
    for (Index n = 0; n < original.nodes().size(); ++n) {
      if (original.degree(n) == 0) isolated_.push_back(n);
    }
  }

  /// The holds for every contact that can be separated.
  std::vector<Hold> holds() {
    const std::vector<ContactPair> pairs = find_contact_pairs(field_, options_.gap);
    Index regions = 0;
    for (const ContactPair& pair : pairs) regions = std::max(regions, pair.region + 1);
    std::vector<std::vector<Hold>> per_region(regions);
    for (const ContactPair& pair : pairs) {
      const double gap = pair.gap + kSpare;
      hold_cone(pair.i, pair.j, gap, per_region[pair.region]);
      hold_cone(pair.j, pair.i, gap, per_region[pair.region]);
    }
    std::vector<Hold> all;
    for (const auto& region : per_region) {
      const bool possible =
          std::ranges::all_of(region, [this](const Hold& hold) { return hold.share >= 1 - options_.most_taken; });
      if (possible) all.insert(all.end(), region.begin(), region.end());
    }
    return all;
  }

 private:
  void hold_cone(Index cone, Index other, double gap, std::vector<Hold>& holds) const {
    const AxisStretch across = stretch_of(field_, other);
    if (cone >= narrowed_.pieces.size()) {
      const Index node = isolated_[cone - narrowed_.pieces.size()];
      const double kept = kept_share(stretch_of(field_, cone), across, gap);
      holds.push_back({node, kNone, kept * field_.radius_at(cone, 0) / original_.node(node).radius});
      return;
    }
    const SegmentPiece& piece = narrowed_.pieces[cone];
    const double count = narrowing_.leaf_count(piece.segment), width = piece.t_last - piece.t_first;
    for (auto leaf = static_cast<Index>(piece.t_first * count); leaf < piece.t_last * count; ++leaf) {
      const double first = std::max(0.0, (leaf / count - piece.t_first) / width);
      const double last = std::min(1.0, ((leaf + 1) / count - piece.t_first) / width);
      if (!(first < last)) continue;
      const AxisStretch part = stretch_of(field_, cone, first, last);
      const ClosestApproach closest = closest_approach(part, across, gap);
      if (closest.excess >= 0) continue;
      const double t = first + closest.s * (last - first);
      const double share = field_.radius_at(cone, t) / original_.radius_at(piece.segment, piece.original_t(t));
      holds.push_back({piece.segment, leaf, share * kept(closest, part, across, gap)});
    }
  }

  // The share of both radii at which the gap is left.
  static double kept(const ClosestApproach& closest, const AxisStretch& a, const AxisStretch& b, double gap) {
    const double r = a.radius(closest.s), q = b.radius(closest.t);
    return closest.distance / (r + q + gap * std::min(r, q));
  }
  static double kept_share(const AxisStretch& a, const AxisStretch& b, double gap) {
    return std::min(1.0, kept(closest_approach(a, b, gap), a, b, gap));
  }

  const Centerline& original_;
  const Narrowing& narrowing_;
  const NarrowedCenterline& narrowed_;
  const SeparationOptions& options_;
  VesselField field_;
  std::vector<Index> isolated_;
};

void hold_all(Narrowing& narrowing, const std::vector<Hold>& holds) {
  for (const Hold& hold : holds) {
    if (hold.leaf == kNone) {
      narrowing.hold_node(hold.segment, hold.share);
    } else {
      narrowing.hold(hold.segment, hold.leaf, hold.share);
    }
  }
}

// Contacts of the narrowed centerline, named by segments and branches of the original.
std::vector<Contact> contacts_left(const Centerline& original, const NarrowedCenterline& narrowed,
                                   const SeparationOptions& options) {
  std::vector<Index> branch_of(original.segments().size(), kNone);
  const std::vector<Branch> branches = find_branches(original);
  for (Index b = 0; b < branches.size(); ++b) {
    for (const Index s : branches[b].segments) branch_of[s] = b;
  }
  std::vector<Contact> contacts = find_contacts(VesselField(narrowed.centerline, options.blend), options.gap);
  for (Contact& contact : contacts) {
    for (ContactSide& side : contact.sides) {
      if (side.segment >= narrowed.pieces.size()) {
        side.segment = static_cast<Index>(side.segment - narrowed.pieces.size() + original.segments().size());
        continue;
      }
      const SegmentPiece& piece = narrowed.pieces[side.segment];
      side.t = piece.original_t(side.t);
      side.segment = piece.segment;
      side.branch = branch_of[side.segment];
    }
  }
  return contacts;
}

void tell_taken(const Centerline& original, const NarrowedCenterline& narrowed, SeparationReport& report) {
  std::vector<double> radii;  // of the original vessel at every node
  for (const CenterlineNode& node : original.nodes()) radii.push_back(node.radius);
  radii.resize(narrowed.centerline.nodes().size());
  report.nodes_added = radii.size() - original.nodes().size();
  for (Index s = 0; s < narrowed.pieces.size(); ++s) {
    const SegmentPiece& piece = narrowed.pieces[s];
    const Index last = narrowed.centerline.segment(s).b;
    if (last >= original.nodes().size()) radii[last] = original.radius_at(piece.segment, piece.t_last);
  }
  double sum = 0;
  for (Index n = 0; n < radii.size(); ++n) {
    const CenterlineNode& node = narrowed.centerline.node(n);
    const double taken = radii[n] - node.radius;
    if (!(taken > 0)) continue;
    ++report.nodes_narrowed;
    sum += taken / radii[n];
    report.max_taken = std::max(report.max_taken, taken);
    if (taken / radii[n] <= report.max_taken_relative) continue;
    report.max_taken_relative = taken / radii[n];
    report.max_taken_at = node.position;
  }
  if (report.nodes_narrowed > 0) report.mean_taken_relative = sum / static_cast<double>(report.nodes_narrowed);
}

}  // namespace

SeparatedCenterline separate_contacts(const Centerline& centerline, const SeparationOptions& options,
                                      const Progress& progress) {
  check(options);
  Narrowing narrowing(centerline, options.taper);
  NarrowedCenterline narrowed = narrowing.apply();
  SeparationReport report;
  report.before = find_contacts(VesselField(centerline, options.blend), options.gap);
  for (; report.rounds < options.max_rounds; ++report.rounds) {
    report_progress(progress, "separate", static_cast<double>(report.rounds) / options.max_rounds);
    const std::vector<Hold> holds = Round(centerline, narrowing, narrowed, options).holds();
    if (holds.empty()) break;
    hold_all(narrowing, holds);
    narrowed = narrowing.apply();
  }
  report.left = contacts_left(centerline, narrowed, options);
  tell_taken(centerline, narrowed, report);
  return {std::move(narrowed.centerline), std::move(narrowed.pieces), std::move(report)};
}

}  // namespace vmesh
