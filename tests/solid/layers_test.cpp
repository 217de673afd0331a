#include <cmath>
#include <utility>
#include <vector>

#include "vmesh/core/error.h"

#include "solid/layer_columns.h"
#include "solid/layer_stack.h"
#include "solid/wall_frame.h"
#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

class Layers : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  }
};

/// Height of a wedge over the face at the wall, in the middle.
double height(const VolumeMesh& mesh, const Wedge& wedge) {
  const auto& p = mesh.points;
  const Vec3 normal = (p[wedge[4]] - p[wedge[3]]).cross(p[wedge[5]] - p[wedge[3]]).normalized();
  return normal.dot(p[wedge[3]] + p[wedge[4]] + p[wedge[5]] - p[wedge[0]] - p[wedge[1]] - p[wedge[2]]) / 3;
}

/// The wedges over a face of the wall, from the wall on.
std::vector<double> heights_over(const VolumeMesh& mesh, std::size_t face, int layers) {
  const std::size_t faces = mesh.wedges.size() / static_cast<std::size_t>(layers);
  std::vector<double> heights;
  for (std::size_t k = 0; k < static_cast<std::size_t>(layers); ++k)
    heights.push_back(height(mesh, mesh.wedges[k * faces + face]));
  return heights;
}

TEST_F(Layers, GrowAndHaveTheThicknessThatWasAskedFor) {
  const VesselWall wall = grown_wall(tube(), EndShape::flat, 24);
  const VolumeResult result = make_volume(wall, {.layers = {.count = 5, .thickness = 0.3, .growth = 1.4}});
  expect_sound_lumen(wall, result);
  for (std::size_t f = 0; f < result.mesh.wedges.size() / 5; f += 17) {
    const std::vector<double> heights = heights_over(result.mesh, f, 5);
    double sum = 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
      sum += heights[k];
      // Faces meet at 15 degrees, so that heights over one of them differ by its tilt from the next.
      if (k > 0) {
        EXPECT_NEAR(heights[k] / heights[k - 1], 1.4, 0.05);
      }
    }
    EXPECT_NEAR(sum, 0.3 * 2, 0.03 * 2);
  }
}

TEST_F(Layers, BeginWithTheHeightOfTheFirst) {
  const VesselWall wall = grown_wall(tube(), EndShape::round, 12);
  const VolumeResult result = make_volume(wall, {.layers = {.count = 6, .first_mm = 0.05, .growth = 1.2}});
  expect_sound_lumen(wall, result);
  for (std::size_t f = 0; f < result.mesh.wedges.size() / 6; f += 11)
    EXPECT_NEAR(heights_over(result.mesh, f, 6)[0], 0.05, 0.005);
}

void expect_gradual(const WallFrame& frame, const LayerStack& stack) {
  for (const auto& [a, b, c] : frame.faces) {
    for (const auto& [v, w] : {std::pair{a, b}, {b, c}, {c, a}}) {
      const double distance = (frame.position[v] - frame.position[w]).norm();
      EXPECT_LE(std::abs(stack.reached_mm[v] - stack.reached_mm[w]), kLayerGradation * distance * (1 + 1e-12));
    }
  }
}

TEST(LayerColumns, OfAFaceBecomeThinnerTogetherAndGradually) {
  const VesselWall wall = grown_wall(tube(), EndShape::flat, 12);
  const WallFrame frame = frame_of(wall);
  LayerStack stack = lay_layers(frame, {.count = 4}, LayerSide::inside, {});
  const LayerStack full = stack;
  LayerColumns columns(frame, stack);
  const Triangle& face = frame.faces[frame.faces.size() / 2];
  const std::vector<LayerColumns::Change> changes = columns.thin_together(face, 0.3);
  EXPECT_GT(changes.size(), 3u);  // those around must follow
  for (const Index v : face) EXPECT_DOUBLE_EQ(stack.reached_mm[v], 0.3 * full.reached_mm[v]);
  expect_gradual(frame, stack);
  columns.take_back(changes);
  EXPECT_EQ(stack.reached_mm, full.reached_mm);
  while (!columns.thin_together(face, 0.3).empty()) {
  }
  for (const Index v : face) {
    EXPECT_GT(stack.reached_mm[v], 0);
    EXPECT_LT(stack.reached_mm[v], 0.3 * full.reached_mm[v]);
  }
  expect_gradual(frame, stack);
}

TEST_F(Layers, ASingleOne) {
  const VesselWall wall = grown_wall(bifurcation());
  const VolumeResult result = make_volume(wall, {.layers = {.count = 1, .thickness = 0.1}});
  expect_sound_lumen(wall, result);
  EXPECT_EQ(result.layers.full_share, 1);
}

TEST_F(Layers, EndInThePlaneOfACap) {
  const VesselWall wall = grown_wall(bifurcation());
  const VolumeMesh mesh = make_volume(wall).mesh;
  for (Index cap = 1; cap < wall.patch_names.size(); ++cap) {
    TriMesh disc{wall.mesh.vertices, {}};
    Vec3 area = Vec3::Zero();
    for (Index f = 0; f < wall.patch.size(); ++f) {
      if (wall.patch[f] != cap) continue;
      area += area_normal(wall.mesh, f);
      disc.faces.push_back(wall.mesh.faces[f]);
    }
    const Vec3& base = disc.vertices[disc.faces[0][0]];
    std::size_t quads = 0;
    for (const BoundaryFace& face : mesh.boundary) {
      if (face.patch != cap) continue;
      quads += !face.is_triangle();
      for (std::size_t i = 0; i < (face.is_triangle() ? 3u : 4u); ++i) {
        // Positions of tens of mm are rounded to 1e-14.
        EXPECT_NEAR(area.normalized().dot(mesh.points[face.corners[i]] - base), 0, 1e-12);
      }
    }
    EXPECT_EQ(quads, 4 * boundary_edges(disc).size());
  }
}

TEST_F(Layers, MeetInTheMiddleOfAVesselNoMoreThanTheirTetrahedraNeed) {
  const VesselWall wall = grown_wall(tube(), EndShape::flat, 12);
  const VolumeResult result = make_volume(wall, {.layers = {.count = 4, .thickness = 1.5}});
  expect_sound_lumen(wall, result);
  EXPECT_LT(result.layers.least_share, 0.6);
  ASSERT_FALSE(result.layers.thin.empty());
  EXPECT_NEAR(result.layers.thin[0].asked_mm, 3, 0.1);
}

// Twice as thick from the middle on, where the vessel is narrow.
TEST_F(Layers, ChangeTheirThicknessGradually) {
  const VesselWall wall = grown_wall(taper());
  const VolumeResult result = make_volume(wall, {.layers = {.count = 1, .thickness = 0.4, .growth = 1}});
  expect_sound_lumen(wall, result);
  const VolumeMesh& mesh = result.mesh;
  for (const Wedge& wedge : mesh.wedges) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const double at_i = (mesh.points[wedge[i + 3]] - mesh.points[wedge[i]]).norm(),
                   at_j = (mesh.points[wedge[j + 3]] - mesh.points[wedge[j]]).norm(),
                   apart = (mesh.points[wedge[i + 3]] - mesh.points[wedge[j + 3]]).norm();
      // The gradation is .2; ways may be up to twice as long as the thickness.
      EXPECT_LE(std::abs(at_i - at_j), 2 * 0.2 * apart + 0.15 * std::max(at_i, at_j));
    }
  }
}

}  // namespace
}  // namespace vmesh
