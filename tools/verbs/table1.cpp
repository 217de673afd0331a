#include <algorithm>
#include <array>
#include <cmath>

#include "vmesh/deform/surface_binding.h"
#include "vmesh/surface/generate.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/deform_trade.h"
#include "report/pressed_tree.h"

namespace vmesh::tool::table1_verb {
namespace {

struct Table1Arguments {
  CommonArguments common;
  ReportArguments report;
  std::filesystem::path plot;  ///< .svg; empty: none
};

void add_options(CLI::App& verb, Table1Arguments& arguments) {
  add_report(verb, arguments.report);
  verb.add_option("--plot", arguments.plot, "accuracy against time, as a picture (.svg)")->type_name("FILE.svg");
}

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

/// The surface whose number of vertices is nearest to `vertices`, found by varying `around`.
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

/// Medians over the frames, ms.
struct Cost {
  std::size_t segments = 0, vertices = 0, triangles = 0;
  double deform_1_ms = 0, deform_ms = 0;                // at one iteration and at two
  double synchronise_ms = 0, synchronise_plain_ms = 0;  // with normals and without
  double contacts = 0, contacts_ms = 0, tissue_ms = 0;  // deformation while balls press, their mean; in tissue

  double total_ms() const { return deform_ms + synchronise_ms; }
};

/// Times of one moving vessel with a given number of iterations.
struct FrameTimes {
  std::vector<double> deform, synchronise, synchronise_plain;
};

FrameTimes swing(const Centerline& centerline, const GenerateResult& grown, int iterations) {
  SimulationOptions options;
  options.iterations = iterations;
  Swing swing(centerline, options);
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : grown.binding) places.push_back({segment, t});
  const SurfaceBinding binding(centerline, swing.simulation().tree(), grown.mesh.vertices, vertex_normals(grown.mesh),
                               places);
  DeformedSurface plain = binding.make_surface(), surface = binding.make_surface(SurfaceBinding::Normals::with);
  FrameTimes times;
  for (int i = 0; i < kFrames; ++i) {
    stop_if_interrupted();
    Stopwatch watch;
    swing.step();
    times.deform.push_back(1e3 * watch.lap());
    binding.apply(swing.simulation().pose(), swing.simulation().moved(), surface);
    times.synchronise.push_back(1e3 * watch.lap());
    binding.apply(swing.simulation().pose(), swing.simulation().moved(), plain);
    times.synchronise_plain.push_back(1e3 * watch.lap());
    swing.simulation().clear_moved();
  }
  return times;
}

/// The median of all frames' times, ms.
template <class Step>
double median_step_ms(const Step& step) {
  std::vector<double> times;
  for (int i = 0; i < kFrames; ++i) {
    stop_if_interrupted();
    Stopwatch watch;
    step();
    times.push_back(1e3 * watch.lap());
  }
  return median(times);
}

void measure_with_contacts(const Centerline& centerline, Cost& cost) {
  PressedTree tree(centerline);
  for (int i = 0; i < kFrames / 4; ++i) tree.step();  // until all balls are where they press
  cost.contacts_ms = median_step_ms([&] {
    tree.step();
    cost.contacts += static_cast<double>(tree.contacts()) / kFrames;
  });
}

double time_in_tissue_ms(const Centerline& centerline) {
  Swing swing(centerline, {});
  for (Index s = 0; s < centerline.segments().size(); ++s) swing.simulation().set_tissue(s, {1e-3, 1});
  return median_step_ms([&] { swing.step(); });
}

Cost measure(const PaperCase& paper) {
  const Centerline centerline = tree_of(paper.segments);
  const GenerateResult grown = surface_of(centerline, paper.vertices);
  const FrameTimes one = swing(centerline, grown, 1), two = swing(centerline, grown, 2);
  Cost cost{centerline.segments().size(), grown.mesh.vertices.size(), grown.mesh.faces.size(),      median(one.deform),
            median(two.deform),           median(two.synchronise),    median(two.synchronise_plain)};
  measure_with_contacts(centerline, cost);
  cost.tissue_ms = time_in_tissue_ms(centerline);
  return cost;
}

std::string sizes(std::size_t a, std::size_t b) { return std::to_string(a) + "/" + std::to_string(b); }

ReportTable cost_table(const std::vector<Cost>& costs) {
  ReportTable table{
      "table1", "Table 1, median of " + std::to_string(kFrames) + " frames of 20 ms, one thread", {""}, {}};
  std::vector<std::vector<std::string>> rows = {{"segments/vertices of the centerline"},
                                                {"triangles/vertices of the surface"},
                                                {"deformation, one iteration, ms"},
                                                {"deformation, two iterations, ms"},
                                                {"synchronisation, ms"},
                                                {"the same without normals, ms"},
                                                {"total, one iteration, ms"},
                                                {"total, two iterations, ms"},
                                                {"contacts with instruments"},
                                                {"total with these, ms"},
                                                {"total in tissue, ms"},
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
        {"", fixed(c.deform_1_ms)},
        {fixed(p.deform_ms), fixed(c.deform_ms)},
        {fixed(p.synchronise_ms), fixed(c.synchronise_ms)},
        {"", fixed(c.synchronise_plain_ms)},
        {"", fixed(c.deform_1_ms + c.synchronise_ms)},
        {fixed(p.total_ms), fixed(c.total_ms())},
        {"", fixed(c.contacts)},
        {"", fixed(c.contacts_ms + c.synchronise_ms)},
        {"", fixed(c.tissue_ms + c.synchronise_ms)},
        {fixed(100 * p.synchronise_ms / p.total_ms), fixed(100 * c.synchronise_ms / c.total_ms())},
        {"1", fixed(p.total_ms / c.total_ms())}};
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].insert(rows[r].end(), cells[r].begin(), cells[r].end());
  }
  table.rows = rows;
  return table;
}

