#include "surface/pieces/grow_pieces.h"

#include <algorithm>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/error_bound.h"

#include "surface/check/error_limit.h"
#include "surface/pieces/piece_grower.h"
#include "surface/pieces/place_trials.h"
#include "surface/pieces/slow_pieces.h"
#include "surface/proof/coarsening.h"
#include "surface/proof/notches.h"
#include "surface/proof/place_repair.h"
#include "surface/proof/refine_to_limit.h"
#include "surface/proof/refined_proof.h"

namespace vmesh {
namespace {

// Rounds of growing anew where trials have found how fine. One does, unless trial and whole surface differ.
constexpr int kMostRounds = 4;
// What is small is repaired before anything is tried; the rest when nothing is left to be tried.
constexpr RepairEffort kQuickRepair{60, 150}, kThoroughRepair{1000, 1000};

// What has grown, refined if there is a limit.
struct WholeSurface {
  Grown grown;
  ErrorSummary error;
  bool has_met_limit = false;  ///< was refined to it everywhere but at openings
};

WholeSurface put_together(Grown grown, RefinementOutcome refined, bool has_met_limit) {
  static_cast<FinishedSurface&>(grown.surface) = std::move(refined.surface);
  if (!grown.crossings.empty()) grown.crossings = self_intersections(grown.surface.mesh);  // by their new numbers
  return {std::move(grown), std::move(refined.error), has_met_limit};
}

// Pieces keep to the limit of the options, if there is one, as they grow.
WholeSurface grow_as_given(PieceGrower& grower, const GenerateOptions& options) {
  WholeSurface whole{grower.grow(), {}, false};
  if (whole.grown.unproven.empty()) return whole;
  whole.error = close_notches(whole.grown.surface, grower.tubes().field(), options.max_error);
  whole.grown.crossings = self_intersections(whole.grown.surface.mesh);
  return whole;
}

// An even surface, which is refined as a whole when it has grown. Where it cannot be, it is grown anew, finer there.
class RefinedGrowth {
 public:
  RefinedGrowth(PieceGrower& grower, const RefinementGoal& goal, const Progress& progress)
      : grower_(grower), field_(grower.tubes().field()), goal_(goal), progress_(progress), first_(grower.grow()) {}

  /// Once.
  WholeSurface run() {
    RefinementOutcome best = refine_once(first_.surface, field_, goal_, progress_);
    if (!best.is_met()) repair_places(best, field_, goal_, kQuickRepair, progress_);
    Grown grown;
    if (best.is_met()) {
      grown = std::move(first_);
    } else {
      grown = first_;
      try_remedies(grown, best);
    }
    const bool has_met_limit = best.is_met();
    if (!best.surface.openings.empty()) close_notches_at_openings(best);
    return put_together(std::move(grown), std::move(best), has_met_limit);
  }

 private:
  // Refining does not look there.
  void close_notches_at_openings(RefinementOutcome& best) {
    std::vector<ClosedNotch> known = std::move(best.error.closed_notches);
    best.error = close_notches(best.surface, field_, goal_.limit);
    std::vector<ClosedNotch>& notches = best.error.closed_notches;
    notches.insert(notches.end(), known.begin(), known.end());
    deepest_first(notches);
  }

  void try_remedies(Grown& grown, RefinementOutcome& best) {
    PlaceTrials trials(grower_, first_, goal_, progress_);
    std::vector<UnprovenPlace> unproven = best.unproven;
    for (int round = 0; round < kMostRounds && !best.is_met() && trials.run(unproven); ++round) {
      Grown anew = grower_.grow_anew(first_, trials.changed_pieces(), trials.fine_places());
      RefinementOutcome refined = refine_once(anew.surface, field_, goal_, progress_);
      if (!refined.is_met()) repair_places(refined, field_, goal_, kThoroughRepair, progress_);
      unproven = refined.unproven;
      if (refined.unproven_faces() >= best.unproven_faces()) continue;
      grown = std::move(anew);
      best = std::move(refined);
    }
  }

  PieceGrower& grower_;
  const VesselField& field_;
  const RefinementGoal goal_;
  const Progress& progress_;
  Grown first_;
};

// How long triangles may be in the end.
struct Coarseness {
  bool may_be_coarser;  ///< whether vertices are left out
  double elongation;
};

// Leaves out vertices, and hands the surface over.
class Finish {
 public:
  Finish(WholeSurface whole, const VesselRings& tubes, const GenerateOptions& options, const Coarseness& coarseness,
         const Progress& progress)
      : whole_(std::move(whole)), tubes_(tubes), options_(options), coarseness_(coarseness), progress_(progress) {}

  /// Returns which faces cross.
  std::vector<std::pair<Index, Index>> run(GenerateResult& result) {
    if (coarseness_.may_be_coarser && whole_.grown.crossings.empty()) leave_out_vertices();
    tell(result);
    return std::move(whole_.grown.crossings);
  }

 private:
  void leave_out_vertices() {
    FinishedSurface surface = whole_.grown.surface;
    const auto longest = [&](const CenterlineBinding& at) {
      return tubes_.longest_at(at.segment, at.t, coarseness_.elongation);
    };
    refused_ += coarsen(surface, tubes_.field(), {options_.max_error, options_.least_vertices}, longest, progress_);
    if (options_.max_error.is_set()) {
      // Faces that were proven by bending their shells are at corners that stay; neighbours may lower their shells.
      const std::vector<Index> unproven = unproven_of(surface);
      if (unproven.size() > whole_.error.unproven_faces) return;
      whole_.error.unproven_faces = unproven.size();
      whole_.error.unproven_places = places_of(surface.mesh, unproven);
    }
    static_cast<FinishedSurface&>(whole_.grown.surface) = std::move(surface);
    whole_.grown.crossings = self_intersections(whole_.grown.surface.mesh);
    coarsened_ = true;
  }

