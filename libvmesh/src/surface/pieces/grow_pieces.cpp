#include "surface/pieces/grow_pieces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>

#include "vmesh/core/ascending.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/error_bound.h"

#include "surface/check/error_limit.h"
#include "surface/pieces/fine_places.h"
#include "surface/pieces/gathering.h"
#include "surface/pieces/parting.h"
#include "surface/pieces/piece_invariants.h"
#include "surface/pieces/slow_pieces.h"
#include "surface/pieces/whole_tasks.h"
#include "surface/proof/coarsening.h"
#include "surface/proof/notches.h"
#include "surface/proof/refine_to_limit.h"

namespace vmesh {
namespace {

constexpr int kRounds = 3;  // of remaking pieces as one; idle 2 to 4
// Radii: a fault this near to a seam may be caused by it; idle 2.8 to 5.6.
constexpr double kNearSeam = 4.0;
// Rounds of growing anew. Of 70 random trees with --blend 0 at 1 %, 41 need none; of 28 others, 22 were proven after
// one or two, one after four, one after six.
constexpr int kMostDraws = 12;
constexpr double kNearOpening = 1.5;  // radii: faces there have a corner on its ring

class PieceGrower {
 public:
  /// What becomes of the whole surface.
  struct Finish {
    ErrorLimit limit;             ///< what it is refined to, if set; that of the options is proven piece by piece
    bool may_be_coarser;          ///< whether vertices are left out then
    double elongation;            ///< how long triangles may be then
    bool usual_way_only = false;  ///< of refining
    std::vector<FinePlace> fine_places = {};
  };

  PieceGrower(const VesselField& field, const std::vector<char>& open, const GenerateOptions& options,
              const Finish& finish, const Progress& progress)
      : tubes_(field, RingOptions::of(options)),
        rings_(tubes_),
        options_(options),
        finish_(finish),
        progress_(progress),
        context_{tubes_, open, options_, ask_, finish.limit, finish.fine_places},
        division_(divide(tubes_, options)) {}

  /// Grows the surface, and refines it to the limit.
  void grow() {
    make_all();
    for (int round = 0;; ++round) {
      crossings_ = find_crossings();
      BeforeParting before;
      if (!options_.max_error.is_set()) crossings_ = part_walls(gathered_, tubes_.field(), crossings_, &before);
      if (options_.max_error.is_set())
        unproven_ = unproven_faces(gathered_.mesh, gathered_.binding, tubes_.field(), options_.max_error,
                                   Shells::along_normals);
      if (round == kRounds || !regroup(before)) break;
    }
    if (finish_.limit.is_set()) refine_whole();
    if (!unproven_.empty()) close_notches_left();
  }

  /// After grow(): whether the whole surface was refined to the limit, but at openings.
  bool has_met_limit() const { return has_met_limit_; }
  std::size_t unproven_faces_left() const { return error_.unproven_faces; }

  const std::vector<FinePlace>& fine_places() const { return finish_.fine_places; }
  /// The places that are not proven, without those at openings, which cannot be.
  std::vector<UnprovenPlace> unproven_places() const {
    std::vector<UnprovenPlace> places = error_.unproven_places;
    std::erase_if(places, [&](const UnprovenPlace& place) {
      return std::any_of(gathered_.openings.begin(), gathered_.openings.end(), [&](const Opening& opening) {
        return (place.position - opening.center).norm() < kNearOpening * opening.radius;
      });
    });
    return places;
  }

  /// After grow(), once: leaves out vertices, and hands over the surface. Returns which faces cross.
  std::vector<std::pair<Index, Index>> finish(GenerateResult& result) {
    if (finish_.may_be_coarser && crossings_.empty()) leave_out_vertices();
    tell(result);
    return std::move(crossings_);
  }

 private:
  // Makes all pieces. Each goes into the whole surface in its turn, and rings are freed with the last piece along their
  // branch.
  void make_all() {
    pieces_.resize(division_.plans.size());
    std::vector<Index> all(pieces_.size());
    std::iota(all.begin(), all.end(), Index{0});
    const double expected = expected_vertices(tubes_.centerline(), options_.around) / options_.ring_spacing;
    Gatherer gatherer(tubes_, division_, pieces_, expected);
    make_pieces(all, [&](Index p) { gatherer.add(p); });
    gathered_ = gatherer.finish();
    release_freed_memory();
  }

