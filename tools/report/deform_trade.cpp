#include "report/deform_trade.h"

#include <algorithm>
#include <cmath>

#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/tuning/plot.h"

#include "command_line/interrupt.h"

namespace vmesh::tool {
namespace {

constexpr double kFrame_s = 0.02;
constexpr int kFrames = 50, kPaperFrames = 5;  // the paper's procedure takes seconds a frame
constexpr int kParts[] = {1, 2, 4, 8, 16};     // steps of a frame
constexpr int kIterations[] = {1, 2, 3, 5};
constexpr int kConverged = 12;                           // iterations
constexpr int kFinestParts = 64, kFinestIterations = 4;  // what everything is compared with

constexpr double kLost = 1e3;  // mm off: nothing of the vessel is left

using Motion = std::vector<std::vector<Vec3>>;  // a frame each

struct Run {
  Motion motion;
  double frame_cpu_ms = 0;
  int iterations = 0;
};

Run swing(const Centerline& centerline, int parts, SimulationOptions options, int frames = kFrames) {
  options.step_s = kFrame_s / parts;
  Swing swing(centerline, options);
  Run run;
  std::vector<double> times;
  for (int frame = 0; frame < frames; ++frame) {
    stop_if_interrupted();
    Stopwatch watch;
    for (int part = 0; part < parts; ++part) run.iterations = swing.step().iterations;
    times.push_back(1e3 * watch.lap());
    run.motion.push_back(swing.positions());
  }
  run.frame_cpu_ms = median(times);
  return run;
}

void compare(const Motion& motion, const Motion& expected, double& mean, double& most) {
  double sum = 0;
  most = 0;
  for (std::size_t frame = 0; frame < motion.size(); ++frame) {
    for (std::size_t j = 0; j < expected[frame].size(); ++j) {
      const double off = (motion[frame][j] - expected[frame][j]).norm();
      sum += off;
      most = std::max(most, off);
    }
  }
  mean = sum / static_cast<double>(motion.size() * motion.front().size());
}

DeformTrade trade_of(const std::string& integrator, int parts, const Run& run, const Motion& finest) {
  DeformTrade trade;
  trade.integrator = integrator;
  trade.step_ms = 1e3 * kFrame_s / parts;
  trade.iterations = run.iterations;
  trade.frame_cpu_ms = run.frame_cpu_ms;
  compare(run.motion, finest, trade.off_mean_mm, trade.off_max_mm);
  return trade;
}

SimulationOptions implicit_with(int iterations) {
  SimulationOptions options;
  options.iterations = iterations;
  return options;
}

std::string distance_text(double mm) {
  if (std::isnan(mm)) return "-";
  return mm < kLost ? fixed(mm) : "diverges";
}

}  // namespace

Centerline tree_of(std::size_t segments) {
  SyntheticTreeOptions options;
  options.vertices = segments + 1;
  return synthetic_tree(options);
}

Swing::Swing(const Centerline& centerline, SimulationOptions options)
    : step_s_(options.step_s),
      tip_(static_cast<Index>(centerline.nodes().size() - 1)),
      simulation_(centerline, segment_properties(centerline, {}), (options.gravity_mm_s2 = Vec3(0, 0, -9810), options)),
      from_(simulation_.position(tip_)) {
  simulation_.clamp(0);
}

StepReport Swing::step() {
  time_ += step_s_;
  const double angle = 4 * time_;
  simulation_.drag(tip_, from_ + 10 * Vec3(std::cos(angle) - 1, std::sin(angle), 0));
  return simulation_.step();
}

std::vector<DeformTrade> measure_deform_trades(std::size_t segments) {
  const Centerline centerline = tree_of(segments);
  const Motion finest = swing(centerline, kFinestParts, implicit_with(kFinestIterations)).motion;
  std::vector<Motion> converged;
  for (const int parts : kParts) converged.push_back(swing(centerline, parts, implicit_with(kConverged)).motion);
  std::vector<DeformTrade> trades;
  for (const int iterations : kIterations) {
    for (std::size_t i = 0; i < converged.size(); ++i) {
      const Run run = swing(centerline, kParts[i], implicit_with(iterations));
      trades.push_back(trade_of("implicit, " + std::to_string(iterations), kParts[i], run, finest));
      compare(run.motion, converged[i], trades.back().unconverged_mean_mm, trades.back().unconverged_max_mm);
    }
  }
  SimulationOptions paper;
  paper.integrator = Integrator::paper;
  trades.push_back(trade_of("paper, printed (0.1 s)", 1, swing(centerline, 1, paper, kPaperFrames), finest));
  paper.paper = {PaperProcedure::Coupling::spring, PaperProcedure::Axes::polar};
  trades.push_back(trade_of("paper, springs (0.1 s)", 1, swing(centerline, 1, paper, kPaperFrames), finest));
  return trades;
}

ReportTable trade_table(const std::vector<DeformTrade>& trades) {
  ReportTable table{"trade",
                    "Accuracy against cost, 1,559 segments, frames of 20 ms over 1 s: how far nodes are from the "
                    "converged step, and from the motion that ever shorter steps lead to",
                    {"integrator, iterations", "step, ms", "iterations or substeps", "ms a frame",
                     "converged: mean, mm", "largest, mm", "motion: mean, mm", "largest, mm"},
                    {}};
  for (const DeformTrade& t : trades) {
    table.rows.push_back({t.integrator, fixed(t.step_ms), std::to_string(t.iterations), fixed(t.frame_cpu_ms),
                          distance_text(t.unconverged_mean_mm), distance_text(t.unconverged_max_mm),
                          distance_text(t.off_mean_mm), distance_text(t.off_max_mm)});
  }
  return table;
}

Json to_json(const DeformTrade& t) {
  return {{"integrator", t.integrator},
          {"step_ms", t.step_ms},
          {"iterations", t.iterations},
          {"frame_cpu_ms", t.frame_cpu_ms},
          {"from_converged_mm", {{"mean", t.unconverged_mean_mm}, {"max", t.unconverged_max_mm}}},
          {"from_finest_mm", {{"mean", t.off_mean_mm}, {"max", t.off_max_mm}}}};
}

std::string plot_deform_trades(const std::vector<DeformTrade>& trades) {
  LogPlot converged{"Distance from the converged step", "time per frame, ms", "mean distance, mm", {}};
  LogPlot motion{"Distance from the exact motion", "time per frame, ms", "mean distance, mm", {}};
  for (const DeformTrade& t : trades) {
    if (motion.curves.empty() || motion.curves.back().name != t.integrator) {
      converged.curves.push_back({t.integrator, {}});
      motion.curves.push_back({t.integrator, {}});
    }
    converged.curves.back().points.emplace_back(t.frame_cpu_ms, t.unconverged_mean_mm);
    if (t.off_mean_mm < kLost) motion.curves.back().points.emplace_back(t.frame_cpu_ms, t.off_mean_mm);
  }
  return svg_of({converged, motion});
}

std::string fixed(double value) { return formatted(value < 0.1 ? "%.4f" : "%.3f", value); }

}  // namespace vmesh::tool
