// The cost of moving a vessel tree and keeping its surface attached, on synthetic trees of 118 to 100,000 segments; and
// of the synchronisation beside a naive one: an array of vertices in the surface's order, each with two rest vectors,
// in double, Eq. 10 as written. items_per_second counts segments or vertices.
#include <cmath>

#include <benchmark/benchmark.h>

#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/synth/synthetic_tree.h"

#include "report/pressed_tree.h"

namespace {

using namespace vmesh;

/// A moving tree and points on its wall, as dense as the paper's 12,867 vertices on 1,559 segments, in random order.
struct Scene {
  Centerline tree;
  CenterlineSimulation simulation;
  std::vector<Vec3> vertices, normals;
  std::vector<SurfacePlace> places;

  Scene(std::size_t segments, int iterations)
      : tree(synthetic_tree({.vertices = segments + 1, .seed = 1})),
        simulation(tree, segment_properties(tree, {}), options_of(iterations)) {
    simulation.clamp(0);
    const std::size_t count = segments * 12867 / 1559;
    std::uint64_t bits = 1;
    const auto uniform = [&bits] {
      bits = bits * 6364136223846793005u + 1442695040888963407u;
      return static_cast<double>(bits >> 11) * 0x1p-53;
    };
    for (std::size_t v = 0; v < count; ++v) {
      const Index s = static_cast<Index>(uniform() * static_cast<double>(segments));
      const double t = uniform(), angle = 2 * M_PI * uniform();
      const Vec3 along = (tree.point_at(s, 1) - tree.point_at(s, 0)).normalized(), across = along.unitOrthogonal();
      const Vec3 normal = std::cos(angle) * across + std::sin(angle) * along.cross(across);
      vertices.push_back(tree.point_at(s, t) + tree.radius_at(s, t) * normal);
      normals.push_back(normal);
      places.push_back({s, t});
    }
  }

  static SimulationOptions options_of(int iterations) {
    SimulationOptions options;
    options.iterations = iterations;
    options.gravity_mm_s2 = Vec3(0, 0, -9810);
    options.rest_tolerance = 0;
    return options;
  }
};

void step(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)), static_cast<int>(state.range(1)));
  const Index middle = static_cast<Index>(state.range(0) / 2);
  double time = 0;
  for (auto _ : state) {
    scene.simulation.set_force(middle, Vec3(1e-3 * std::sin(time += 0.1), 0, 0));
    benchmark::DoNotOptimize(scene.simulation.step());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// `counters` tell how many balls press, about twenty.
void step_with_contacts(benchmark::State& state) {
  tool::PressedTree tree(synthetic_tree({.vertices = static_cast<std::size_t>(state.range(0)) + 1, .seed = 1}));
  double contacts = 0, iterations = 0;
  for (auto _ : state) {
    iterations += tree.step().iterations;
    contacts += tree.contacts();
  }
  state.counters["contacts"] = contacts / static_cast<double>(state.iterations());
  state.counters["iterations"] = iterations / static_cast<double>(state.iterations());
}

void step_in_tissue(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)), 2);
  for (Index s = 0; s < scene.tree.segments().size(); ++s) scene.simulation.set_tissue(s, {1e-3, 1});
  for (auto _ : state) benchmark::DoNotOptimize(scene.simulation.step());
}

/// A hundred steps from rest, in which a tree of a Young's modulus in kPa falls onto itself; of 100, into a heap.
void fall_onto_itself(benchmark::State& state) {
  const Centerline tree = synthetic_tree({.vertices = static_cast<std::size_t>(state.range(0)) + 1, .seed = 1});
  SimulationOptions options;
  options.gravity_mm_s2 = Vec3(0, 0, -9810);
  double iterations = 0;
  for (auto _ : state) {
    const Material material{.young_Pa = 1e3 * static_cast<double>(state.range(1))};
    CenterlineSimulation simulation(tree, segment_properties(tree, material), options);
    simulation.clamp(0);
    simulation.set_contact({.self = true});
    for (int i = 0; i < 100; ++i) iterations += simulation.step().iterations;
  }
  state.counters["iterations"] = iterations / (100.0 * static_cast<double>(state.iterations()));
}

