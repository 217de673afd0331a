// contour() beside VTK's flying edges.
#include <cmath>

#include <gtest/gtest.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include "vmesh/image/contour.h"
#include "vmesh/image/image_filters.h"
#include "vmesh/image/image_io.h"
#include "vmesh/mesh/topology.h"

#include "from_vtk.h"
#include "shared_data.h"

namespace vmesh::testing {
namespace {

/// The contour at zero by VTK, of an image whose border is outside, in single precision.
TriMesh contour_by_vtk(VoxelImage image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(static_cast<int>(image.size[0]), static_cast<int>(image.size[1]),
                      static_cast<int>(image.size[2]));
  vtkNew<vtkFloatArray> values;
  values->SetArray(image.values.data(), static_cast<vtkIdType>(image.values.size()), 1);
  data->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(data);
  filter->SetValue(0, 0.0);
  filter->ComputeNormalsOff();
  filter->Update();
  TriMesh mesh = from_vtk(*filter->GetOutput());
  for (Vec3& v : mesh.vertices) v = image.position(v);
  return mesh;
}

/// The same vertices, within what single precision leaves and but for few at values that are moved off the level, and
/// as many faces around the same volume, apart from which diagonals divide polygons.
void expect_like_vtk(const VoxelImage& image) {
  const TriMesh ours = contour(image, 0), theirs = contour_by_vtk(image);
  ASSERT_EQ(ours.vertices.size(), theirs.vertices.size());
  EXPECT_EQ(ours.faces.size(), theirs.faces.size());
  std::size_t moved = 0;
  for (std::size_t v = 0; v < ours.vertices.size(); ++v) {
    const double distance = (ours.vertices[v] - theirs.vertices[v]).norm() / image.spacing().maxCoeff();
    EXPECT_LT(distance, 0.2);
    if (distance > 1e-4) ++moved;
  }
  EXPECT_LT(static_cast<double>(moved), 0.01 * static_cast<double>(ours.vertices.size()));
  const Topology topology = measure_topology(ours), expected = measure_topology(theirs);
  EXPECT_EQ(topology.components, expected.components);
  EXPECT_EQ(topology.genus, expected.genus);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_NEAR(enclosed_volume(ours) / enclosed_volume(theirs), 1, 0.02);
}

template <class Function>
VoxelImage sampled(Function values) {
  VoxelImage image;
  image.size = {50, 70, 60};
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        image.values.push_back(static_cast<float>(
            values(Vec3(static_cast<double>(i) - 25.2, static_cast<double>(j) - 35.3, static_cast<double>(k) - 30.4))));
  return image;
}

TEST(ContourByVtk, OfFieldsWithoutAmbiguousCellsIsTheSame) {
  expect_like_vtk(sampled([](const Vec3& p) { return 20.1 - p.norm(); }));
  expect_like_vtk(sampled([](const Vec3& p) { return 6.3 - Vec3(p.head<2>().norm() - 15, p.z(), 0).norm(); }));
  expect_like_vtk(sampled([](const Vec3& p) { return 22.7 - p.cwiseProduct(Vec3(1, 0.7, 0.9)).lpNorm<1>(); }));
}

/// The image as a mask of -1/2 and 1/2 with a border outside.
VoxelImage signed_mask(const VoxelImage& image) {
  VoxelImage mask = image;
  for (int a = 0; a < 3; ++a) mask.size[a] += 2;
  mask.values.assign(mask.size[0] * mask.size[1] * mask.size[2], -0.5f);
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        if (image.at(i, j, k) != 0) mask.values[mask.offset(i + 1, j + 1, k + 1)] = 0.5f;
  return mask;
}

TEST(ContourByVtk, OfMasksIsTheSame) {
  for (const char* name : {"liver_segmentations/hepaticvessel_008_vsnet.nii.gz", "brain_mra/labels-002.nii.gz"}) {
    VMESH_NEED_SHARED_DATA(name);
    VoxelImage image = read_image(shared_data(name)).image;
    if (image.steps.determinant() < 0) image.steps.col(0) *= -1;  // VTK knows no mirrored images
    expect_like_vtk(signed_mask(image));
  }
}

}  // namespace
}  // namespace vmesh::testing
