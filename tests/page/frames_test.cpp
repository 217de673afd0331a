// A motion on a page: moves correctly and stays small.
#include <gtest/gtest.h>

#include "page/page.h"
#include "unpack.h"

namespace vmesh::testing {
namespace {

Centerline two_nodes() { return {{{Vec3(0, 0, 0), 1}, {Vec3(0, 0, 10), 1}}, {{0, 1}}}; }

TEST(PageFrames, AddUpToThePlacesOfEveryFrame) {
  TriMesh mesh{{{0, 0, 0}, {100, 0, 0}, {0, 50, 0}}, {{0, 1, 2}}};
  tool::PageFrames frames(mesh, two_nodes(), 3);
  const double step = 100 / 65535.;
  std::vector<std::int64_t> places(3 * 5);
  for (int frame = 0; frame < 3; ++frame) {
    for (Vec3& p : mesh.vertices) p += Vec3(frame, -7 * frame, 0.25 * frame);  // out of its box, too
    const std::vector<Vec3> nodes = {{0, 0, 0}, {0, 1. * frame, 10}};
    frames.add(0.5 * frame, mesh.vertices, nodes);
    const std::vector<std::int64_t> moves = unpack(frames.packed().back(), 3);
    ASSERT_EQ(moves.size(), places.size());
    for (std::size_t i = 0; i < moves.size(); ++i) places[i] += moves[i];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(step * static_cast<double>(places[6 + axis]), mesh.vertices[2][axis], 0.501 * step);
      EXPECT_NEAR(step * static_cast<double>(places[12 + axis]), nodes[1][axis], 0.501 * step);
    }
  }
  EXPECT_EQ(frames.time_s(), (std::vector<double>{0, 0.5, 1}));
}

TEST(PageFrames, OfManyVerticesAreSomeAndTheLast) {
  TriMesh mesh;
  mesh.vertices.assign(700'000, Vec3(1, 2, 3));
  tool::PageFrames frames(mesh, two_nodes(), 8);
  EXPECT_EQ(frames.every(), 2u);
  for (int frame = 0; frame < 8; ++frame) frames.add(frame, mesh.vertices, {{0, 0, 0}, {0, 0, 10}});
  EXPECT_EQ(frames.time_s(), (std::vector<double>{0, 2, 4, 6, 7}));
}

}  // namespace
}  // namespace vmesh::testing