  // Makes these pieces, and calls finished(p) as each is. They are begun in their order, whoever makes them.
  template <class Finished>
  void make_pieces(const std::vector<Index>& missing, const Finished& finished) {
    check_division(rings_, division_);
    std::vector<std::atomic<Index>> uses(tubes_.axes().size());  // of the rings of every branch
    for (const Index p : missing) {
      for (const Index b : branches_of(division_.plans[p])) ++uses[b];
    }
    done_ = pieces_.size() - missing.size();
    std::atomic<std::size_t> next{0};
    for_whole_tasks(missing.size(), [&](std::size_t) {
      report_progress(ask_, "grow", 0);
      const Index p = missing[next++];
      pieces_[p] = make_piece(context_, division_.plans[p]);
      for (const Index b : branches_of(division_.plans[p])) {
        if (--uses[b] == 0) tubes_.release(b);
      }
      finished(p);
      const std::lock_guard lock(reporting_);
      ++done_;
    });
  }

  static std::vector<Index> branches_of(const PiecePlan& plan) {
    std::vector<Index> branches;
    for (const Stretch& stretch : plan.stretches) branches.push_back(stretch.branch);
    sort_unique(branches);
    return branches;
  }

  // Makes the pieces of another division that are not in this one. `before`: to take back that walls were parted.
  void divide_anew(Division next, const BeforeParting& before) {
    take_back(before, gathered_);
    std::map<PiecePlan, Index> number;
    for (Index p = 0; p < pieces_.size(); ++p) number.emplace(division_.plans[p], p);
    std::vector<PieceSurface> pieces(next.plans.size());
    std::vector<Index> known(pieces.size(), kNone), missing, branches;
    for (Index p = 0; p < pieces.size(); ++p) {
      const auto it = number.find(next.plans[p]);
      if (it != number.end()) {
        known[p] = it->second;
        pieces[p] = std::move(pieces_[it->second]);
      } else {
        missing.push_back(p);
        for (const Index b : branches_of(next.plans[p])) branches.push_back(b);
      }
    }
    sort_unique(branches);
    tubes_.lay_again(branches);
    std::swap(division_, next);
    pieces_ = std::move(pieces);
    make_pieces(missing, [](Index) {});
    gathered_ = gather_again(std::move(gathered_), next, division_, known, pieces_, tubes_.centerline());
  }

  // Crossings within a piece are its own faults; only those between pieces are looked for here.
  std::vector<std::pair<Index, Index>> find_crossings() const {
    const bool all_right = std::all_of(pieces_.begin(), pieces_.end(), [](const PieceSurface& piece) {
      return std::none_of(piece.faults.begin(), piece.faults.end(),
                          [](const PieceFault& fault) { return fault.kind == DefectKind::crossing_faces; });
    });
    return all_right ? intersections_between(gathered_.mesh, gathered_.first_face) : self_intersections(gathered_.mesh);
  }

  // Merges pieces where there are faults between them. Returns whether there were any that this may mend. `before`: the
  // surface before walls were parted.
  bool regroup(const BeforeParting& before) {
    std::vector<RingPlace> dissolved;
    std::vector<std::pair<Anchor, Anchor>> joined;
    if (std::any_of(pieces_.begin(), pieces_.end(), [](const PieceSurface& p) { return p.cannot_be_sound; }))
      return false;
    lay_rings_of_faulty_pieces();
    for (const auto& [f, g] : crossings_) {
      if (vessels_overlap(f, g)) return false;
      put_together(gathered_.piece_of(f), gathered_.piece_of(g), dissolved, joined);
    }
    for_seams_of_faulty_pieces([&](const PieceSurface& piece, const RingPlace& seam) {
      if (has_fault_near(piece, seam)) dissolved.push_back(seam);
    });
    for (const Index f : unproven_) {
      for (const Index v : gathered_.mesh.faces[f]) {
        if (const auto seam = seam_of_vertex(v)) dissolved.push_back(*seam);
      }
    }
    // A piece that is not sound by itself may be together with its neighbours.
    if (dissolved.empty() && joined.empty())
      for_seams_of_faulty_pieces([&](const PieceSurface&, const RingPlace& seam) { dissolved.push_back(seam); });
    if (dissolved.empty() && joined.empty()) return false;
    std::sort(dissolved.begin(), dissolved.end());
    dissolved.erase(std::unique(dissolved.begin(), dissolved.end()), dissolved.end());
    Division next = regrouped(rings_, division_, dissolved, joined);
    if (next.plans == division_.plans) return false;
    divide_anew(std::move(next), before);
    return true;
  }

  void refine_whole() {
    const RefinementGoal goal{finish_.limit, options_.placement, static_cast<std::size_t>(options_.max_vertices),
                              finish_.usual_way_only};
    const RefinedError error = refine_to_limit(gathered_, tubes_.field(), goal, progress_);
    error_ = error.summary;
    has_met_limit_ = error.is_met;
    if (!crossings_.empty()) crossings_ = self_intersections(gathered_.mesh);  // by their new numbers
  }

