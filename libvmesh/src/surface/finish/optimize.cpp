#include "surface/finish/optimize.h"

#include "vmesh/core/execution.h"

#include "surface/check/error_limit.h"
#include "surface/remesh/balance.h"
#include "surface/remesh/limit_sizes.h"
#include "surface/remesh/polish.h"
#include "surface/remesh/relocation.h"
#include "surface/remesh/remesher.h"
#include "surface/remesh/untangle.h"
#include "surface/remesh/valleys.h"

namespace vmesh {
namespace {

// Share of the sweeps that work towards the size field; the rest work on shape alone; safe 0.49 to 0.98.
constexpr double kSizingShare = 0.7;
// Share of the sweeps that also flip towards valence 6; safe 0.56 to 1.1.
constexpr double kRegularityShare = 0.8;
constexpr double kVerticesPerRadius = 7;  // per length of one radius, at kGrownAround; idle 4.9 to 9.8
// Most vertices, relative to those grown plus those expected; well-grown trees reach 0.6; safe 1 to 2.1.
constexpr double kMaxExcess = 1.5;
constexpr int kStrayInterval = 4;  // safe 3 to 6
// Share of vertices in tangles above which growth must have covered vessels twice; safe 0.014 to 0.028.
constexpr double kMostTangled = 0.02;
// Share of the tangles: if more are left after a round of untangling, it is the last.
constexpr double kStillTangled = 0.9;
// The same of crowded surfaces. Measured on short stars of 500 branches: with kStillTangled, the last rounds loosen few
// of a thousand tangles, and each takes a hundredth of the time.
constexpr double kStillTangledInPits = 0.5;
// A second round changes mean skewness and mean error by less than 1 % (ten liver trees, tree1560), but some error
// limits are proven only with it. kBalanceRounds: safe 0 to 2; kBalanceRoundsWithLimit: safe 1 to 3; kBalanceSweeps:
// safe 4 to 8.
constexpr int kBalanceRounds = 1, kBalanceRoundsWithLimit = 2, kBalanceSweeps = 6;
// Energies below which polishing leaves faces alone: skewness about 0.32 and 0.25. The first takes 0.69 times as long
// and leaves a better mean; proofs need the second. kGoodEnergy: safe only at this value, below skewer, slower, above
// skewer; kGoodEnergyWithLimit: safe 0.77 to 1.5.
constexpr double kGoodEnergy = 1.2, kGoodEnergyWithLimit = 1.1;
constexpr int kMostLiftDropRounds = 4;  // idle 3 to 6
// Patience: rounds without another face proven; the last one may need edges a seventh as long; idle 10 to 20.
constexpr int kErrorRounds = 14;
constexpr int kErrorSweeps = 4;  // safe 3 to 6
// Target lengths from which on edges between rings are looked at, with more vertices around than kFewAround, and split
// where they are as long as others that are. Measured at 96 around: with 1.6, where two fifths of the time go into
// triangles that nothing but a split makes better, three liver trees and tree119 have maximum skewness .28 to .35 (with
// this .25 to .27), mean skewness 1 to 8 % greater, and at most .4 % fewer vertices (tree119: 2 %). 1.2 gives the same.
constexpr double kStretched = 1.3;
constexpr int kFewAround = 24;
constexpr int kStretchRounds = 4;  // each at least halves the longest
// Of target lengths that a limit asks for where the surface is refined later; and rounds until edges are hardly longer.
constexpr double kTooLong = 1.3;
constexpr int kFitRounds = 2;
constexpr int kSpotRounds = 10;       // each at most halves the edges; idle 7 to 14
constexpr int kLeastWithLimit = 4;    // fewest vertices around with an error limit; idle 3 to 6
constexpr double kMostRefined = 1.8;  // edge length before refinement relative to that after; idle 1.3 to 2.5
// Factors on the target edge length where the error is too large; kFiner: safe 0.74 to 0.87, below vertices +9 %, above
// not sound, vertices +7 %, skewer, unproven, slower; kFinest: idle 0.07 to 0.14.
constexpr double kFiner = 0.87, kFinest = 0.1;

// Of the elongation beyond 1, where the error is too large: that goes before edges are shortened all around.
constexpr double kShorter = 0.6, kLeastShare = 0.1;

class Optimizer {
 public:
  Optimizer(BoundSurface& surface, const GenerateOptions& options, const Progress& progress)
      : state_(surface), remesher_(state_), options_(options), progress_(progress), check_(options.max_error) {}

