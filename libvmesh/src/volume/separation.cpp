#include <algorithm>
#include <cmath>
#include <set>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"
#include "vmesh/volume/contacts.h"

#include "volume/contact_looks.h"
#include "volume/moving_round.h"
#include "volume/narrowing.h"

namespace vmesh {
namespace {

// Aims for a little more than the gap, so that rounds of narrowing end.
constexpr double kSpareGap = 0.02;  // safe 0.014 to 0.028
constexpr double kMoved = 1e-9;     // derived: radii, more than rounding can move a node
// Tried in turn where moves were in vain.
constexpr MovingChoice kAttempts[] = {{}, {false, true}, {true, false}, {true, true}};

void check(const SeparationOptions& options) {
  if (!(options.gap > 0 && options.gap <= 1)) throw InvalidInput("gap must be in (0, 1]");
  if (!(options.taper > 0 && options.taper <= 1)) throw InvalidInput("taper must be in (0, 1]");
  if (!(options.most_taken > 0 && options.most_taken < 1)) throw InvalidInput("most_taken must be in (0, 1)");
  if (options.max_rounds < 1) throw InvalidInput("max_rounds must be at least 1");
  if (!(options.move_beyond > 0 && options.move_beyond <= 1)) throw InvalidInput("move_beyond must be in (0, 1]");
  if (!(options.slope > 0 && options.slope <= 0.5)) throw InvalidInput("slope must be in (0, 0.5]");
  if (options.max_moves < 0) throw InvalidInput("max_moves must not be negative");
}

// To what share of its radius one vessel must narrow at a contact.
struct Hold {
  Index segment, leaf;  // of the original; or an isolated node and kNone
  double share;
};

// One round: finds the shares that must be held for the narrowed vessels to come apart.
class Round {
 public:
  Round(const Centerline& original, const Narrowing& narrowing, const DividedCenterline& narrowed, double most_taken)
      : original_(original),
        narrowing_(narrowing),
        narrowed_(narrowed),
        most_taken_(most_taken),
        cones_(narrowed.centerline) {}

  /// Those for every contact, of these, that can be separated.
  std::vector<Hold> holds(const std::vector<ContactPair>& pairs) {
    Index regions = 0;
    for (const ContactPair& pair : pairs) regions = std::max(regions, pair.region + 1);
    std::vector<std::vector<Hold>> per_region(regions);
    for (const ContactPair& pair : pairs) {
      const double gap = pair.gap + kSpareGap;
      hold_cone(pair.i, pair.j, gap, per_region[pair.region]);
      hold_cone(pair.j, pair.i, gap, per_region[pair.region]);
    }
    std::vector<Hold> all;
    for (const auto& region : per_region) {
      const bool possible =
          std::ranges::all_of(region, [this](const Hold& hold) { return hold.share >= 1 - most_taken_; });
      if (possible) all.insert(all.end(), region.begin(), region.end());
    }
    return all;
  }

 private:
  void hold_cone(Index cone, Index other, double gap, std::vector<Hold>& holds) const {
    const AxisStretch across = cones_.stretch(other);
    if (cones_.is_sphere(cone)) {
      const Index node = cones_.isolated_node(cone);
      const double kept = kept_share(cones_.stretch(cone), across, gap);
      holds.push_back({node, kNone, kept * cones_.radius_at(cone, 0) / original_.node(node).radius});
      return;
    }
    const SegmentPiece& piece = narrowed_.pieces[cone];
    const double count = narrowing_.leaf_count(piece.segment), width = piece.t_last - piece.t_first;
    for (auto leaf = static_cast<Index>(piece.t_first * count); leaf < piece.t_last * count; ++leaf) {
      const double first = std::max(0.0, (leaf / count - piece.t_first) / width);
      const double last = std::min(1.0, ((leaf + 1) / count - piece.t_first) / width);
      if (!(first < last)) continue;
      const AxisStretch part = cones_.stretch(cone, first, last);
      if (are_apart(part, across, gap, 0)) continue;
      const ClosestApproach closest = closest_approach(part, across, gap);
      if (closest.excess >= 0) continue;
      const double t = first + closest.s * (last - first);
      const double share = cones_.radius_at(cone, t) / original_.radius_at(piece.segment, piece.original_t(t));
      holds.push_back({piece.segment, leaf, share * kept(closest, part, across, gap)});
    }
  }

  // The share of both radii that leaves the gap.
  static double kept(const ClosestApproach& closest, const AxisStretch& a, const AxisStretch& b, double gap) {
    const double r = a.radius(closest.s), q = b.radius(closest.t);
    return closest.distance / (r + q + gap * std::min(r, q));
  }
  static double kept_share(const AxisStretch& a, const AxisStretch& b, double gap) {
    return std::min(1.0, kept(closest_approach(a, b, gap), a, b, gap));
  }

