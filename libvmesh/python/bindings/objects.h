#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/fit/fit_surface.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/generate.h"
#include "vmesh/tuning/budget.h"

namespace vmesh::python {

/// vmesh.Centerline.
struct CenterlineObject {
  Centerline centerline;
  std::vector<std::string> cleaning;       ///< what cleaning did to make it valid
  std::vector<std::string> warnings;       ///< of the reader
  std::vector<std::string> place_of_node;  ///< in the file, for every node; empty: not from a file
  std::vector<EndSection> end_sections = {};
};
using CenterlinePtr = std::shared_ptr<CenterlineObject>;

/// vmesh.Surface. Immutable, as arrays are views of it.
struct SurfaceObject {
  GenerateResult result;      ///< for a surface that was not grown: the mesh and whatever else is known
  CenterlinePtr centerline;   ///< to which result.binding refers; null: not bound
  MeshAttributes attributes;  ///< of the file it was read from
  std::vector<std::string> warnings;
  FlatEnds ends;
  std::vector<OperatingPoint> tried;  ///< to keep within a budget
  std::optional<FitReport> fit;

  const TriMesh& mesh() const { return result.mesh; }
};
using SurfacePtr = std::shared_ptr<SurfaceObject>;

}  // namespace vmesh::python