/// Only one end of the tree moves; everything else is at rest.
void step_of_a_twig(benchmark::State& state) {
  const Centerline tree = synthetic_tree({.vertices = static_cast<std::size_t>(state.range(0)) + 1, .seed = 1});
  CenterlineSimulation simulation(tree, segment_properties(tree, {.young_Pa = 1e8}), {.rest_tolerance = 1e-5});
  simulation.clamp(0);
  const Index tip = static_cast<Index>(tree.nodes().size() - 1);
  for (int i = 0; i < 50; ++i) simulation.step();
  double time = 0;
  std::size_t awake = 0, steps = 0;
  for (auto _ : state) {
    simulation.set_force(tip, Vec3(1e-6 * std::sin(time += 0.5), 0, 0));
    awake += simulation.step().awake;
    ++steps;
  }
  state.counters["awake"] = static_cast<double>(awake) / static_cast<double>(steps);
}

/// Without and with normals.
void synchronise(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)), 1);
  const SurfaceBinding binding(scene.tree, scene.simulation.tree(), scene.vertices, scene.normals, scene.places);
  for (int i = 0; i < 5; ++i) scene.simulation.step();
  const bool normals = state.range(1) != 0;
  DeformedSurface surface =
      binding.make_surface(normals ? SurfaceBinding::Normals::with : SurfaceBinding::Normals::without);
  for (auto _ : state) {
    binding.apply(scene.simulation.pose(), surface);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.vertices.size()));
  state.counters["vertices"] = static_cast<double>(scene.vertices.size());
}

struct NaiveVertex {
  Index slot, parent;
  double t;
  Vec3 own, other, own_normal, other_normal;
};

void synchronise_naive(benchmark::State& state) {
  Scene scene(static_cast<std::size_t>(state.range(0)), 1);
  const RodTree& rods = scene.simulation.tree();
  std::vector<NaiveVertex> bound;
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    const Index slot = rods.slot_of_segment[scene.places[v].segment], parent = rods.parent[slot];
    const double t = scene.places[v].t;
    const Vec3 arm = scene.vertices[v] - (1 - t) * rods.position[parent] - t * rods.position[slot];
    const Mat3 own = rods.frame[slot].transpose(), other = rods.frame[parent].transpose();
    bound.push_back({slot, parent, t, own * arm, other * arm, own * scene.normals[v], other * scene.normals[v]});
  }
  for (int i = 0; i < 5; ++i) scene.simulation.step();
  std::vector<Vec3> vertices(bound.size()), normals(bound.size());
  const Pose& pose = scene.simulation.pose();
  for (auto _ : state) {
    for (std::size_t v = 0; v < bound.size(); ++v) {
      const NaiveVertex& b = bound[v];
      const Mat3 &own = pose.frame[b.slot], &other = pose.frame[b.parent];
      const Vec3 axis = (1 - b.t) * pose.position[b.parent] + b.t * pose.position[b.slot];
      vertices[v] = axis + 0.5 * (own * b.own + other * b.other);
      normals[v] = (own * b.own_normal + other * b.other_normal).normalized();
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(bound.size()));
}

void bind_to_nearest(benchmark::State& state) {
  const Scene scene(static_cast<std::size_t>(state.range(0)), 1);
  for (auto _ : state) benchmark::DoNotOptimize(nearest_places(scene.tree, scene.vertices));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.vertices.size()));
}

BENCHMARK(step)->ArgsProduct({{118, 1559, 10'000, 100'000}, {1, 2}})->Unit(benchmark::kMicrosecond);
BENCHMARK(step_with_contacts)->Arg(1559)->Unit(benchmark::kMicrosecond);
BENCHMARK(fall_onto_itself)->ArgsProduct({{118, 1559}, {1000, 100}})->Unit(benchmark::kMillisecond);
BENCHMARK(step_in_tissue)->Arg(1559)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_of_a_twig)->Arg(118)->Arg(1559)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(synchronise)->ArgsProduct({{118, 1559, 10'000, 100'000}, {0, 1}})->Unit(benchmark::kMicrosecond);
BENCHMARK(synchronise_naive)->Arg(118)->Arg(1559)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(bind_to_nearest)->Arg(1559)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