  void close_notches_left() {
    error_ = close_notches(gathered_, tubes_.field(), options_.max_error);
    crossings_ = self_intersections(gathered_.mesh);
  }

  const ErrorLimit& limit() const { return finish_.limit.is_set() ? finish_.limit : options_.max_error; }

  void leave_out_vertices() {
    FinishedSurface surface = gathered_;
    const auto longest = [&](const CenterlineBinding& at) {
      return tubes_.longest_at(at.segment, at.t, finish_.elongation);
    };
    refused_ += coarsen(surface, tubes_.field(), {limit(), options_.least_vertices}, longest, progress_);
    if (limit().is_set()) {
      // Faces that were proven by bending their shells are at corners that stay; neighbours may lower their shells.
      const std::vector<Index> unproven = unproven_faces(surface.mesh, surface.binding, tubes_.field(), limit());
      if (unproven.size() > error_.unproven_faces) return;
      error_.unproven_faces = unproven.size();
      error_.unproven_places = places_of(surface.mesh, unproven);
    }
    static_cast<FinishedSurface&>(gathered_) = std::move(surface);
    crossings_ = self_intersections(gathered_.mesh);
    coarsened_ = true;
  }

  Elongation elongation_at(const CenterlineBinding& at) const {
    return coarsened_ ? tubes_.longest_at(at.segment, at.t, finish_.elongation)
                      : tubes_.elongation_at(at.segment, at.t);
  }

  bool vessels_overlap(Index f, Index g) const {
    for (const Index face : {f, g}) {
      for (const Index v : gathered_.mesh.faces[face]) {
        if (is_covered(tubes_.field(), gathered_.mesh.vertices[v], gathered_.binding[v].segment)) return true;
      }
    }
    return false;
  }

  // Notes what makes one piece of two: the seams between neighbours dissolve, others are joined.
  void put_together(Index p, Index q, std::vector<RingPlace>& dissolved,
                    std::vector<std::pair<Anchor, Anchor>>& joined) const {
    if (p == q) return;
    const std::vector<RingPlace> of_p = seams_of(rings_, division_.plans[p]);
    bool neighbours = false;
    for (const RingPlace& seam : seams_of(rings_, division_.plans[q])) {
      if (std::find(of_p.begin(), of_p.end(), seam) == of_p.end()) continue;
      dissolved.push_back(seam);
      neighbours = true;
    }
    if (!neighbours) joined.emplace_back(anchor_of(division_.plans[p]), anchor_of(division_.plans[q]));
  }

  template <class Visit>
  void for_seams_of_faulty_pieces(Visit&& visit) const {
    for (Index p = 0; p < pieces_.size(); ++p) {
      if (pieces_[p].faults.empty()) continue;
      for (const RingPlace& seam : seams_of(rings_, division_.plans[p])) visit(pieces_[p], seam);
    }
  }

  void lay_rings_of_faulty_pieces() {
    std::vector<Index> branches;
    for_seams_of_faulty_pieces([&](const PieceSurface&, const RingPlace& seam) { branches.push_back(seam.branch); });
    sort_unique(branches);
    tubes_.lay_again(branches);
  }

  // Rings of faulty pieces must be laid.
  bool has_fault_near(const PieceSurface& piece, const RingPlace& seam) const {
    const Ring& ring = tubes_.rings(seam.branch)[seam.ring];
    return std::any_of(piece.faults.begin(), piece.faults.end(), [&](const PieceFault& fault) {
      return (fault.position - ring.center).norm() < kNearSeam * ring.radius;
    });
  }

  // The seams' vertices come first, `around` for each.
  std::optional<RingPlace> seam_of_vertex(Index v) const {
    const std::size_t seam = v / static_cast<std::size_t>(options_.around);
    if (seam >= division_.seams.size()) return std::nullopt;
    return division_.seams[seam];
  }

