#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "vmesh/centerline/synthetic_tree.h"
#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/surface/generate.h"

#include "exit_code.h"
#include "interrupt.h"
#include "outputs.h"
#include "report_output.h"
#include "summary.h"
#include "verbs.h"

namespace vmesh::tool {
namespace {

/// A column of the paper's Table 1.
struct PaperCase {
  const char* name;
  std::size_t segments, triangles, vertices;
  double deform_ms, synchronise_ms, total_ms;
};

constexpr std::array kPaper = {PaperCase{"B", 118, 2426, 1215, 0.4, 1.5, 1.9},
                               PaperCase{"C", 118, 9799, 4907, 0.4, 6.1, 6.5},
                               PaperCase{"D", 1559, 25730, 12867, 5.5, 21, 26.5}};
constexpr int kFrames = 200;

Centerline tree_of(std::size_t segments) {
  SyntheticTreeOptions options;
  options.vertices = segments + 1;
  return synthetic_tree(options);
}

/// The surface whose number of vertices is nearest to `vertices`: it grows with `around`.
GenerateResult surface_of(const Centerline& centerline, std::size_t vertices) {
  const auto at = [&](int around) {
    stop_if_interrupted();
    GenerateOptions options;
    options.around = around;
    return generate_surface(centerline, options);
  };
  const auto off = [vertices](const GenerateResult& result) {
    return std::abs(static_cast<double>(result.mesh.vertices.size()) - static_cast<double>(vertices));
  };
  int around = 3;
  GenerateResult best = at(around);
  for (;;) {
    GenerateResult next = at(++around);
    if (off(next) >= off(best)) return best;
    best = std::move(next);
  }
}

/// The widest end's node is held, the last node is dragged around a circle of 10 mm, everything hangs in the earth's
/// gravity: nothing is ever at rest.
class Swing {
 public:
  Swing(const Centerline& centerline, double step_s, int iterations)
      : step_s_(step_s),
        tip_(static_cast<Index>(centerline.nodes().size() - 1)),
        simulation_(centerline, segment_properties(centerline, {}), options_of(step_s, iterations)),
        from_(simulation_.position(tip_)) {
    simulation_.clamp(0);
  }

  StepReport step() {
    time_ += step_s_;
    const double angle = 4 * time_;
    simulation_.drag(tip_, from_ + 10 * Vec3(std::cos(angle) - 1, std::sin(angle), 0));
    return simulation_.step();
  }
  CenterlineSimulation& simulation() { return simulation_; }
  const std::vector<Vec3>& positions() const { return simulation_.pose().position; }

 private:
  static SimulationOptions options_of(double step_s, int iterations) {
    SimulationOptions options;
    options.step_s = step_s;
    options.iterations = iterations;
    options.gravity_mm_s2 = Vec3(0, 0, -9810);
    return options;
  }

  double step_s_, time_ = 0;
  Index tip_;
  CenterlineSimulation simulation_;
  Vec3 from_;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Medians over the frames, ms.
struct Cost {
  std::size_t segments = 0, vertices = 0, triangles = 0;
  double deform_ms = 0, synchronise_ms = 0;

