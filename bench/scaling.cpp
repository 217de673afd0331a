// Time and memory of generating and of evaluating a surface as the centerline grows, as a table in Markdown: medians of
// some runs, and the exponent of the step from one line to the next beside that of n log n. Every run is a process of
// its own, so that its peak memory is its own; all sizes are run once before any is run again, so that changes in the
// machine's speed affect all. Measurements are reported on standard error as they are made. Usage: bench_scaling
// [--runs=N] [--threads=N] [--shape=tree|star|short-star|chain|walk] [SEGMENTS...]; 3 runs each on one thread and on
// two, of 100 to 100,000. The other shapes are those of tests/support/hard_vessels.h; vessels that touch are separated
// first, which counts.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/surface/generate.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/contacts.h"

#include "hard_vessels.h"

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

Centerline vessels(std::string_view shape, int segments) {
  if (shape == "star") return testing::star(segments / 3);
  if (shape == "short-star") return testing::short_star(segments / 2);
  if (shape == "chain") return testing::uneven_chain(segments + 1, 1);
  if (shape == "walk") return testing::random_walk(segments + 1, 1);
  SyntheticTreeOptions tree;
  tree.vertices = segments + 1;
  return synthetic_tree(tree);
}

Run measure(std::string_view shape, int segments, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  Centerline centerline = vessels(shape, segments);
  GenerateOptions options;
  options.threads = threads;
  options.max_vertices = 1'000'000'000;
  Run run;
  GenerateResult surface;
  run.generate_s = seconds_of([&] {
    if (shape != "tree") centerline = separate_contacts(centerline).centerline;
    surface = generate_surface(centerline, options);
  });
  if (!surface.is_sound()) throw std::runtime_error(surface.defects.front().message);
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

// Measures in a separate process; returns false if that failed, having said why.
bool measure_apart(std::string_view shape, int segments, int threads, Run& run) {
  std::array<int, 2> ends;
  if (pipe(ends.data()) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    try {
      run = measure(shape, segments, threads);
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

double median_of(std::vector<Run>& runs, double Run::*value) {
  const auto middle = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2);
  std::nth_element(runs.begin(), middle, runs.end(),
                   [value](const Run& x, const Run& y) { return x.*value < y.*value; });
  return (*middle).*value;
}

Run medians(std::vector<Run> runs) {
  Run median;
  for (const auto value : {&Run::vertices, &Run::generate_s, &Run::generate_mb, &Run::evaluate_s, &Run::evaluate_mb}) {
    median.*value = median_of(runs, value);
  }
  return median;
}

// Runs of every size; empty if one has failed.
std::vector<std::vector<Run>> measure_all(std::string_view shape, const std::vector<int>& sizes, int threads,
                                          int runs) {
  std::vector<std::vector<Run>> measured(sizes.size());
  for (int r = 0; r < runs; ++r) {
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      Run run;
      if (!measure_apart(shape, sizes[i], threads, run)) return {};
      std::fprintf(stderr, "%d segments, %d threads, run %d: generate %.2f s, evaluate %.2f s\n", sizes[i], threads,
                   r + 1, run.generate_s, run.evaluate_s);
      measured[i].push_back(run);
    }
  }
  return measured;
}

double exponent(double cost, double cost_before, double size, double size_before) {
  return std::log(cost / cost_before) / std::log(size / size_before);
}

double n_log_n(double n) { return n * std::log(n); }

void print_line(int segments, int threads, const Run& run) {
  std::printf("| %d | %d | %.0f | %.2f | %.1f | %.0f | %.2f | %.1f | %.0f |", segments, threads, run.vertices,
              run.generate_s, 1e6 * run.generate_s / run.vertices, run.generate_mb, run.evaluate_s,
              1e6 * run.evaluate_s / run.vertices, run.evaluate_mb);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes, thread_counts = {1, 2};
  std::string_view shape = "tree";
  int runs = 3;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument.starts_with("--runs=")) {
      runs = std::max(1, std::atoi(argv[i] + 7));
    } else if (argument.starts_with("--threads=")) {
      thread_counts = {std::max(1, std::atoi(argv[i] + 10))};
    } else if (argument.starts_with("--shape=")) {
      shape = argument.substr(8);
    } else {
      sizes.push_back(std::atoi(argv[i]));
    }
  }
  if (sizes.empty()) sizes = {100, 1000, 10'000, 100'000};
  std::printf(
      "| segments | threads | vertices | generate, s | us a vertex | peak MB | evaluate, s | us a vertex | peak MB | "
      "exponents: generate | evaluate | n log n |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const int threads : thread_counts) {
    const auto measured = measure_all(shape, sizes, threads, runs);
    if (measured.empty()) return 1;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const Run run = medians(measured[i]);
      print_line(sizes[i], threads, run);
      if (i == 0) {
        std::printf(" | | |\n");
        continue;
      }
      const Run before = medians(measured[i - 1]);
      std::printf(" %.2f | %.2f | %.2f |\n", exponent(run.generate_s, before.generate_s, sizes[i], sizes[i - 1]),
                  exponent(run.evaluate_s, before.evaluate_s, sizes[i], sizes[i - 1]),
                  exponent(n_log_n(sizes[i]), n_log_n(sizes[i - 1]), sizes[i], sizes[i - 1]));
    }
  }
}