  OptimizeReport run(const GrownMesh& grown) {
    const bool with_limit = options_.max_error.is_set();
    to_be_proven_ = with_limit || grown.to_be_proven;
    const double expected = (with_limit ? kMostRefined * kMostRefined : 1) * grown.expected_vertices;
    remesher_.limit_vertices(static_cast<std::size_t>(kMaxExcess * (state_.mesh.number_of_vertices() + expected)));
    const auto lift_limit = [&] {
      if (with_limit) remesher_.limit_vertices(options_.max_vertices);
    };
    if (grown.stage == GrownMesh::Stage::assembled) {
      lift_limit();
      edge_per_radius_ = intended_edge(options_.around);
      state_.update_sizes(edge_per_radius_, options_.max_error);
      for (int round = 0; !state_.surface.fine_spots.empty() && round < kSpotRounds; ++round) {
        state_.stir_all();
        refine();
      }
      if (!with_limit && options_.around > kFewAround) even_out_stretched();
      if (state_.surface.refined_to.is_set()) fit_to_limit();
    } else {
      even_out(grown.around);
      lift_limit();
    }
    if (grown.stage == GrownMesh::Stage::piece) {
      if (options_.max_error.is_set()) finish_piece();
    } else {
      finish();
    }
    return {is_hopeless(options_.around), crosses_, tangles_, remesher_.limited(), std::move(unproven_)};
  }

 private:
  void even_out(double around) {
    optimize_at(around);
    while (around != options_.around && !is_hopeless(around)) {
      around = std::min<double>(2 * around, options_.around);
      optimize_at(around);
    }
  }

  void finish() {
    settle();
    polish(state_, remesher_, good_energy());
    crosses_ = drop_crossing_lifts();
    if (options_.max_error.is_set()) {
      meet_error_limit(true);
      crosses_ = !find_crossing_walls(state_).empty();
    }
    tangles_ = crosses_ ? find_tangles(state_).size() : 0;
  }

  // The rest of the surface does not exist yet: only what cannot be mended later is checked.
  void finish_piece() {
    settle();
    meet_error_limit(false);
    tangles_ = find_tangles(state_).size();
  }

  // Moves vertices to where the placement wants them and lets assembled pieces converge.
  void settle() {
    const int rounds = options_.max_error.is_set() ? kBalanceRoundsWithLimit : kBalanceRounds;
    for (int round = 0; round < rounds; ++round) {
      if (balanced()) {
        balance(state_, options_.max_error);
        balance(state_, options_.max_error);
      }
      state_.stir_all();
      shape_sweeps(std::max(0, options_.sweeps - kBalanceSweeps), options_.sweeps);
    }
    if (balanced()) balance(state_, options_.max_error);
  }

  double good_energy() const { return options_.max_error.is_set() ? kGoodEnergyWithLimit : kGoodEnergy; }

  bool balanced() const { return options_.placement == Placement::balanced; }

  // Vertices of crossing faces are moved back onto the boundary; those that still cross their own neighbours are
  // loosened. Returns whether any faces cross in the end.
  bool drop_crossing_lifts() {
    std::vector<Vertex> crossing = find_crossing_walls(state_);
    for (const bool last : {false, true}) {
      for (int round = 0; balanced() && round < kMostLiftDropRounds && !crossing.empty(); ++round) {
        drop_lifts(state_, crossing);
        crossing = find_crossing_walls(state_);
      }
      if (crossing.empty() || last || !balanced()) break;
      untangle();
      crossing = find_crossing_walls(state_);
    }
    return !crossing.empty();
  }

  // Refines where the limit is not proven, until it is or triangles get too small. Polishing may break proofs: then
  // refines again, and if that fails, once more after settling.
  void meet_error_limit(bool polished) {
    refine_unproven();
    if (!polished || !unproven_.empty()) return;
    polish(state_, remesher_, good_energy());
    drop_crossing_lifts();
    refine_unproven();
    if (unproven_.empty()) return;
    settle();
    drop_crossing_lifts();
    refine_unproven();
  }

  void refine_unproven() {
    unproven_ = check_.unproven_faces(state_);
    const double at_first = static_cast<double>(unproven_.size());
    std::size_t fewest = unproven_.size() + 1;
    for (int round = 0, best = 0; !unproven_.empty() && round < best + kErrorRounds; ++round) {
      report_progress(progress_, "refine", 1 - static_cast<double>(unproven_.size()) / at_first);
      if (unproven_.size() < fewest) {
        fewest = unproven_.size();
        best = round;
      }
      // Refining a folded surface proves nothing.
      if (too_tangled(find_tangles(state_))) break;
      if (!make_finer(unproven_)) break;
      refine();
      unproven_ = check_.unproven_faces(state_);
    }
  }

