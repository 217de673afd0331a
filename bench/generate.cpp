// The cost of a surface, from a centerline in memory to a checked mesh: user CPU on one thread, and wall time on one
// and on two, medians. A table in Markdown, with CGAL's Mesh_3 on the same volume beside tree1560. Usage:
//   bench_generate [--runs N] [--no-mesh-3] [FILE...]; without files, those of ../shared/data named below.
//   bench_generate --costs [FOLDER or FILE...]: what every centerline in a folder costs for its output, dearest first;
//   user CPU on one thread, once, and what may explain it.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>

#include <sys/resource.h>

#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/production/produce.h"

#include "mesh_3.h"

namespace {

using namespace vmesh;

const std::vector<std::string> kFiles = {
    "synthetic_trees/tree1560.swc",
    "synthetic_trees/tree119.swc",
    "liver_portal_centerlines/liverModelPatient1__portal1_1.swc",
    "liver_portal_centerlines/liverModelPatient1__portal3_1.swc",
    "liver_portal_centerlines/liverModelPatient1__portal15_1.swc",
    "liver_portal_centerlines/liverModelPatient1__hepatic1_1.swc",
    "liver_portal_centerlines/liverModelPatient1__hepatic3_1.swc",
    "liver_portal_centerlines/liverModelPatient1__hepatic15_1.swc",
    "liver_portal_centerlines/liverModelPatient1__arterial15_1.swc",
    "liver_portal_centerlines/liverModelPatient1__vessel_portal_1.swc",
    "liver_portal_centerlines/liverModelPatient1__vessel_hepatic_1.swc",
    "liver_portal_centerlines/liverModelPatient1__vessel_arterial_1.swc",
    "pulmonary_aorta_coronary_centerlines/D15_surface_3d_fullres_263_joined.swc",
    "pulmonary_aorta_coronary_centerlines/0030_H_ABAO_H_joined.swc",
    "pulmonary_aorta_coronary_centerlines/0052_H_CERE_H_joined.swc",
    "pulmonary_aorta_coronary_centerlines/0066_H_CORO_H_joined.swc",
    "pulmonary_aorta_coronary_centerlines/0080_H_PULM_H_joined.swc",
    "pulmonary_aorta_coronary_centerlines/PA000125_joined.swc",
};

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

struct Cost {
  double user, wall;
};

template <class Work>
Cost cost_of(Work&& work) {
  const double user = user_seconds();
  const auto begin = std::chrono::steady_clock::now();
  work();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {user_seconds() - user, wall};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Work>
Cost median_cost(int runs, Work&& work) {
  std::vector<double> user, wall;
  for (int run = 0; run < runs; ++run) {
    const Cost cost = cost_of(work);
    user.push_back(cost.user);
    wall.push_back(cost.wall);
  }
  return {median(user), median(wall)};
}

// The surface that `vmesh generate` makes.
GenerateResult surface_around(const Centerline& centerline, int threads) {
  ProductionOptions options;
  options.growth.threads = threads;
  return produce(centerline, {}, options).result;
}

void tell(const std::string& name, std::size_t nodes, const TriMesh& mesh, const Cost& one, double two) {
  const SkewnessSummary skewness = summarize_skewness(mesh);
  const auto vertices = static_cast<double>(mesh.vertices.size());
  std::printf("| %s | %zu | %zu | %.3f | %.3f | %.3f | %.0f | %.3f / %.3f |\n", name.c_str(), nodes,
              mesh.vertices.size(), one.user, one.wall, two, 1e6 * one.user / vertices, skewness.mean, skewness.max);
  std::fflush(stdout);
}

// One line of --costs.
struct InputCost {
  std::string name;
  std::size_t nodes, grown_nodes, contacts, vertices, tried_again, pieces;
  double preparing, growing;  // us of user CPU a vertex

  double all() const { return preparing + growing; }
};

InputCost input_cost(const std::string& name, const Centerline& centerline) {
  ProductionOptions options;
  options.growth.threads = 1;
  double preparing = 0, since = user_seconds();
  const double begin = since;
  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline&) { preparing += user_seconds() - since; };
  steps.grow = [&](const Centerline& grown, const GenerateOptions& growth) {
    GenerateResult result = generate_surface(grown, growth);
    since = user_seconds();
    return result;
  };
  const Production production = produce(centerline, {}, options, {}, steps);
  const double all = user_seconds() - begin;
  const auto& rungs = production.result.growth.rungs;
  const std::size_t pieces = std::accumulate(rungs.begin(), rungs.end(), std::size_t{0});
  const std::size_t vertices = production.result.mesh.vertices.size();
  const double per_vertex = 1e6 / static_cast<double>(vertices);
  return {name,
          centerline.nodes().size(),
          production.prepared.grown().nodes().size(),
          production.prepared.contacts().size(),
          vertices,
          pieces - rungs[0],
          pieces,
          per_vertex * preparing,
          per_vertex * (all - preparing)};
}

// The files in folders, and files; in order.
std::vector<std::string> files_in(const std::vector<std::string>& given) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const std::string& name : given) {
    if (!fs::is_directory(name)) {
      files.push_back(name);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(name)) {
      if (entry.is_regular_file()) files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void tell_costs(const std::vector<std::string>& given) {
  std::vector<InputCost> costs;
  std::size_t others = 0;
  for (const std::string& file : files_in(given)) {
    std::optional<Centerline> centerline;
    try {
      centerline = load_centerline(file).cleaned.centerline;
    } catch (const std::exception&) {
      ++others;
      continue;
    }
    try {
      costs.push_back(input_cost(file.substr(file.rfind('/') + 1), *centerline));
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", file.c_str(), error.what());
    }
  }
  std::stable_sort(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.all() > b.all(); });
  std::printf(
      "| centerline | nodes | nodes grown around | contacts | vertices | pieces | not at the first try | us of CPU a "
      "vertex | of them before growth |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const InputCost& c : costs)
    std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %.0f | %.0f |\n", c.name.c_str(), c.nodes, c.grown_nodes,
                c.contacts, c.vertices, c.pieces, c.tried_again, c.all(), c.preparing);
  std::printf("\n%zu other files\n", others);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "--costs") {
    tell_costs(argc > 2 ? std::vector<std::string>(argv + 2, argv + argc)
                        : std::vector<std::string>{VMESH_SHARED_DATA});
    return 0;
  }
  int runs = 5;
  bool with_mesh_3 = true;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--runs" && i + 1 < argc) {
      runs = std::max(1, std::atoi(argv[++i]));
    } else if (word == "--no-mesh-3") {
      with_mesh_3 = false;
    } else {
      files.push_back(word);
    }
  }
  if (files.empty()) {
    for (const std::string& file : kFiles) files.push_back(std::string(VMESH_SHARED_DATA) + "/" + file);
  }
  std::printf(
      "| centerline | nodes | vertices | user CPU, s | wall, s | wall on two threads, s | us of CPU a vertex | "
      "skewness "
      "mean / max |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const std::string& file : files) {
    try {
      const Centerline centerline = load_centerline(file).cleaned.centerline;
      TriMesh mesh;
      const Cost one = median_cost(runs, [&] { mesh = surface_around(centerline, 1).mesh; });
      const Cost two = median_cost(runs, [&] { mesh = surface_around(centerline, 2).mesh; });
      const std::string name = file.substr(file.rfind('/') + 1);
      tell(name, centerline.nodes().size(), mesh, one, two.wall);
      if (with_mesh_3 && name == "tree1560.swc") {
        const Cost theirs = cost_of([&] { mesh = bench::mesh_3(centerline, 6, GenerateOptions().blend); });
        tell("the same, CGAL Mesh_3", centerline.nodes().size(), mesh, theirs, theirs.wall);
      }
    } catch (const std::exception& error) {
      std::printf("| %s | %s |\n", file.c_str(), error.what());
    }
  }
}