  // Refinement has lower shells than unproven_faces() where the limit is above half a radius, and other normals. With
  // its shells around what is left it is a proof as well.
  std::vector<Index> unproven_of(const FinishedSurface& surface) const {
    const ErrorLimit& limit = options_.max_error;
    std::vector<Index> faces = unproven_faces(surface.mesh, surface.binding, tubes_.field(), limit);
    if (faces.size() <= whole_.error.unproven_faces || !surface.openings.empty()) return faces;
    const FinishedMesh mesh = finished_mesh(surface);
    const std::vector<char> near = are_near(mesh, std::move(faces));
    const auto shell = [&](Index v) {
      const double radius = surface.radius[v];
      return near[v] ? shell_at(limit, radius) : limit.at(radius);
    };
    return RefinedProof(tubes_.field(), true).unproven(mesh, {}, shell, [](Index) { return false; });
  }

  // For every vertex, whether it is one of these faces or beside one.
  static std::vector<char> are_near(const FinishedMesh& mesh, std::vector<Index> faces) {
    std::vector<char> near(mesh.vertices().size(), 0);
    for (int ring = 0; ring <= 1; ++ring) {
      std::vector<Index> around;
      for (const Index f : faces) {
        for (const Index v : mesh.faces()[f]) {
          near[v] = 1;
          around.insert(around.end(), mesh.faces_around(v).begin(), mesh.faces_around(v).end());
        }
      }
      faces = std::move(around);
    }
    return near;
  }

  Elongation elongation_at(const CenterlineBinding& at) const {
    return coarsened_ ? tubes_.longest_at(at.segment, at.t, coarseness_.elongation)
                      : tubes_.elongation_at(at.segment, at.t);
  }

  void tell(GenerateResult& result) {
    result.error = std::move(whole_.error);
    const Centerline& centerline = tubes_.centerline();
    GrowthSummary& growth = result.growth;
    std::size_t filled = 0;
    growth.rungs.assign(kRungs, 0);
    growth.refused = refused_;
    growth.pieces = whole_.grown.pieces.size();
    for (PieceSurface& piece : whole_.grown.pieces) {
      growth.junctions += piece.junctions;
      growth.tubes += piece.tubes;
      filled += piece.filled_loops;
      growth.refused += piece.refused;
      ++growth.rungs[static_cast<std::size_t>(piece.rung)];
      for (GrowthSimplification& note : piece.simplifications) growth.simplifications.push_back(std::move(note));
    }
    growth.slow_pieces = slow_pieces(whole_.grown.pieces, whole_.grown.division.plans, centerline);
    growth.tubes -= whole_.grown.division.seams.size();  // the tubes on both sides of a seam count as one
    growth.components = centerline.component_count();
    growth.cycle_rank = centerline.cycle_rank() - filled;
    if (filled > 0)
      result.warnings.push_back(
          {GrowthWarning::Kind::filled_loop, filled,
           "growth: " + std::to_string(filled) +
               " loops of the centerline are too short to have a hole; the surface is filled there"});
    result.mesh = std::move(whole_.grown.surface.mesh);
    result.binding = std::move(whole_.grown.surface.binding);
    if (coarsened_ || tubes_.elongation_field()) {
      for (const CenterlineBinding& at : result.binding) {
        const Elongation allowed = elongation_at(at);
        result.elongation.push_back(allowed.times > 1 ? Vec3(allowed.times * allowed.direction) : Vec3(Vec3::Zero()));
      }
    }
    result.radius = std::move(whole_.grown.surface.radius);
    result.openings = std::move(whole_.grown.surface.openings);
  }

  WholeSurface whole_;
  const VesselRings& tubes_;
  const GenerateOptions& options_;
  const Coarseness coarseness_;
  const Progress& progress_;
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
  // Triangles at openings stay as they are if they cannot be proven: they had better be long from the beginning. But
  // those that grow long are skewer than those of an even surface, and many are left when a number of vertices is.
  const bool grow_long =
      options.least_vertices == 0 && std::any_of(open.begin(), open.end(), [](char is_open) { return is_open != 0; });
  const auto finish = [&](WholeSurface whole, const PieceGrower& grower, bool coarser) {
    return Finish(std::move(whole), grower.tubes(), options, {coarser, options.elongation}, progress).run(result);
  };
  if (!options.max_error.is_set() || (options.elongation > 1 && (!may_be_coarser || grow_long))) {
    PieceGrower grower(field, open, options, {}, progress);
    WholeSurface whole = grow_as_given(grower, options);
    return finish(std::move(whole), grower, may_be_coarser && has_goal);
  }
  // An even surface is refined as a whole, then left as long triangles as may be. What cannot be proven then may be
  // where pieces are refined as they grow.
  GenerateOptions even = options;
  even.max_error = {};
  even.elongation = 1;
  PieceGrower even_grower(field, open, even, options.max_error, progress);
  const RefinementGoal goal{options.max_error, options.placement, static_cast<std::size_t>(options.max_vertices)};
  WholeSurface best = RefinedGrowth(even_grower, goal, progress).run();
  if (best.has_met_limit) return finish(std::move(best), even_grower, may_be_coarser);
  VesselField precise = field;
  precise.use_double_precision();
  PieceGrower grower(precise, open, options, {}, progress);
  WholeSurface whole = grow_as_given(grower, options);
  if (whole.error.unproven_faces >= best.error.unproven_faces)
    return finish(std::move(best), even_grower, may_be_coarser);
  return finish(std::move(whole), grower, may_be_coarser && has_goal);
}

}  // namespace vmesh
