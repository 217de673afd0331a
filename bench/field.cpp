// The cost of queries of the vessel field, on synthetic trees.
#include <benchmark/benchmark.h>

#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/vessel_field.h"

namespace {

using namespace vmesh;

Centerline tree_of(benchmark::State& state) {
  SyntheticTreeOptions options;
  options.vertices = static_cast<std::size_t>(state.range(0));
  return synthetic_tree(options);
}

// Points at half and one and a half radii from the axis, as in growth and optimisation.
template <class Query>
void ask(benchmark::State& state, const VesselField& field, Query&& query) {
  Index cone = 0;
  double sum = 0;
  for (auto _ : state) {
    const double r = field.relations().radius_at(cone, 0.5);
    const Vec3 side = (field.relations().axis_point(cone, 1) - field.relations().axis_point(cone, 0)).unitOrthogonal();
    const Vec3 p = field.relations().axis_point(cone, 0.5) + (cone % 2 ? 0.5 : 1.5) * r * side;
    sum += query(p, cone).distance;
    cone = (cone + 1) % static_cast<Index>(field.relations().cone_count());
  }
  benchmark::DoNotOptimize(sum);
}

void field_local(benchmark::State& state) {
  const Centerline centerline = tree_of(state);
  const VesselField field(centerline, 0.5);
  ask(state, field, [&](const Vec3& p, Index cone) { return field.sample(p, cone); });
}

void field_global(benchmark::State& state) {
  const Centerline centerline = tree_of(state);
  const VesselField field(centerline);
  ask(state, field, [&](const Vec3& p, Index) { return field.sample_global(p); });
}

BENCHMARK(field_local)->Arg(119)->Arg(1560);
BENCHMARK(field_global)->Arg(119)->Arg(1560);

}  // namespace

BENCHMARK_MAIN();
