#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImplicitPolyDataDistance.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include "from_vtk.h"
#include "peers.h"

namespace vmesh::bench {
namespace {

vtkNew<vtkPolyData> to_poly_data(const TriMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& v : mesh.vertices) points->InsertNextPoint(v.data());
  vtkNew<vtkCellArray> faces;
  for (const auto& [a, b, c] : mesh.faces) faces->InsertNextCell({a, b, c});
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(faces);
  return data;
}

}  // namespace

bool have_vtk() { return true; }

double vtk_vertex_distance(const TriMesh& from, const TriMesh& to) {
  const vtkNew<vtkPolyData> data = to_poly_data(to);
  vtkNew<vtkImplicitPolyDataDistance> distance;
  distance->SetInput(data);
  double largest = 0;
  for (const Vec3& v : from.vertices)
    largest = std::max(largest, std::abs(distance->EvaluateFunction(v.x(), v.y(), v.z())));
  return largest;
}

TriMesh vtk_quadric_decimated(const TriMesh& mesh, double share) {
  const vtkNew<vtkPolyData> data = to_poly_data(mesh);
  vtkNew<vtkQuadricDecimation> decimation;
  decimation->SetInputData(data);
  decimation->SetTargetReduction(1 - share);
  decimation->Update();
  return testing::from_vtk(*decimation->GetOutput());
}

TriMesh vtk_isosurface(const Vec3& low, const Vec3& high, double spacing, double (*value)(const Vec3&, const void*),
                       const void* context) {
  const Eigen::Vector3i cells = ((high - low) / spacing).array().ceil().cast<int>();
  vtkNew<vtkImageData> image;
  image->SetDimensions(cells.x() + 1, cells.y() + 1, cells.z() + 1);
  image->SetOrigin(low.data());
  image->SetSpacing(spacing, spacing, spacing);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* scalar = static_cast<float*>(image->GetScalarPointer());
  for (int k = 0; k <= cells.z(); ++k)
    for (int j = 0; j <= cells.y(); ++j)
      for (int i = 0; i <= cells.x(); ++i)
        *scalar++ = static_cast<float>(value(low + spacing * Vec3(i, j, k), context));
  vtkNew<vtkFlyingEdges3D> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 0);
  contour->ComputeNormalsOff();
  contour->ComputeGradientsOff();
  contour->ComputeScalarsOff();
  contour->Update();
  return testing::from_vtk(*contour->GetOutput());
}

}  // namespace vmesh::bench
