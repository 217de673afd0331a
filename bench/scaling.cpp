// Time and memory of generating and of evaluating a surface as the centerline grows, on one thread and on two, as a
// table in Markdown with the exponent of the last tenfold step. Every run is a process of its own, so that its peak
// memory is its own. Usage: bench_scaling [SEGMENTS...]; without numbers 100 to 100,000.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include "vmesh/centerline/synthetic_tree.h"
#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/surface/generate.h"

namespace {

using namespace vmesh;

constexpr std::size_t kSamples = 100'000;

struct Run {
  double vertices = 0, generate_s = 0, generate_mb = 0, evaluate_s = 0, evaluate_mb = 0;
};

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

template <class Work>
double seconds_of(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Run measure(int segments, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  SyntheticTreeOptions tree;
  tree.vertices = segments + 1;
  const Centerline centerline = synthetic_tree(tree);
  GenerateOptions options;
  options.threads = threads;
  options.max_vertices = 1'000'000'000;
  Run run;
  GenerateResult surface;
  run.generate_s = seconds_of([&] { surface = generate_surface(centerline, options); });
  run.generate_mb = peak_mb();
  run.vertices = static_cast<double>(surface.mesh.vertices.size());
  run.evaluate_s = seconds_of([&] {
    measure_faces(surface.mesh);
    find_defects(surface.mesh);
    measure_vessel_distance(surface.mesh, ClosestPointIndex(surface.mesh), VesselField(centerline, 0), kSamples);
  });
  run.evaluate_mb = peak_mb();
  return run;
}

// In a process of its own. Without a value it has failed, and said why.
bool measure_apart(int segments, int threads, Run& run) {
  std::array<int, 2> ends;
  if (pipe(ends.data()) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    try {
      run = measure(segments, threads);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%d segments: %s\n", segments, error.what());
      _exit(1);
    }
    _exit(write(ends[1], &run, sizeof run) == sizeof run ? 0 : 1);
  }
  close(ends[1]);
  const bool complete = child > 0 && read(ends[0], &run, sizeof run) == sizeof run;
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  return complete;
}

double exponent(double cost, double cost_before, double size, double size_before) {
  return std::log(cost / cost_before) / std::log(size / size_before);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {100, 1000, 10'000, 100'000};
  std::printf(
      "| segments | threads | vertices | generate, s | us a vertex | exponent | peak MB | evaluate, s | us a vertex | "
      "exponent | peak MB |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const int threads : {1, 2}) {
    Run before;
    int size_before = 0;
    for (const int segments : sizes) {
      Run run;
      if (!measure_apart(segments, threads, run)) return 1;
      std::printf("| %d | %d | %.0f | %.2f | %.1f | ", segments, threads, run.vertices, run.generate_s,
                  1e6 * run.generate_s / run.vertices);
      if (size_before > 0) std::printf("%.2f", exponent(run.generate_s, before.generate_s, segments, size_before));
      std::printf(" | %.0f | %.2f | %.1f | ", run.generate_mb, run.evaluate_s, 1e6 * run.evaluate_s / run.vertices);
      if (size_before > 0) std::printf("%.2f", exponent(run.evaluate_s, before.evaluate_s, segments, size_before));
      std::printf(" | %.0f |\n", run.evaluate_mb);
      std::fflush(stdout);
      before = run;
      size_before = segments;
    }
  }
}
