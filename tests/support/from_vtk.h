// VTK's surfaces as ours, for tests and benchmarks that compare.
#pragma once

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::testing {

inline TriMesh from_vtk(vtkPolyData& surface) {
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

}  // namespace vmesh::testing
