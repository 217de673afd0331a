#include "surface/optimize.h"

#include "surface/balance.h"
#include "surface/relocation.h"
#include "surface/remesher.h"
#include "surface/untangle.h"

namespace vmesh {
namespace {

constexpr double kSizingShare = 0.7;      // of the sweeps that work towards the size field; the rest for shape alone
constexpr double kRegularityShare = 0.8;  // of the sweeps that flip towards valence 6 as well
constexpr double kVerticesPerRadius = 7;  // and unit of length, at kGrownAround
constexpr double kMaxExcess = 1.5;  // vertices against those grown plus those expected; well-grown trees reach 0.6
constexpr int kStrayInterval = 4;
constexpr double kHopeless = 0.02;  // share of the vertices in tangles: growth covered vessels twice
constexpr int kBalanceRounds = 2, kBalanceSweeps = 6;
constexpr int kPolishRounds = 20, kPolishPower = 16;
constexpr double kPolishEnergy = 1.15;  // of a face: skewness 0.28
constexpr int kSinkRounds = 4;

class Optimizer {
 public:
  Optimizer(BoundSurface& surface, const GenerateOptions& options, const Progress& progress)
      : state_(surface), remesher_(state_), options_(options), progress_(progress) {}

  OptimizeReport run(const GrownMesh& grown) {
    remesher_.limit_vertices(
        static_cast<std::size_t>(kMaxExcess * (state_.mesh.number_of_vertices() + grown.expected_vertices)));
    double around = grown.around;
    optimize_at(around);
    while (around != options_.around) {
      around = std::min<double>(2 * around, options_.around);
      optimize_at(around);
    }
    if (grown.polish) finish(grown.balance);
    return {tangles_, remesher_.limited()};
  }

 private:
  void finish(bool balanced) {
    for (int round = 0; balanced && round < kBalanceRounds; ++round) {
      balance(state_);
      balance(state_);
      state_.stir_all();
      shape_sweeps(options_.sweeps - kBalanceSweeps, options_.sweeps);
    }
    if (balanced) balance(state_);
    polish();
    for (int round = 0; balanced && round < kSinkRounds; ++round) {
      const std::vector<Vertex> crossing = find_crossing_walls(state_);
      if (crossing.empty()) break;
      sink(state_, crossing);
    }
  }

  // The worst triangles, and what is around them, at the cost of the rest.
  void polish() {
    for (int round = 0; round < kPolishRounds; ++round) {
      for (const Face f : state_.mesh.faces()) {
        const auto [a, b, c] = state_.corners(f);
        if (state_.energy(a, b, c) < kPolishEnergy) continue;
        for (const Vertex v : {a, b, c}) state_.stir(v);
      }
      if (state_.next_sweep() == 0) break;
      remesher_.flip_edges(0);
      relocate_vertices(state_, kPolishPower);
    }
  }

  void optimize_at(double around) {
    edge_per_radius_ = edge_length_per_radius(around);
    state_.stir_all();
    sweep_from(0);
    std::vector<Vertex> tangles = find_tangles(state_);
    while (!tangles.empty() && !hopeless(tangles)) {
      loosen(state_, tangles);
      sweep_from(options_.sweeps / 2);
      const std::size_t before = tangles.size();
      tangles = find_tangles(state_);
      if (tangles.size() >= before) break;
    }
    tangles_ = tangles.size();
  }

  bool hopeless(const std::vector<Vertex>& tangles) const {
    return static_cast<double>(tangles.size()) > kHopeless * state_.mesh.number_of_vertices();
  }

  // Sweeps from number `first` on: towards the size field, then for shape alone. Each until nothing changes any more.
  void sweep_from(int first) {
    const int shape_begin = static_cast<int>(kSizingShare * options_.sweeps);
    for (int sweep = first; sweep < shape_begin && begin_sweep(sweep); ++sweep) {
      state_.update_sizes(edge_per_radius_);
      if (sweep % kStrayInterval == 0) remesher_.repair_strays();
      remesher_.split_long_edges();
      remesher_.collapse_short_edges();
      end_sweep(sweep);
    }
    remesher_.split_far_faces(options_.max_center_distance);
    // What had come to rest is looked at again where the rules change.
    const int irregular_begin = static_cast<int>(kRegularityShare * options_.sweeps);
    state_.stir_all();
    shape_sweeps(std::max(first, shape_begin), irregular_begin);
    state_.stir_all();
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
  }

  SweepState state_;
  Remesher remesher_;
  const GenerateOptions& options_;
  const Progress& progress_;
  double edge_per_radius_ = 0;
  std::size_t tangles_ = 0;
};

}  // namespace

double expected_vertices(const Centerline& centerline, double around) {
  return expected_vertices(centerline.length_in_radii(), around);
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
