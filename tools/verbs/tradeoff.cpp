#include "vmesh/tuning/tradeoff.h"

#include "vmesh/io/sha256.h"

#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/pages.h"

namespace vmesh::tool::tradeoff_verb {
namespace {

struct TradeoffArguments {
  CommonArguments common;
  InputArguments input;
  TradeoffOptions options;
  ReportArguments report;
  std::filesystem::path plot;  ///< SVG; empty: none
};

void add_options(CLI::App& verb, TradeoffArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline");
  add_report(verb, arguments.report);
  verb.add_option("--plot", arguments.plot, "error against time and against vertices, as a picture (.svg)")
      ->type_name("FILE.svg");
  add_number(verb, "--samples", arguments.options.samples, std::size_t{1}, std::size_t{10'000'000},
             "points on each surface and on the vessels");
  verb.add_flag("--fine", arguments.options.fine,
                "also the accurate end: up to 96 around, limits down to .25 %, finer voxels; many times as long");
  add_number(verb, "--threads", arguments.options.generate.threads, 0, 4096, "to work on; 0: all");
  add_html(verb, arguments.common);
}

constexpr const char* kPeers[] = {"marching cubes, decimated", "marching cubes, quadric decimation", "marching cubes"};
constexpr const char* kOurs[] = {"max-error", "around, blend 0", "vertices, elongation 16"};

std::string text_or_dash(double value) { return std::isfinite(value) ? format_briefly(value) : "-"; }

std::string ratio(double ours, double theirs) { return text_or_dash(ours / theirs); }

ReportTable points_table(const std::vector<TradeoffPoint>& points) {
  ReportTable table{"points",
                    "Time and vertices against accuracy",
                    {"curve", "setting", "seconds", "vertices", "skewness mean", "max", "error mean, mm", "rms", "max",
                     "mean, radii", "rms", "max", "sound", "best for time", "best for vertices"},
                    {}};
  for (const TradeoffPoint& p : points) {
    std::vector<std::string> row = {p.curve, p.setting, format_briefly(p.seconds), std::to_string(p.vertices)};
    for (const double value : {p.skewness_mean, p.skewness_max, p.error_mean_mm, p.error_rms_mm, p.error_max_mm,
                               p.error_mean_relative, p.error_rms_relative, p.error_max_relative})
      row.push_back(format_briefly(value));
    for (const bool value : {p.sound, p.best_for_time, p.best_for_vertices}) row.push_back(yes_no(value));
    table.rows.push_back(std::move(row));
  }
  return table;
}

// vmesh at the points of its peers: vertices for the same maximum error, mean error and skewness with as many vertices.
ReportTable peers_table(const std::vector<TradeoffPoint>& points) {
  ReportTable table{"peers",
                    "vmesh against marching cubes: ratios below 1 favour vmesh, - where the curve has ended",
                    {"peer", "vertices", "vmesh curve", "vertices at its max error, ratio",
                     "mean error with its vertices, ratio", "mean skewness with its vertices, ratio"},
                    {}};
  for (const char* peer : kPeers) {
    for (const char* ours : kOurs) {
      for (const CurveComparison& c : compare_curves(points, ours, peer)) {
        const auto vertices = static_cast<double>(c.theirs.vertices);
        table.rows.push_back({peer, std::to_string(c.theirs.vertices), ours, ratio(c.our_vertices, vertices),
                              ratio(c.our_error_mean_mm, c.theirs.error_mean_mm),
                              ratio(c.our_skewness_mean, c.theirs.skewness_mean)});
      }
    }
  }
  return table;
}

Json point_json(const TradeoffPoint& p) {
  return {{"curve", p.curve},
          {"setting", p.setting},
          {"seconds", p.seconds},
          {"vertices", p.vertices},
          {"skewness", {{"mean", p.skewness_mean}, {"max", p.skewness_max}}},
          {"error_mm", {{"mean", p.error_mean_mm}, {"rms", p.error_rms_mm}, {"max", p.error_max_mm}}},
          {"error_in_local_radii",
           {{"mean", p.error_mean_relative}, {"rms", p.error_rms_relative}, {"max", p.error_max_relative}}},
          {"sound", p.sound},
          {"best_for_time", p.best_for_time},
          {"best_for_vertices", p.best_for_vertices}};
}

Json report_json(const TradeoffArguments& arguments, const Centerline& centerline,
                 const std::vector<TradeoffPoint>& points) {
  const std::filesystem::path& path = arguments.input.path;
  return {{"schema", "vmesh.tradeoff/1"},
          {"generator", generator_json()},
          {"input", {{"file", path.string()}, {"sha256", sha256_of(arguments.input)}}},
          {"centerline", to_json(centerline)},
          {"points", list_json(points, point_json)}};
}

int run(const TradeoffArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  check_outputs({{arguments.report.file, Kind::report},
                 {arguments.plot, Kind::plot},
                 {arguments.common.json, Kind::summary},
                 {arguments.common.html, Kind::page}},
                files_of(arguments.input));
  const Centerline centerline = load_clean_centerline(arguments.input, console).cleaned.centerline;
  const std::vector<TradeoffPoint> points = sweep_tradeoff(centerline, arguments.options, console.progress());
  const std::vector<ReportTable> tables = {points_table(points), peers_table(points)};
  if (!arguments.common.html.empty())
    write_page(arguments.common.html, page_of(arguments.common, arguments.input.path, centerline, points, tables),
               console);
  write_report(tables, report_json(arguments, centerline, points), arguments.report, arguments.common.json);
  if (!arguments.plot.empty()) write_text(arguments.plot, plot_tradeoff(points));
  return kOk;
}

const VerbRegistration<TradeoffArguments> kRegistration({
    .rank = 110,
    .name = "tradeoff",
    .help = "Grow a centerline's surface with many settings, and compare accuracy against time and vertices",
    .examples = R"(Examples:
  vmesh tradeoff tree.swc --report tradeoff.md --plot tradeoff.svg --json tradeoff.json)",
    .add_options = add_options,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::tradeoff_verb
