// Centerlines in VTK's data model, internal to the module.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

namespace vmesh::io {

/// Points with radii, and cells over them: polylines, and vertices (spheres of their own). A cell is a list of points,
/// all of which exist.
struct PolyLines {
  std::vector<CenterlineNode> points;
  std::vector<std::vector<Index>> lines, vertices;
};

/// Arrays by name: one number per element, or empty if an array has another length.
using ScalarArrays = std::map<std::string, std::vector<double>>;

/// Arrays of points, and of cells: of vertices first, then of lines, then of the rest.
struct Attributes {
  const ScalarArrays& point;
  const ScalarArrays& cell;
};

/// Names under which files have the radius.
const std::vector<std::string>& usual_radii();

/// Leaves out points without a cell and lines of fewer than two points, with a warning. Radii are those of points, or
/// else of cells, under the name in `options` or a usual one, or the only area; 0 if the options give one for all
/// instead. Throws InvalidInput if nothing remains, or if there is no radius, listing the available names.
RawCenterline to_raw_centerline(PolyLines data, const std::string& source, const Attributes& attributes,
                                const CenterlineReadOptions& options,
                                const std::vector<std::string>& usual = usual_radii());

/// The same of lines over the vertices of a surface without faces, with its attributes, unit and frame.
RawCenterline to_raw_centerline(LoadedSurface points, std::vector<std::vector<Index>> lines, const std::string& source,
                                const CenterlineReadOptions& options);

}  // namespace vmesh::io
