// Centerlines in VTK's data model, internal to the module.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vmesh/io/centerline_io.h"

namespace vmesh::io {

/// Points with radii, and cells over them: polylines, and vertices (spheres of their own). A cell is a list of points,
/// all of which exist.
struct PolyLines {
  std::vector<CenterlineNode> points;
  std::vector<std::vector<Index>> lines, vertices;
};

/// Arrays by name: one number per element, or empty where an array has another number of them.
using ScalarArrays = std::map<std::string, std::vector<double>>;

/// Those of points, and those of cells: of vertices first, then of lines, then of what else there is.
struct Attributes {
  const ScalarArrays& point;
  const ScalarArrays& cell;
};

/// Leaves out points without a cell and lines of fewer than two points, and says so. Radii are those of points, or else
/// those of cells, under the name in `options` or a usual one; 0 where the options give one for all instead.
/// Throws InvalidInput when nothing remains, and when there is no radius: with the names that are there.
RawCenterline to_raw_centerline(PolyLines data, const std::string& source, const Attributes& attributes,
                                const CenterlineReadOptions& options);

}  // namespace vmesh::io
