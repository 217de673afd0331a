// Counts sound and unsound surfaces, over files and over random trees. A table in Markdown of those that are not
// (--all: of all) and one closing line. Usage:
//   bench_soundness [--all] [--keep] [--growth METHOD] [--beta B] [--around N] [--blend B] [--elongation E]
//                   [--max-error LIMIT] [--least-vertices N] [--rotate] [FILE...]
//                   [--noisy FIRST COUNT] [--plausible FIRST COUNT] [--looped FIRST COUNT]
//                   [--short-thick FIRST COUNT]
// --rotate grows each random tree with the next of a list of options, whatever --around and --blend; --keep does not
// separate vessels that touch; LIMIT as in `vmesh generate`.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/production/produce.h"
#include "vmesh/surface/metric_skewness.h"

#include "random_vessels.h"
#include "rotated_options.h"

namespace {

using namespace vmesh;

struct Settings {
  bool all = false, keep = false, rotate = false;
  GenerateOptions options;
};

struct Tally {
  std::size_t cases = 0, unsound = 0, refused = 0;
  double seconds = 0;
};

// Nodes of branches listed as left out do not count.
std::size_t nodes_outside(const GenerateResult& result) {
  return static_cast<std::size_t>(std::count_if(result.defects.begin(), result.defects.end(), [](const Defect& defect) {
    return defect.kind == DefectKind::node_outside;
  }));
}

void examine(const std::string& name, const Centerline& given, const GenerateOptions& wanted, const Settings& settings,
             Tally& tally) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  ++tally.cases;
  ProductionOptions options;
  options.growth = wanted;
  options.preparation.separate = !settings.keep;
  Production production;
  try {
    production = produce(given, {}, options);
  } catch (const std::exception& error) {
    ++tally.refused;
    std::printf("| %s | refused: %s |\n", name.c_str(), error.what());
    return;
  }
  const GenerateResult& result = production.result;
  const PreparedCenterline& prepared = production.prepared;
  const std::size_t left = prepared.separated ? prepared.separated->report.left.size() : 0;
  const double spent = seconds();
  tally.seconds += spent;
  const Topology topology = measure_topology(with_lids(result));
  const auto crossings = self_intersections(result.mesh);
  const SkewnessSummary skewness = summarize_skewness(metric_skewness(result.mesh, result.elongation));
  const std::size_t outside = nodes_outside(result);
  const bool guided = options.growth.growth == GrowthMethod::guided;
  const std::size_t expected_components = guided ? result.growth.components : given.component_count();
  const std::size_t expected_loops = guided ? result.growth.cycle_rank : given.cycle_rank();
  const bool topology_right = topology.closed && topology.manifold && topology.oriented && topology.outward &&
                              topology.components == expected_components &&
                              topology.genus == static_cast<std::int64_t>(expected_loops);
  const bool sound = topology_right && crossings.empty() && outside == 0 && skewness.max <= kWorstSkewness;
  tally.unsound += !sound;
  if (sound && !settings.all) return;
  const Vec3 at = result.defects.empty() ? Vec3::Zero() : result.defects.front().position;
  std::string rungs;
  for (const std::size_t count : result.growth.rungs)
    rungs.append(rungs.empty() ? "" : " ").append(std::to_string(count));
  std::printf("| %s | %zu | %zu | %.3f / %.3f | %s | %zu | %zu | %zu | %zu | %s | %.2f | (%.2f %.2f %.2f) |\n",
              name.c_str(), prepared.grown().nodes().size(), result.mesh.vertices.size(), skewness.mean, skewness.max,
              topology_right ? "right" : "WRONG", crossings.size(), outside, left, result.error.unproven_faces,
              rungs.c_str(), spent, at.x(), at.y(), at.z());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  settings.options.threads = 1;
  Tally tally;
  std::printf(
      "| case | nodes | vertices | skewness mean / max | topology | crossing pairs | nodes outside | contacts left | "
      "unproven | pieces by rung | s | first defect |\n|---|--:|--:|--:|---|--:|--:|--:|--:|---|--:|---|\n");
  const auto random = [&](const char* name, std::uint32_t first, std::uint32_t count, auto&& make) {
    for (std::uint32_t seed = first; seed < first + count; ++seed) {
      GenerateOptions options = settings.rotate ? testing::rotated_options(seed) : settings.options;
      options.threads = settings.options.threads;
      options.beta = settings.options.beta;
      options.growth = settings.options.growth;
      options.elongation = settings.options.elongation;
      if (settings.options.max_error.is_set()) options.max_error = settings.options.max_error;
      examine(std::string(name) + "_" + std::to_string(seed), make(seed), options, settings, tally);
    }
  };
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto number = [&](int k) { return static_cast<std::uint32_t>(std::atoi(argv[i + k])); };
    if (word == "--all") {
      settings.all = true;
    } else if (word == "--keep") {
      settings.keep = true;
    } else if (word == "--rotate") {
      settings.rotate = true;
    } else if (word == "--growth" && i + 1 < argc) {
      settings.options.growth = parse_growth_method(argv[++i]);
    } else if (word == "--beta" && i + 1 < argc) {
      settings.options.beta = std::atof(argv[++i]);
    } else if (word == "--around" && i + 1 < argc) {
      settings.options.around = std::atoi(argv[++i]);
    } else if (word == "--blend" && i + 1 < argc) {
      settings.options.blend = std::atof(argv[++i]);
    } else if (word == "--elongation" && i + 1 < argc) {
      settings.options.elongation = std::atof(argv[++i]);
    } else if (word == "--max-error" && i + 1 < argc) {
      settings.options.max_error = parse_error_limit(argv[++i]);
    } else if (word == "--least-vertices" && i + 1 < argc) {
      settings.options.least_vertices = static_cast<std::size_t>(std::atoi(argv[++i]));
    } else if (word == "--noisy" && i + 2 < argc) {
      random("noisy", number(1), number(2), [](std::uint32_t seed) { return testing::noisy_tree(seed); });
      i += 2;
    } else if (word == "--plausible" && i + 2 < argc) {
      random("plausible", number(1), number(2), [](std::uint32_t seed) { return testing::plausible_tree(seed); });
      i += 2;
    } else if (word == "--short-thick" && i + 2 < argc) {
      random("short_thick", number(1), number(2), [](std::uint32_t seed) { return testing::short_thick_tree(seed); });
      i += 2;
    } else if (word == "--looped" && i + 2 < argc) {
      random("looped", number(1), number(2),
             [](std::uint32_t seed) { return testing::plausible_tree(seed, 1 + static_cast<int>(seed % 2)); });
      i += 2;
    } else {
      try {
        const Centerline centerline = load_centerline(word).cleaned.centerline;
        examine(word.substr(word.rfind('/') + 1), centerline, settings.options, settings, tally);
      } catch (const std::exception& error) {
        std::printf("| %s | not read: %s |\n", word.c_str(), error.what());
      }
    }
  }
  std::printf("\n%zu cases, %zu unsound, %zu refused, %.1f s of generating\n", tally.cases, tally.unsound,
              tally.refused, tally.seconds);
  return tally.unsound > 0 ? 1 : 0;
}