Json to_json(const Cost& cost) {
  return {{"segments", cost.segments},
          {"vertices", cost.vertices},
          {"triangles", cost.triangles},
          {"deform_one_iteration_ms", cost.deform_1_ms},
          {"deform_ms", cost.deform_ms},
          {"synchronise_ms", cost.synchronise_ms},
          {"synchronise_without_normals_ms", cost.synchronise_plain_ms},
          {"contacts", cost.contacts},
          {"deform_with_contacts_ms", cost.contacts_ms},
          {"deform_in_tissue_ms", cost.tissue_ms}};
}

Json to_json(const std::vector<Cost>& costs, const std::vector<DeformTrade>& trades) {
  return {{"schema", "vmesh.table1/1"},
          {"generator", generator_json()},
          {"costs", list_json(costs, [](const Cost& cost) { return to_json(cost); })},
          {"trades", list_json(trades, [](const DeformTrade& trade) { return tool::to_json(trade); })}};
}

int run(const Table1Arguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  check_outputs(
      {{arguments.common.json, Kind::summary}, {arguments.report.file, Kind::report}, {arguments.plot, Kind::plot}},
      {});
  std::vector<Cost> costs;
  for (const PaperCase& paper : kPaper) {
    console.log("measuring " + std::to_string(paper.segments) + " segments, " + std::to_string(paper.vertices) +
                " vertices");
    costs.push_back(measure(paper));
  }
  console.log("measuring accuracy against cost");
  const std::vector<DeformTrade> trades = measure_deform_trades(kPaper.back().segments);
  write_report({cost_table(costs), trade_table(trades)}, to_json(costs, trades), arguments.report,
               arguments.common.json);
  if (!arguments.plot.empty()) write_text(arguments.plot, plot_deform_trades(trades));
  return kOk;
}

const VerbRegistration<Table1Arguments> kRegistration({
    .rank = 130,
    .name = "table1",
    .help = "Measure deformation and synchronisation as in the paper's Table 1, on synthetic trees of its sizes",
    .examples = R"(Examples:
  vmesh table1
  vmesh table1 --format markdown --report table1.md --plot trade.svg)",
    .add_options = add_options,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::table1_verb
