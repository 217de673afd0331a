// The cost of measuring all faces of a surface of 178,000 faces, summarising the measures, and finding defects.
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>

#include "vmesh/quality/quality_report.h"

namespace {

using namespace vmesh;

// A torus with slightly displaced vertices, so that no two faces are alike.
TriMesh uneven_torus() {
  constexpr Index kAlong = 446, kAround = 200;
  TriMesh mesh;
  for (Index i = 0; i < kAlong; ++i) {
    for (Index j = 0; j < kAround; ++j) {
      const double u = 2 * std::numbers::pi * (i + 0.3 * std::sin(17.0 * j + i)) / kAlong;
      const double v = 2 * std::numbers::pi * (j + 0.3 * std::sin(13.0 * i + j)) / kAround;
      const double x = 30 + 10 * std::cos(v);
      mesh.vertices.emplace_back(x * std::cos(u), x * std::sin(u), 10 * std::sin(v));
    }
  }
  const auto at = [](Index i, Index j) { return i % kAlong * kAround + j % kAround; };
  for (Index i = 0; i < kAlong; ++i) {
    for (Index j = 0; j < kAround; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

void face_measures(benchmark::State& state) {
  const TriMesh mesh = uneven_torus();
  for (auto _ : state) benchmark::DoNotOptimize(measure_faces(mesh));
  state.counters["faces"] = static_cast<double>(mesh.faces.size());
}

void face_distributions(benchmark::State& state) {
  const FaceMeasures measures = measure_faces(uneven_torus());
  for (auto _ : state) {
    for_each_face_measure(measures, [](const char*, const std::vector<double>& values, double, double) {
      benchmark::DoNotOptimize(summarize(values));
    });
  }
}

void defects(benchmark::State& state) {
  const TriMesh mesh = uneven_torus();
  for (auto _ : state) benchmark::DoNotOptimize(find_defects(mesh));
}

BENCHMARK(face_measures)->Unit(benchmark::kMillisecond);
BENCHMARK(face_distributions)->Unit(benchmark::kMillisecond);
BENCHMARK(defects)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