  const Centerline& original_;
  const Narrowing& narrowing_;
  const DividedCenterline& narrowed_;
  double most_taken_;
  ConeAxes cones_;
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

std::vector<Index> branch_of_segments(const Centerline& centerline) {
  std::vector<Index> branch_of(centerline.segments().size(), kNone);
  const std::vector<Branch> branches = find_branches(centerline);
  for (Index b = 0; b < branches.size(); ++b) {
    for (const Index s : branches[b].segments) branch_of[s] = b;
  }
  return branch_of;
}

// Contacts of the narrowed centerline, named by segments and branches of the original.
std::vector<Contact> contacts_left(const Centerline& original, const DividedCenterline& narrowed,
                                   const std::vector<ContactPair>& pairs) {
  const std::vector<Index> branch_of = branch_of_segments(original);
  std::vector<Contact> contacts = contacts_of(ConeAxes(narrowed.centerline), pairs);
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

void tell_taken(const Centerline& original, const DividedCenterline& narrowed, SeparationReport& report) {
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

// Farthest first, in radii.
std::vector<VesselMove> moves_of(const Centerline& original, const Moving& moving) {
  const std::vector<Index> branch_of = branch_of_segments(original);
  std::vector<VesselMove> moves;
  for (const Moving::Shift& shift : moving.shifts()) {
    VesselMove move;
    move.displacement = shift.distance * shift.direction;
    move.moved = shift.moved;
    move.other = shift.other;
    const MovedStretch& first = shift.stretches.front();
    move.position = first.segment == kNone ? original.node(first.node).position
                                           : original.point_at(shift.moved.segment, shift.moved.t);
    for (ContactSide* side : {&move.moved, &move.other}) {
      if (side->segment < branch_of.size()) side->branch = branch_of[side->segment];
    }
    moves.push_back(move);
  }
  std::stable_sort(moves.begin(), moves.end(), [](const VesselMove& a, const VesselMove& b) {
    return a.displacement.norm() / a.moved.radius > b.displacement.norm() / b.moved.radius;
  });
  return moves;
}

void tell_moved(const Centerline& original, const Moving& moving, const SeparatedCenterline& separated,
                SeparationReport& report) {
  const auto note = [&](Index node, const Vec3& place, double radius) {
    const double moved = (separated.centerline.node(node).position - place).norm();
    if (moved <= kMoved * radius) return;
    ++report.nodes_moved;
    report.max_moved = std::max(report.max_moved, moved);
    if (moved / radius <= report.max_moved_relative) return;
    report.max_moved_relative = moved / radius;
    report.max_moved_at = place;
  };
  if (moving.shifts().empty()) return;
  for (Index n = 0; n < original.nodes().size(); ++n) note(n, original.node(n).position, original.node(n).radius);
  for (Index s = 0; s < separated.pieces.size(); ++s) {
    const Index last = separated.centerline.segment(s).b;
    const auto& [segment, first, t] = separated.pieces[s];
    if (last >= original.nodes().size()) note(last, original.point_at(segment, t), original.radius_at(segment, t));
  }
  report.steepest_move = moving.steepest();
  report.moves = moves_of(original, moving);
}

// What separate_contacts() was asked for, and what it knows so far.
struct Task {
  const Centerline& original;
  const SeparationOptions& options;
  const Progress& progress;
  ContactLooks looks;
};

// Narrows vessels until those contacts are gone that can be.
class Narrower {
 public:
  /// `moved` divides the task's centerline.
  Narrower(const DividedCenterline& moved, Task& task)
      : moved_(moved),
        task_(task),
        narrowing_(moved.centerline, task.options.taper),
        narrowed_(undivided(moved.centerline)) {}

  /// Narrows at contacts that need at most this share.
  void narrow(double most_taken) {
    for (; rounds_ < task_.options.max_rounds; ++rounds_) {
      report_progress(task_.progress, "separate", static_cast<double>(rounds_) / task_.options.max_rounds);
      const std::vector<Hold> holds = Round(moved_.centerline, narrowing_, narrowed_, most_taken).holds(look());
      if (holds.empty()) return;
      hold_all(narrowing_, holds);
      narrowed_ = narrowing_.apply();
    }
  }
  /// The contacts of the narrowed vessels.
  const std::vector<ContactPair>& look() const {
    return task_.looks.look(narrowed(), static_cast<std::size_t>(rounds_));
  }
  /// Divides the task's centerline.
  DividedCenterline narrowed() const { return composed(moved_, narrowed_); }
  int rounds() const { return rounds_; }

 private:
  const DividedCenterline& moved_;
  Task& task_;
  Narrowing narrowing_;
  DividedCenterline narrowed_;
  int rounds_ = 0;
};

SeparatedCenterline narrow_moved(const Moving& moving, Task& task) {
  const SeparationOptions& options = task.options;
  const DividedCenterline moved = moving.apply();
  Narrower narrower(moved, task);
  narrower.narrow(std::min(options.move_beyond, options.most_taken));
  narrower.narrow(options.most_taken);
  DividedCenterline narrowed = narrower.narrowed();
  SeparationReport report;
  report.rounds = narrower.rounds();
  report.left = contacts_left(task.original, narrowed, narrower.look());
  tell_taken(task.original, narrowed, report);
  SeparatedCenterline separated{std::move(narrowed.centerline), std::move(narrowed.pieces), {}};
  tell_moved(task.original, moving, separated, report);
  separated.report = std::move(report);
  return separated;
}

// Moves vessels apart until narrowing by a moderate share can do the rest, or the rounds run out.
void move_vessels(const MovingChoice& choice, Task& task, Moving& moving) {
  const SeparationOptions& options = task.options;
  const auto look = [&](const DividedCenterline& vessels, const std::vector<ContactPair>& pairs) {
    const MovingTask moves{task.original, vessels, pairs, task.looks, options.gap, options.move_beyond, choice};
    return move_apart(moves, moving) > 0;
  };
  for (int round = 0; round < options.max_moves; ++round) {
    report_progress(task.progress, "move", static_cast<double>(round) / options.max_moves);
    const DividedCenterline moved = moving.apply();
    if (!look(moved, task.looks.look(moved, 0))) {
      Narrower narrower(moved, task);
      narrower.narrow(options.move_beyond);
      if (!look(narrower.narrowed(), narrower.look())) break;
    }
  }
}

// Undoes the moves of vessels that still touch where they were moved. Returns whether there were any.
bool take_back_moves_in_vain(const Centerline& original, Moving& moving, const std::vector<Contact>& left) {
  const std::size_t count = moving.shifts().size();
  for (const Contact& contact : left) {
    for (const ContactSide& side : contact.sides) {
      if (side.segment >= original.segments().size()) continue;
      const MovedStretch place{side.segment, side.t, side.t, kNone};
      for (auto shift = static_cast<Index>(moving.shifts().size()); shift-- > 0;) {
        if (moving.part_at(shift, place) > 0) moving.remove(shift);
      }
    }
  }
  return moving.shifts().size() < count;
}

// Undoes moves that were in vain and tries other choices for them, keeping those that helped.
SeparatedCenterline moved_and_narrowed(Task& task) {
  Moving moving(task.original, task.options.slope);
  move_vessels({}, task, moving);
  SeparatedCenterline best = narrow_moved(moving, task);
  std::vector<Contact> left = best.report.left;
  for (const MovingChoice& choice : kAttempts) {
    if (!take_back_moves_in_vain(task.original, moving, left)) break;
    for (const bool anew : {false, true}) {
      if (anew) move_vessels(choice, task, moving);
      SeparatedCenterline other = narrow_moved(moving, task);
      left = other.report.left;
      if (left.size() < best.report.left.size() + !anew) best = std::move(other);
      if (left.empty()) return best;
    }
  }
  return best;
}

SeparatedCenterline separate(Task& task) {
  const SeparationOptions& options = task.options;
  DividedCenterline whole = undivided(task.original);
  std::vector<Contact> before = contacts_of(ConeAxes(task.original), task.looks.look(whole, 0));
  if (before.empty()) return {std::move(whole.centerline), std::move(whole.pieces), {}};
  SeparatedCenterline separated = narrow_moved(Moving(task.original, options.slope), task);
  const bool enough = separated.report.left.empty() && separated.report.max_taken_relative <= options.move_beyond;
  if (!enough && options.move_beyond < options.most_taken && options.max_moves > 0) {
    SeparatedCenterline moved = moved_and_narrowed(task);
    const std::size_t left = moved.report.left.size();
    if (left == 0 || left < separated.report.left.size()) separated = std::move(moved);
  }
  separated.report.before = std::move(before);
  return separated;
}

// Whether those contacts are left that were found around what changed.
bool is_as_reported(const SeparatedCenterline& separated, const SeparationOptions& options) {
  const ConeRelations cones(separated.centerline, options.blend);
  return find_contacts(cones, options.gap).size() == separated.report.left.size();
}

}  // namespace

SeparatedCenterline separate_contacts(const Centerline& centerline, const SeparationOptions& options,
                                      const Progress& progress) {
  check(options);
  Task task{centerline, options, progress, ContactLooks({options.gap, options.blend})};
  SeparatedCenterline separated = separate(task);
  if (separated.report.before.empty() || is_as_reported(separated, options)) return separated;
  task.looks = ContactLooks({options.gap, options.blend}, true);
  return separate(task);
}

}  // namespace vmesh
