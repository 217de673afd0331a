// The cost of a surface, from a centerline in memory to a checked mesh: user CPU on one thread, and wall time on one
// and on two, medians. A table in Markdown, with CGAL's Mesh_3 on the same volume beside tree1560. Usage:
//   bench_generate [--runs N] [--no-mesh-3] [FILE...]; without files, those of ../shared/data named below.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
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

}  // namespace

int main(int argc, char** argv) {
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
