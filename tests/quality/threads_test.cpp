// The same numbers on any number of threads.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "vmesh/quality/closest_point.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/quality/sampled_distance.h"

#include "soups.h"

namespace vmesh {
namespace {

using testing::Draw;

template <class Work>
auto on_threads(int threads, Work work) {
  tbb::task_arena arena(threads);
  return arena.execute(work);
}

/// Two spheres with hills, closed, and with a hole each.
std::vector<std::pair<TriMesh, TriMesh>> pairs() {
  Draw draw(21);
  std::vector<std::pair<TriMesh, TriMesh>> all;
  all.emplace_back(testing::shaken(testing::icosphere(5), draw, 0.003),
                   testing::shaken(testing::icosphere(4), draw, 0.02));
  all.push_back(all.front());
  all.back().first.faces.pop_back();
  all.back().second.faces.pop_back();
  return all;
}

void expect_same(const OneSidedHausdorff& a, const OneSidedHausdorff& b) {
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.witness.from, b.witness.from);
  EXPECT_EQ(a.witness.to, b.witness.to);
  EXPECT_EQ(a.witness.from_face, b.witness.from_face);
  EXPECT_EQ(a.witness.to_face, b.witness.to_face);
}

TEST(Threads, HausdorffDistancesAreTheSame) {
  for (const auto& [a, b] : pairs()) {
    const auto measure = [&] { return hausdorff(a, b); };
    const Hausdorff one = on_threads(1, measure);
    EXPECT_GT(one.lower(), 0.01);
    for (const int threads : {2, 5}) {
      const Hausdorff many = on_threads(threads, measure);
      expect_same(one.forward, many.forward);
      expect_same(one.backward, many.backward);
    }
  }
}

TEST(Threads, SampledDistancesAndMeasuresAreTheSame) {
  for (const auto& [a, b] : pairs()) {
    const ClosestPointIndex index(b);
    const auto distances = [&] { return vertex_distances(a, index); };
    const auto samples = [&] { return sample_distance(a, index, 20'000).distance; };
    const auto measures = [&] { return measure_faces(a).equiangle_skewness; };
    EXPECT_EQ(on_threads(1, distances), on_threads(5, distances));
    EXPECT_EQ(on_threads(1, measures), on_threads(5, measures));
    const Distribution one = on_threads(1, samples), many = on_threads(5, samples);
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.p95, many.p95);
    EXPECT_EQ(one.max, many.max);
  }
}

TEST(Threads, SelfIntersectionsAreTheSame) {
  Draw draw(22);
  TriMesh mesh = testing::icosphere(6);  // 81,920 faces: more than one part
  const TriMesh other = testing::moved(testing::icosphere(4), Vec3(0.9, 0, 0));
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& f : other.faces) mesh.faces.push_back({first + f[0], first + f[1], first + f[2]});
  const auto find = [&] { return self_intersections(mesh); };
  const auto one = on_threads(1, find);
  EXPECT_GT(one.size(), 100u);
  EXPECT_EQ(one, on_threads(5, find));
}

TEST(ClosestPointIndex, LeavesAllThreadsToOthers) {
  const auto allowed = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const std::size_t before = allowed();
  const ClosestPointIndex index(TriMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(allowed(), before);
}

}  // namespace
}  // namespace vmesh