  // Sweeps towards the size field from what has been stirred.
  void resize() {
    for (int sweep = 0; sweep < kErrorSweeps && state_.next_sweep() > 0; ++sweep) {
      state_.update_sizes(edge_per_radius_, options_.max_error);
      if (sweep == 0) remesher_.repair_strays();
      remesher_.split_long_edges();
      remesher_.collapse_short_edges();
      end_sweep(0);
    }
  }

  // A bend turns the rings around it, so on its outside they are farther apart than along the vessel, the more so the
  // finer they are; and shape alone, which knows no size, makes the triangles between them wide as well. Vertices that
  // hang over a valley return first: where edges are shorter, a sheet of many hangs there, and none may turn so far
  // (vessel_portal at 48 around, blend .5: .019 radii off, else .003).
  void even_out_stretched() {
    for (int round = 0; round < kStretchRounds; ++round) {
      if (state_.field.relations().blend() > 0) {
        make_valleys_finer(state_);
        state_.update_sizes(edge_per_radius_);
      }
      return_to_boundary(state_);
      if (!touch_stretched(kStretched)) break;
      resize();
    }
  }

  // What is refined later had better have the right sizes now.
  void fit_to_limit() {
    for (int round = 0; round < kFitRounds; ++round) {
      make_finer_for(state_, edge_per_radius_, state_.surface.refined_to);
      state_.update_sizes(edge_per_radius_);
      if (!touch_stretched(kTooLong)) break;
      resize();
    }
  }

  bool touch_stretched(double most) {
    bool any = false;
    for (const Edge e : state_.mesh.edges()) {
      const Vertex a = state_.mesh.vertex(e, 0), b = state_.mesh.vertex(e, 1);
      if ((state_.surface.held(a) && state_.surface.held(b)) || state_.length(e) <= most * state_.target_length(e))
        continue;
      state_.touch(a);
      state_.touch(b);
      any = true;
    }
    return any;
  }

  void refine() {
    resize();
    if (balanced()) balance(state_, options_.max_error);
    state_.next_sweep();
    end_sweep(options_.sweeps);
    if (balanced()) balance(state_, options_.max_error);
  }