  void tell(GenerateResult& result) {
    result.error = std::move(error_);
    const Centerline& centerline = tubes_.centerline();
    GrowthSummary& growth = result.growth;
    std::size_t filled = 0;
    growth.rungs.assign(kRungs, 0);
    growth.refused = refused_;
    growth.pieces = pieces_.size();
    for (PieceSurface& piece : pieces_) {
      growth.junctions += piece.junctions;
      growth.tubes += piece.tubes;
      filled += piece.filled_loops;
      growth.refused += piece.refused;
      ++growth.rungs[static_cast<std::size_t>(piece.rung)];
      for (GrowthSimplification& note : piece.simplifications) growth.simplifications.push_back(std::move(note));
    }
    growth.slow_pieces = slow_pieces(pieces_, division_.plans, centerline);
    growth.tubes -= division_.seams.size();  // the tubes on both sides of a seam count as one
    growth.components = centerline.component_count();
    growth.cycle_rank = centerline.cycle_rank() - filled;
    if (filled > 0)
      result.warnings.push_back(
          {GrowthWarning::Kind::filled_loop, filled,
           "growth: " + std::to_string(filled) +
               " loops of the centerline are too short to have a hole; the surface is filled there"});
    result.mesh = std::move(gathered_.mesh);
    result.binding = std::move(gathered_.binding);
    if (coarsened_ || tubes_.elongation_field()) {
      for (const CenterlineBinding& at : result.binding) {
        const Elongation allowed = elongation_at(at);
        result.elongation.push_back(allowed.times > 1 ? Vec3(allowed.times * allowed.direction) : Vec3(Vec3::Zero()));
      }
    }
    result.radius = std::move(gathered_.radius);
    result.openings = std::move(gathered_.openings);
  }

  VesselRings tubes_;
  RingCounts rings_;
  const GenerateOptions options_;
  const Finish finish_;
  const Progress& progress_;
  std::mutex reporting_;
  std::size_t done_ = 0;
  // Every sweep of a piece polls for cancellation; the progress reported is the share of finished pieces.
  const Progress ask_ = [this](std::string_view, double) {
    const std::lock_guard lock(reporting_);
    const double fraction = static_cast<double>(done_) / static_cast<double>(std::max<std::size_t>(1, pieces_.size()));
    return !progress_ || progress_("grow", fraction);
  };
  PieceContext context_;
  Division division_;
  std::vector<PieceSurface> pieces_;
  GatheredSurface gathered_;
  std::vector<std::pair<Index, Index>> crossings_;
  std::vector<Index> unproven_;
  ErrorSummary error_;
  bool has_met_limit_ = false;
  bool coarsened_ = false;
  RefusedSteps refused_;  // of steps on the whole surface
};

}  // namespace

std::vector<std::pair<Index, Index>> grow_pieces(const VesselField& field, const std::vector<char>& open,
                                                 const GenerateOptions& options, const Progress& progress,
                                                 GenerateResult& result) {
  // Not with a ring at every node.
  const bool may_be_coarser = options.elongation > 1 && !options.deformable;
  const bool has_goal = options.max_error.is_set() || options.least_vertices > 0;
  const PieceGrower::Finish as_grown{{}, may_be_coarser && has_goal, options.elongation};
  // Triangles at openings stay as they are if they cannot be proven: they had better be long from the beginning. But
  // those that grow long are skewer than those of an even surface, and many are left when a number of vertices is.
  const bool grow_long =
      options.least_vertices == 0 && std::any_of(open.begin(), open.end(), [](char is_open) { return is_open != 0; });
  if (!options.max_error.is_set() || (options.elongation > 1 && (!may_be_coarser || grow_long))) {
    PieceGrower grower(field, open, options, as_grown, progress);
    grower.grow();
    return grower.finish(result);
  }
  // An even surface is refined as a whole, then left as long triangles as may be. What cannot be proven then may be
  // where pieces are refined as they grow.
  GenerateOptions even = options;
  even.max_error = {};
  even.elongation = 1;
  std::optional<VesselField> precise;
  std::unique_ptr<PieceGrower> best;
  const auto attempt = [&](const VesselField& of, const GenerateOptions& with, const PieceGrower::Finish& finish) {
    auto grower = std::make_unique<PieceGrower>(of, open, with, finish, progress);
    grower->grow();
    std::vector<UnprovenPlace> unproven = grower->unproven_places();
    if (!best || grower->has_met_limit() || grower->unproven_faces_left() < best->unproven_faces_left())
      best = std::move(grower);
    return unproven;
  };
  // The usual way of refining takes a second where all ways take half a minute.
  PieceGrower::Finish finish{options.max_error, may_be_coarser, options.elongation, true};
  std::vector<UnprovenPlace> unproven = attempt(field, even, finish);
  FinePlaces fine(field, options.max_error);
  for (int round = 0; round < kMostDraws && !best->has_met_limit() && fine.draw(unproven); ++round) {
    finish.fine_places = fine.places();
    unproven = attempt(field, even, finish);
  }
  if (!best->has_met_limit()) {
    finish.fine_places = best->fine_places();
    finish.usual_way_only = false;
    attempt(field, even, finish);
  }
  if (!best->has_met_limit()) {
    precise = field;
    precise->use_double_precision();
    attempt(*precise, options, as_grown);
  }
  return best->finish(result);
}

}  // namespace vmesh
