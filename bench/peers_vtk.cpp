#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkImplicitPolyDataDistance.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

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

TriMesh to_tri_mesh(vtkPolyData& surface) {
  TriMesh mesh;
  for (vtkIdType v = 0; v < surface.GetNumberOfPoints(); ++v) mesh.vertices.emplace_back(surface.GetPoint(v));
  vtkNew<vtkIdList> corners;
  for (vtkIdType f = 0; f < surface.GetNumberOfPolys(); ++f) {
    surface.GetPolys()->GetCellAtId(f, corners);
    mesh.faces.push_back({static_cast<Index>(corners->GetId(0)), static_cast<Index>(corners->GetId(1)),
                          static_cast<Index>(corners->GetId(2))});
  }
  return mesh;
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
  return to_tri_mesh(*decimation->GetOutput());
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
  return to_tri_mesh(*contour->GetOutput());
}

}  // namespace vmesh::bench