  bool make_finer(const std::vector<Face>& faces) {
    std::vector<Vertex> vertices;
    for (const Face f : faces) {
      for (const Vertex v : state_.corners(f)) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    bool any = false;
    for (const Vertex v : vertices) {
      if (is_calm(v)) continue;
      double& fineness = state_.surface[v].fineness;
      double& share = state_.surface[v].elongation_share;
      if (state_.surface[v].elongation != Vec3::Zero() && share > kLeastShare) {
        share = kShorter * share > kLeastShare ? kShorter * share : 0;
        state_.stir(v);
        any = true;
        continue;
      }
      if (fineness * kFiner < kFinest) continue;
      fineness *= kFiner;
      state_.stir(v);
      any = true;
    }
    return any;
  }

  bool is_calm(Vertex v) const {
    const auto& spots = state_.surface.calm_spots;
    return std::any_of(spots.begin(), spots.end(), [&](const BoundSurface::Spot& spot) {
      return (state_.point(v) - spot.position).squaredNorm() < spot.radius * spot.radius;
    });
  }

  double intended_edge(double around) const {
    return std::sqrt(options_.ring_spacing) * edge_length_per_radius(around);
  }

  void optimize_at(double around) {
    edge_per_radius_ = intended_edge(around);
    state_.stir_all();
    sweep_from(0, [&] { state_.stir_all(); });
    untangle();
  }

  void untangle() {
    std::vector<Vertex> tangles = find_tangles(state_);
    while (!tangles.empty() && !too_tangled(tangles)) {
      const std::vector<Vertex> loosened = loosen(state_, tangles);
      sweep_from(options_.sweeps / 2, [&] { stir_loosened(loosened); });
      const std::size_t before = tangles.size();
      tangles = find_tangles(state_);
      const double still_tangled = state_.surface.crowded ? kStillTangledInPits : kStillTangled;
      if (static_cast<double>(tangles.size()) > still_tangled * static_cast<double>(before)) break;
    }
    tangles_ = tangles.size();
  }

  // Stirs everything if an error limit is to be proven: otherwise, of eight sharp forks of 30 degrees, seven were not
  // proven at 5 %.
  void stir_loosened(const std::vector<Vertex>& loosened) {
    if (to_be_proven_) return state_.stir_all();
    for (const Vertex v : loosened) {
      if (!state_.mesh.is_removed(v)) state_.stir(v);
    }
  }

  bool too_tangled(const std::vector<Vertex>& tangles) const { return too_many(tangles.size()); }

  bool too_many(std::size_t tangles) const {
    return static_cast<double>(tangles) > kMostTangled * state_.mesh.number_of_vertices();
  }

  // Tangles at this resolution stay where more vertices are added, at a price: their faces are nearly coplanar.
  bool is_hopeless(double around) const { return around >= kFewAround && too_many(tangles_); }

  // Sweeps from number `first` on: towards the size field, then for shape alone, each until nothing changes. When the
  // rules change, `stir_again` reactivates vertices that had converged.
  template <class StirAgain>
  void sweep_from(int first, const StirAgain& stir_again) {
    const int shape_begin = static_cast<int>(kSizingShare * options_.sweeps);
    for (int sweep = first; sweep < shape_begin && begin_sweep(sweep); ++sweep) {
      state_.update_sizes(edge_per_radius_, options_.max_error);
      if (sweep % kStrayInterval == 0) remesher_.repair_strays();
      remesher_.split_long_edges();
      remesher_.collapse_short_edges();
      end_sweep(sweep);
    }
    stir_again();
    state_.next_sweep();
    remesher_.split_far_faces(options_.max_center_distance);
    const int irregular_begin = static_cast<int>(kRegularityShare * options_.sweeps);
    stir_again();
    shape_sweeps(std::max(first, shape_begin), irregular_begin);
    stir_again();
    shape_sweeps(std::max(first, irregular_begin), options_.sweeps);
  }

  void shape_sweeps(int begin, int end) {
    for (int sweep = begin; sweep < end && begin_sweep(sweep); ++sweep) {
      remesher_.collapse_bad_faces();
      end_sweep(sweep);
    }
  }

  double done(int sweep) const { return static_cast<double>(sweep) / options_.sweeps; }

  bool begin_sweep(int sweep) {
    report_progress(progress_, "optimize", done(sweep));
    return state_.next_sweep() > 0;
  }

  void end_sweep(int sweep) {
    remesher_.flip_edges(done(sweep) < kRegularityShare ? 1 - done(sweep) : 0);
    relocate_vertices(state_);
    if (execution_params().intermediate_checks) state_.surface.require_closed("a surface that is optimised");
  }

  SweepState state_;
  Remesher remesher_;
  const GenerateOptions& options_;
  const Progress& progress_;
  ErrorLimitCheck check_;
  double edge_per_radius_ = 0;
  bool to_be_proven_ = false;
  bool crosses_ = false;
  std::size_t tangles_ = 0;
  std::vector<Face> unproven_;
};

}  // namespace

int least_around(const Centerline& centerline, const ErrorLimit& limit) {
  if (!limit.is_set()) return 3;
  const auto raised = [](int around, double edge, double times) {
    while (edge_length_per_radius(around) > times * edge && around < 200) ++around;
    return around;
  };
  int around = kLeastWithLimit;
  if (std::isfinite(limit.relative)) around = raised(around, edge_length_for(limit.relative, 1), 1);
  for (const auto& [position, radius] : centerline.nodes())
    around = raised(around, edge_length_for(limit.at(radius), radius) / radius, kMostRefined);
  return around;
}

double expected_vertices(const Centerline& centerline, double around, const ErrorLimit& limit) {
  const auto expected = [&](double length, double radius) {
    const double coarse = edge_length_per_radius(around) * radius;
    const double finer = limit.is_set() ? std::max(1.0, coarse / edge_length_for(limit.at(radius), radius)) : 1;
    return finer * finer * expected_vertices(length / radius, around);
  };
  double vertices = 0;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    vertices += expected(centerline.length(s), centerline.radius_at(s, 0.5));
  }
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    // A sphere has the area of a cylinder as long as its diameter.
    const double radius = centerline.node(n).radius;
    if (centerline.degree(n) == 0) vertices += expected(2 * radius, radius);
  }
  return vertices;
}

double expected_vertices(double length_in_radii, double around) {
  const double finer = around / kGrownAround;
  return kVerticesPerRadius * finer * finer * length_in_radii;
}

OptimizeReport optimize(BoundSurface& surface, const GenerateOptions& options, const GrownMesh& grown,
                        const Progress& progress) {
  return Optimizer(surface, options, progress).run(grown);
}

}  // namespace vmesh
