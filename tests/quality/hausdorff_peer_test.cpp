#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <gtest/gtest.h>

#include "vmesh/io/surface_io.h"
#include "vmesh/quality/hausdorff.h"

#include "shared_data.h"
#include "soups.h"

namespace vmesh {
namespace {

namespace SMS = CGAL::Surface_mesh_simplification;
using testing::Draw, testing::icosphere;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr double kTolerance = 1e-4;

Surface to_surface(const TriMesh& mesh) {
  Surface surface;
  for (const Vec3& v : mesh.vertices) surface.add_vertex({v.x(), v.y(), v.z()});
  for (const auto& [a, b, c] : mesh.faces) {
    using Vertex = Surface::Vertex_index;
    EXPECT_NE(surface.add_face(Vertex(a), Vertex(b), Vertex(c)), Surface::null_face());
  }
  return surface;
}

TriMesh to_tri_mesh(const Surface& surface) {
  TriMesh mesh;
  for (const auto v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : surface.faces()) {
    Triangle triangle;
    std::size_t i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) triangle[i++] = v;
    mesh.faces.push_back(triangle);
  }
  return mesh;
}

TriMesh decimated(const TriMesh& mesh, double share) {
  Surface surface = to_surface(mesh);
  SMS::edge_collapse(surface, SMS::Count_ratio_stop_predicate<Surface>(share));
  surface.collect_garbage();
  return to_tri_mesh(surface);
}

// Both are within the tolerance of the true value: CGAL's below or above it, ours around it.
void expect_agreement(const TriMesh& a, const TriMesh& b) {
  HausdorffOptions options;
  options.tolerance = kTolerance;
  const Hausdorff ours = hausdorff(a, b, options);
  const Surface first = to_surface(a), second = to_surface(b);
  const auto cgal = [](const Surface& from, const Surface& to) {
    return CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(from, to, kTolerance);
  };
  for (const auto& [side, theirs] :
       {std::pair{ours.forward, cgal(first, second)}, std::pair{ours.backward, cgal(second, first)}}) {
    EXPECT_LE(side.upper - side.lower, kTolerance);
    EXPECT_GE(theirs, side.lower - kTolerance);
    EXPECT_LE(theirs, side.upper + kTolerance);
  }
}

TEST(HausdorffAgainstCgal, OnRandomSurfaces) {
  Draw draw(6);
  for (int trial = 0; trial < 12; ++trial) {
    const TriMesh a = testing::shaken(icosphere(static_cast<int>(1 + draw.below(3))), draw, draw.uniform(0, 0.2));
    TriMesh b = testing::shaken(icosphere(static_cast<int>(1 + draw.below(3))), draw, draw.uniform(0, 0.2));
    b = testing::moved(testing::transformed(b, testing::some_rotation()), draw.in_cube(0.5));
    if (draw.chance(0.5)) b.faces.resize(b.faces.size() / 2);  // open
    expect_agreement(a, b);
  }
}

class OnRealSurface : public ::testing::TestWithParam<const char*> {};

TEST_P(OnRealSurface, HausdorffAgreesWithCgal) {
  VMESH_NEED_SHARED_DATA(GetParam());
  const TriMesh fine = read_surface(testing::shared_data(GetParam())).mesh;
  expect_agreement(fine, decimated(fine, 0.13));
}

INSTANTIATE_TEST_SUITE_P(HausdorffAgainstCgal, OnRealSurface,
                         ::testing::Values("pairs_centerline_surface/aorta-surface.stl",
                                           "pairs_centerline_surface/aorta-surface-open-ends.stl",
                                           "surfaces_other/extract-faces_python_coronarytree.stl"),
                         [](const auto& instance) { return "Surface" + std::to_string(instance.index); });

}  // namespace
}  // namespace vmesh