  double total_ms() const { return deform_ms + synchronise_ms; }
};

Cost measure(const PaperCase& paper) {
  const Centerline centerline = tree_of(paper.segments);
  const GenerateResult grown = surface_of(centerline, paper.vertices);
  Swing swing(centerline, 0.02, SimulationOptions{}.iterations);
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : grown.binding) places.push_back({segment, t});
  const SurfaceBinding binding(centerline, swing.simulation().tree(), grown.mesh.vertices, vertex_normals(grown.mesh),
                               places);
  DeformedSurface surface = binding.make_surface();
  std::vector<double> deform, synchronise;
  for (int i = 0; i < kFrames; ++i) {
    stop_if_interrupted();
    Stopwatch watch;
    swing.step();
    deform.push_back(1e3 * watch.lap());
    binding.apply(swing.simulation().pose(), swing.simulation().moved(), surface);
    swing.simulation().clear_moved();
    synchronise.push_back(1e3 * watch.lap());
  }
  return {centerline.segments().size(), grown.mesh.vertices.size(), grown.mesh.faces.size(), median(deform),
          median(synchronise)};
}

/// One line of the trade between cost and accuracy.
struct Trade {
  double step_ms;
  int iterations;
  double deform_ms, mean_mm, max_mm;  ///< distance of nodes from the converged solution of the same step
};

std::vector<Trade> measure_trades(std::size_t segments) {
  constexpr int kConverged = 60;
  constexpr double kDuration_s = 1;
  const Centerline centerline = tree_of(segments);
  std::vector<Trade> trades;
  for (const double step_s : {0.005, 0.01, 0.02}) {
    Swing converged(centerline, step_s, kConverged);
    std::vector<std::vector<Vec3>> exact;
    for (double t = 0; t < kDuration_s; t += step_s) {
      stop_if_interrupted();
      converged.step();
      exact.push_back(converged.positions());
    }
    for (const int iterations : {1, 2, 3, 5}) {
      Swing swing(centerline, step_s, iterations);
      std::vector<double> times;
      double sum = 0, most = 0;
      for (const std::vector<Vec3>& expected : exact) {
        Stopwatch watch;
        swing.step();
        times.push_back(1e3 * watch.lap());
        for (std::size_t j = 0; j < expected.size(); ++j) {
          const double off = (swing.positions()[j] - expected[j]).norm();
          sum += off;
          most = std::max(most, off);
        }
      }
      trades.push_back({1e3 * step_s, iterations, median(times),
                        sum / static_cast<double>(exact.size() * exact.front().size()), most});
    }
  }
  return trades;
}

std::string fixed(double value) {
  char text[40];
  std::snprintf(text, sizeof text, value < 0.1 ? "%.4f" : "%.3f", value);
  return text;
}

std::string sizes(std::size_t a, std::size_t b) { return std::to_string(a) + "/" + std::to_string(b); }

ReportTable cost_table(const std::vector<Cost>& costs) {
  ReportTable table{
      "table1", "Table 1, median of " + std::to_string(kFrames) + " frames of 20 ms, one thread", {""}, {}};
  std::vector<std::vector<std::string>> rows = {{"segments/vertices of the centerline"},
                                                {"triangles/vertices of the surface"},
                                                {"deformation, ms"},
                                                {"synchronisation, ms"},
                                                {"total, ms"},
                                                {"share of synchronisation, %"},
                                                {"times faster"}};
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const PaperCase& p = kPaper[i];
    const Cost& c = costs[i];
    table.columns.push_back(std::string(p.name) + ", paper");
    table.columns.push_back(std::string(p.name) + ", vmesh");
    const std::vector<std::string> cells[] = {
        {sizes(p.segments, p.segments + 1), sizes(c.segments, c.segments + 1)},
        {sizes(p.triangles, p.vertices), sizes(c.triangles, c.vertices)},
        {fixed(p.deform_ms), fixed(c.deform_ms)},
        {fixed(p.synchronise_ms), fixed(c.synchronise_ms)},
        {fixed(p.total_ms), fixed(c.total_ms())},
        {fixed(100 * p.synchronise_ms / p.total_ms), fixed(100 * c.synchronise_ms / c.total_ms())},
        {"1", fixed(p.total_ms / c.total_ms())}};
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].insert(rows[r].end(), cells[r].begin(), cells[r].end());
  }
  table.rows = rows;
  return table;
}

ReportTable trade_table(const std::vector<Trade>& trades) {
  ReportTable table{"trade",
                    "Accuracy against cost, 1,559 segments: nodes off the converged solution of the same step over 1 s",
                    {"step, iterations", "ms a step", "mean, mm", "largest, mm"},
                    {}};
  for (const Trade& t : trades) {
    table.rows.push_back({fixed(t.step_ms) + " ms, " + std::to_string(t.iterations), fixed(t.deform_ms),
                          fixed(t.mean_mm), fixed(t.max_mm)});
  }
  return table;
}

Json to_json(const Cost& cost) {
  return {{"segments", cost.segments},
          {"vertices", cost.vertices},
          {"triangles", cost.triangles},
          {"deform_ms", cost.deform_ms},
          {"synchronise_ms", cost.synchronise_ms}};
}

Json to_json(const Trade& t) {
  return {{"step_ms", t.step_ms},
          {"iterations", t.iterations},
          {"deform_ms", t.deform_ms},
          {"mean_mm", t.mean_mm},
          {"max_mm", t.max_mm}};
}

Json to_json(const std::vector<Cost>& costs, const std::vector<Trade>& trades) {
  Json json = {{"schema", "vmesh.table1/1"},
               {"generator", generator_json()},
               {"costs", Json::array()},
               {"trades", Json::array()}};
  for (const Cost& cost : costs) json["costs"].push_back(to_json(cost));
  for (const Trade& trade : trades) json["trades"].push_back(to_json(trade));
  return json;
}

}  // namespace

int run(const Table1Arguments& arguments, Console& console) {
  check_outputs(
      {{arguments.common.json, PlannedOutput::Kind::summary}, {arguments.report, PlannedOutput::Kind::report}}, {});
  std::vector<Cost> costs;
  for (const PaperCase& paper : kPaper) {
    console.log("measuring " + std::to_string(paper.segments) + " segments, " + std::to_string(paper.vertices) +
                " vertices");
    costs.push_back(measure(paper));
  }
  console.log("measuring accuracy against cost");
  const std::vector<Trade> trades = measure_trades(kPaper.back().segments);
  write_report({cost_table(costs), trade_table(trades)}, to_json(costs, trades),
               {arguments.format, arguments.common.json, arguments.report});
  return kOk;
}

}  // namespace vmesh::tool
