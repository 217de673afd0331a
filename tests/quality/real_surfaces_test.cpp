#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/quality/sampled_distance.h"

#include "shared_data.h"
#include "soups.h"

namespace vmesh {
namespace {

// Bounds agree with samples.
void expect_sound(const TriMesh& mesh, const TriMesh& other) {
  HausdorffOptions options;
  options.tolerance =
      1e-4 * std::max(1.0, (mesh.vertices[mesh.faces[0][0]] - other.vertices[other.faces[0][0]]).norm());
  const Hausdorff found = hausdorff(mesh, other, options);
  for (const auto& [side, from, to] :
       {std::tuple{&found.forward, &mesh, &other}, std::tuple{&found.backward, &other, &mesh}}) {
    EXPECT_LE(side->upper - side->lower, options.tolerance);
    EXPECT_GE((side->witness.from - side->witness.to).norm(), side->lower);
    EXPECT_LE(sample_distance(*from, ClosestPointIndex(*to), 2000).distance.max, side->upper);
  }
}

TEST(RealSurfaces, AreMeasuredWhateverIsWrongWithThem) {
  VMESH_NEED_SHARED_DATA("adversarial_mesh_trimesh");
  std::size_t measured = 0;
  for (const auto& entry : std::filesystem::directory_iterator(testing::shared_data("adversarial_mesh_trimesh"))) {
    SCOPED_TRACE(entry.path().string());
    TriMesh mesh;
    try {
      mesh = read_surface(entry.path()).mesh;
    } catch (const Error&) {
      continue;  // unreadable files are tested elsewhere
    }
    ++measured;
    TriMesh ball = testing::icosphere(2);
    for (Vec3& v : ball.vertices) v += mesh.vertices[mesh.faces[0][0]];
    expect_sound(mesh, ball);
    EXPECT_EQ(measure_faces(mesh).area_mm2.size(), mesh.faces.size());
  }
  EXPECT_GE(measured, 15u);
}

TEST(RealSurfaces, AsSoupsWithFacesWithoutAreaHaveTheSameDistance) {
  const char* file = "pairs_centerline_surface/aorta-surface-open-ends.stl";
  VMESH_NEED_SHARED_DATA(file);
  const TriMesh mesh = read_surface(testing::shared_data(file)).mesh;
  testing::Draw draw(8);
  const TriMesh other = testing::shaken(mesh, draw, 0.3);
  TriMesh soup = testing::exploded(mesh);
  for (Index v = 0; v < 300; v += 3) soup.faces.insert(soup.faces.begin() + v, {{v, v + 1, v}, {v, v, v}});
  const Hausdorff x = hausdorff(mesh, other), y = hausdorff(soup, other);
  for (const auto& [a, b] : {std::pair{x.forward, y.forward}, std::pair{x.backward, y.backward}}) {
    EXPECT_GT(a.lower, 0.1);
    EXPECT_LE(a.lower, b.upper);
    EXPECT_LE(b.lower, a.upper);
  }
}

TEST(RealSurfaces, OfManyIntersectingPiecesCoincideWithThemselves) {
  const char* file = "liver_spl_atlas/spl_portal_vein_combined.ply";
  VMESH_NEED_SHARED_DATA(file);
  const TriMesh mesh = read_surface(testing::shared_data(file)).mesh;
  const Hausdorff found = hausdorff(mesh, testing::exploded(mesh));
  EXPECT_EQ(found.lower(), 0);
  EXPECT_LE(found.upper(), 1e-4);
  EXPECT_GT(find_defects(mesh).self_intersections.size(), 0u);
}

}  // namespace
}  // namespace vmesh
