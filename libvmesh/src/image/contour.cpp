#include "vmesh/image/contour.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

constexpr float kLeastShare = 1e-3f;  // of an edge between voxels: least distance of a vertex from its ends

/// The image minus the isovalue, with a border of outside voxels.
VoxelImage padded(const VoxelImage& image, double isovalue) {
  VoxelImage result;
  for (int a = 0; a < 3; ++a) result.size[a] = image.size[a] + 2;
  result.steps = image.steps;
  result.origin = image.position(Vec3::Constant(-1));
  const float lowest = *std::min_element(image.values.begin(), image.values.end()) - static_cast<float>(isovalue);
  const float highest = *std::max_element(image.values.begin(), image.values.end()) - static_cast<float>(isovalue);
  result.values.assign(result.size[0] * result.size[1] * result.size[2],
                       lowest < 0 ? lowest : -std::max(highest, 1.0f));
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i)
        result.values[result.offset(i + 1, j + 1, k + 1)] =
            static_cast<float>(static_cast<double>(image.at(i, j, k)) - isovalue);
  return result;
}

/// The largest difference between a voxel and its neighbours.
float steepness(const VoxelImage& image, std::size_t at) {
  const std::size_t row = image.size[0], slice = image.size[0] * image.size[1];
  float most = 0;
  for (const std::size_t step : {std::size_t{1}, row, slice}) {
    if (at >= step) most = std::max(most, std::abs(image.values[at - step] - image.values[at]));
    if (at + step < image.values.size()) most = std::max(most, std::abs(image.values[at + step] - image.values[at]));
  }
  return most;
}

/// Moves values away from zero without changing their side. Values of at least 0 are inside.
void keep_off_zero(VoxelImage& image) {
  std::vector<std::pair<std::size_t, float>> moved;
  for (std::size_t n = 0; n < image.values.size(); ++n) {
    const float value = image.values[n];
    const float least = kLeastShare * steepness(image, n);
    if (std::abs(value) < least || value == 0) moved.emplace_back(n, value < 0 ? -least : std::max(least, 1e-30f));
  }
  for (const auto& [n, value] : moved) image.values[n] = value;
}

/// The contour at zero in voxel coordinates; the image's position in space is not passed to VTK.
vtkSmartPointer<vtkPolyData> flying_edges(VoxelImage& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(static_cast<int>(image.size[0]), static_cast<int>(image.size[1]),
                      static_cast<int>(image.size[2]));
  vtkNew<vtkFloatArray> values;
  values->SetArray(image.values.data(), static_cast<vtkIdType>(image.values.size()), 1);
  data->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(data);
  filter->SetNumberOfContours(1);
  filter->SetValue(0, 0.0);
  filter->ComputeNormalsOff();
  filter->ComputeScalarsOff();
  filter->Update();
  return filter->GetOutput();
}

TriMesh to_mesh(vtkPolyData& data, const VoxelImage& image) {
  TriMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (vtkIdType v = 0; v < data.GetNumberOfPoints(); ++v) {
    double p[3];
    data.GetPoint(v, p);
    mesh.vertices.push_back(image.position(Vec3(p[0], p[1], p[2])));
  }
  const bool mirrored = image.steps.determinant() < 0;
  mesh.faces.reserve(static_cast<std::size_t>(data.GetNumberOfPolys()));
  vtkCellArray& polys = *data.GetPolys();
  polys.InitTraversal();
  vtkIdType count = 0;
  const vtkIdType* corners = nullptr;
  while (polys.GetNextCell(count, corners)) {
    Triangle face = {static_cast<Index>(corners[0]), static_cast<Index>(corners[1]), static_cast<Index>(corners[2])};
    if (mirrored) std::swap(face[1], face[2]);
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace

TriMesh contour(const VoxelImage& image, double isovalue) {
  for (const std::size_t size : image.size) {
    if (size == 0) throw InvalidInput("an image without voxels has no contour");
    if (size > 0x7ffffff0) throw InvalidInput("the image has too many voxels along an axis to contour");
  }
  VoxelImage work = padded(image, isovalue);
  keep_off_zero(work);
  TriMesh mesh = to_mesh(*flying_edges(work), work);
  if (mesh.faces.empty()) throw InvalidInput("there is nothing to contour: no voxel is inside");
  return mesh;
}

}  // namespace vmesh
