#include "surface/pieces/piece_grower.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>

#include "vmesh/core/ascending.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/error_bound.h"

#include "surface/pieces/piece_invariants.h"
#include "surface/pieces/whole_tasks.h"

namespace vmesh {
namespace {

constexpr int kRounds = 3;  // of remaking pieces as one; idle 2 to 4
// Radii: a fault this near to a seam may be caused by it; idle 2.8 to 5.6.
constexpr double kNearSeam = 4.0;
// Of the ladder, by which trials climb: what needs more takes long, and another draw will do.
constexpr int kRungsOfTrials = 3;

std::vector<Index> branches_of(const PiecePlan& plan) {
  std::vector<Index> branches;
  for (const Stretch& stretch : plan.stretches) branches.push_back(stretch.branch);
  sort_unique(branches);
  return branches;
}

std::vector<Index> branches_of(const Division& division, const std::vector<Index>& pieces) {
  std::vector<Index> branches;
  for (const Index p : pieces) {
    for (const Index b : branches_of(division.plans[p])) branches.push_back(b);
  }
  sort_unique(branches);
  return branches;
}

std::vector<Index> numbers(std::size_t count) {
  std::vector<Index> numbers(count);
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

// The part of a division that consists of some of its pieces.
Division part_of(const RingCounts& rings, const Division& division, const std::vector<Index>& pieces) {
  Division part;
  for (const Index p : pieces) {
    part.plans.push_back(division.plans[p]);
    for (const RingPlace& seam : seams_of(rings, division.plans[p])) part.seams.push_back(seam);
  }
  sort_unique(part.seams);
  return part;
}

}  // namespace

PieceGrower::PieceGrower(const VesselField& field, const std::vector<char>& open, const GenerateOptions& options,
                         const ErrorLimit& refined_to, const Progress& progress)
    : tubes_(field, RingOptions::of(options)),
      rings_(tubes_),
      options_(options),
      progress_(progress),
      ask_([this](std::string_view, double) {
        const std::lock_guard lock(reporting_);
        if (polled_) return !*polled_ || (*polled_)("", 0);
        const double fraction = static_cast<double>(done_) / static_cast<double>(std::max<std::size_t>(1, all_));
        return !progress_ || progress_("grow", fraction);
      }),
      context_{tubes_, open, options_, ask_, refined_to, {}} {}

void PieceGrower::begin(const std::vector<FinePlace>& fine_places, int most_rungs, const Progress* polled) {
  context_.fine_places = fine_places;
  context_.most_rungs = most_rungs;
  polled_ = polled;
}

Grown PieceGrower::grow() {
  begin({}, kRungs, nullptr);
  now_ = {};
  now_.division = divide(tubes_, options_);
  check_division(rings_, now_.division);
  make_all(expected_vertices(tubes_.centerline(), options_.around) / options_.ring_spacing);
  settle();
  return std::move(now_);
}

Grown PieceGrower::grow_anew(const Grown& first, const std::vector<Index>& pieces,
                             const std::vector<FinePlace>& fine_places) {
  begin(fine_places, kRungs, nullptr);
  now_ = first;
  std::vector<Index> known = numbers(first.pieces.size());
  for (const Index p : pieces) known[p] = kNone;
  change_to(first.division, known, first.pieces);
  settle();
  return std::move(now_);
}

std::optional<FinishedSurface> PieceGrower::grow_some(const Grown& first, const std::vector<Index>& pieces,
                                                      const std::vector<FinePlace>& fine_places,
                                                      const Progress& progress) {
  int most_rungs = kRungsOfTrials;
  for (const Index p : pieces) most_rungs = std::max(most_rungs, first.pieces[p].rung + 1);
  begin(fine_places, most_rungs, &progress);
  now_ = {};
  now_.division = part_of(rings_, first.division, pieces);
  tubes_.lay_again(branches_of(now_.division, numbers(pieces.size())));
  std::vector<Opening> openings = outer_seams();
  make_all(0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!now_.pieces[i].faults.empty() && first.pieces[pieces[i]].faults.empty()) return std::nullopt;
  }
  FinishedSurface& some = now_.surface;
  some.openings.insert(some.openings.end(), openings.begin(), openings.end());
  return std::move(some);
}

// Seams with a piece on one side only.
std::vector<Opening> PieceGrower::outer_seams() const {
  std::map<RingPlace, int> sides;
  for (const PiecePlan& plan : now_.division.plans) {
    for (const RingPlace& seam : seams_of(rings_, plan)) ++sides[seam];
  }
  std::vector<Opening> openings;
  Index begin = 0;
  for (const auto& [seam, count] : sides) {
    const Ring& ring = tubes_.rings(seam.branch)[seam.ring];
    const auto end = begin + static_cast<Index>(ring.points.size());
    if (count == 1) {
      Opening opening{kNone, ring.center, Vec3::Zero(), ring.radius, {}};
      for (Index v = begin; v < end; ++v) opening.ring.push_back(v);
      openings.push_back(std::move(opening));
    }
    begin = end;
  }
  return openings;
}

// Makes all pieces. Each goes into the whole surface in its turn, and rings are freed with the last piece along their
// branch.
void PieceGrower::make_all(double expected_vertices) {
  now_.pieces.resize(now_.division.plans.size());
  Gatherer gatherer(tubes_, now_.division, now_.pieces, expected_vertices);
  make_pieces(numbers(now_.pieces.size()), [&](Index p) { gatherer.add(p); });
  now_.surface = gatherer.finish();
  release_freed_memory();
}

// Makes these pieces, and calls finished(p) as each is. They are begun in their order, whoever makes them.
template <class Finished>
void PieceGrower::make_pieces(const std::vector<Index>& missing, const Finished& finished) {
  std::vector<std::atomic<Index>> uses(tubes_.axes().size());  // of the rings of every branch
  for (const Index p : missing) {
    for (const Index b : branches_of(now_.division.plans[p])) ++uses[b];
  }
  done_ = now_.pieces.size() - missing.size();
  all_ = now_.pieces.size();
  std::atomic<std::size_t> next{0};
  for_whole_tasks(missing.size(), [&](std::size_t) {
    report_progress(ask_, "grow", 0);
    const Index p = missing[next++];
    now_.pieces[p] = make_piece(context_, now_.division.plans[p]);
    for (const Index b : branches_of(now_.division.plans[p])) {
      if (--uses[b] == 0) tubes_.release(b);
    }
    finished(p);
    const std::lock_guard lock(reporting_);
    ++done_;
  });
}

// Parts walls that cross, and remakes pieces as one, until nothing is left that this may mend.
void PieceGrower::settle() {
  for (int round = 0;; ++round) {
    now_.crossings = find_crossings();
    now_.before_parting = {};
    if (options_.max_error.is_set()) {
      now_.unproven = unproven_faces(now_.surface.mesh, now_.surface.binding, tubes_.field(), options_.max_error,
                                     Shells::along_normals);
    } else {
      now_.crossings = part_walls(now_.surface, tubes_.field(), now_.crossings, &now_.before_parting);
    }
    if (round == kRounds || !regroup()) break;
  }
}

// Makes the pieces of another division that are not in this one.
void PieceGrower::divide_anew(Division next) {
  std::map<PiecePlan, Index> number;
  for (Index p = 0; p < now_.pieces.size(); ++p) number.emplace(now_.division.plans[p], p);
  std::vector<PieceSurface> pieces(next.plans.size());
  std::vector<Index> known(pieces.size(), kNone);
  for (Index p = 0; p < pieces.size(); ++p) {
    const auto it = number.find(next.plans[p]);
    if (it == number.end()) continue;
    known[p] = it->second;
    pieces[p] = std::move(now_.pieces[it->second]);
  }
  change_to(std::move(next), known, std::move(pieces));
}

// Makes those pieces of a division that are not known. `known`: their numbers in what has grown, or kNone.
void PieceGrower::change_to(Division next, const std::vector<Index>& known, std::vector<PieceSurface> pieces) {
  take_back(now_.before_parting, now_.surface);
  std::vector<Index> missing;
  for (Index p = 0; p < known.size(); ++p) {
    if (known[p] == kNone) missing.push_back(p);
  }
  tubes_.lay_again(branches_of(next, missing));
  std::swap(now_.division, next);
  check_division(rings_, now_.division);
  now_.pieces = std::move(pieces);
  make_pieces(missing, [](Index) {});
  now_.surface = gather_again(std::move(now_.surface), next, now_.division, known, now_.pieces, tubes_.centerline());
}

// Crossings within a piece are its own faults; only those between pieces are looked for here.
std::vector<std::pair<Index, Index>> PieceGrower::find_crossings() const {
  const bool all_right = std::all_of(now_.pieces.begin(), now_.pieces.end(), [](const PieceSurface& piece) {
    return std::none_of(piece.faults.begin(), piece.faults.end(),
                        [](const PieceFault& fault) { return fault.kind == DefectKind::crossing_faces; });
  });
  return all_right ? intersections_between(now_.surface.mesh, now_.surface.first_face)
                   : self_intersections(now_.surface.mesh);
}

// Merges pieces where there are faults between them. Returns whether there were any that this may mend.
bool PieceGrower::regroup() {
  std::vector<RingPlace> dissolved;
  std::vector<std::pair<Anchor, Anchor>> joined;
  if (std::any_of(now_.pieces.begin(), now_.pieces.end(), [](const PieceSurface& p) { return p.cannot_be_sound; }))
    return false;
  lay_rings_of_faulty_pieces();
  for (const auto& [f, g] : now_.crossings) {
    if (vessels_overlap(f, g)) return false;
    put_together(now_.surface.piece_of(f), now_.surface.piece_of(g), dissolved, joined);
  }
  for_seams_of_faulty_pieces([&](const PieceSurface& piece, const RingPlace& seam) {
    if (has_fault_near(piece, seam)) dissolved.push_back(seam);
  });
  for (const Index f : now_.unproven) {
    for (const Index v : now_.surface.mesh.faces[f]) {
      if (const auto seam = seam_of_vertex(v)) dissolved.push_back(*seam);
    }
  }
  // A piece that is not sound by itself may be together with its neighbours.
  if (dissolved.empty() && joined.empty())
    for_seams_of_faulty_pieces([&](const PieceSurface&, const RingPlace& seam) { dissolved.push_back(seam); });
  if (dissolved.empty() && joined.empty()) return false;
  sort_unique(dissolved);
  Division next = regrouped(rings_, now_.division, dissolved, joined);
  if (next.plans == now_.division.plans) return false;
  divide_anew(std::move(next));
  return true;
}

bool PieceGrower::vessels_overlap(Index f, Index g) const {
  for (const Index face : {f, g}) {
    for (const Index v : now_.surface.mesh.faces[face]) {
      if (is_covered(tubes_.field(), now_.surface.mesh.vertices[v], now_.surface.binding[v].segment)) return true;
    }
  }
  return false;
}

// Notes what makes one piece of two: the seams between neighbours dissolve, others are joined.
void PieceGrower::put_together(Index p, Index q, std::vector<RingPlace>& dissolved,
                               std::vector<std::pair<Anchor, Anchor>>& joined) const {
  if (p == q) return;
  const std::vector<RingPlace> of_p = seams_of(rings_, now_.division.plans[p]);
  bool neighbours = false;
  for (const RingPlace& seam : seams_of(rings_, now_.division.plans[q])) {
    if (std::find(of_p.begin(), of_p.end(), seam) == of_p.end()) continue;
    dissolved.push_back(seam);
    neighbours = true;
  }
  if (!neighbours) joined.emplace_back(anchor_of(now_.division.plans[p]), anchor_of(now_.division.plans[q]));
}

template <class Visit>
void PieceGrower::for_seams_of_faulty_pieces(Visit&& visit) const {
  for (Index p = 0; p < now_.pieces.size(); ++p) {
    if (now_.pieces[p].faults.empty()) continue;
    for (const RingPlace& seam : seams_of(rings_, now_.division.plans[p])) visit(now_.pieces[p], seam);
  }
}

void PieceGrower::lay_rings_of_faulty_pieces() {
  std::vector<Index> branches;
  for_seams_of_faulty_pieces([&](const PieceSurface&, const RingPlace& seam) { branches.push_back(seam.branch); });
  sort_unique(branches);
  tubes_.lay_again(branches);
}

// Rings of faulty pieces must be laid.
bool PieceGrower::has_fault_near(const PieceSurface& piece, const RingPlace& seam) const {
  const Ring& ring = tubes_.rings(seam.branch)[seam.ring];
  return std::any_of(piece.faults.begin(), piece.faults.end(), [&](const PieceFault& fault) {
    return (fault.position - ring.center).norm() < kNearSeam * ring.radius;
  });
}

// The seams' vertices come first, `around` for each.
std::optional<RingPlace> PieceGrower::seam_of_vertex(Index v) const {
  const std::size_t seam = v / static_cast<std::size_t>(options_.around);
  if (seam >= now_.division.seams.size()) return std::nullopt;
  return now_.division.seams[seam];
}

}  // namespace vmesh
