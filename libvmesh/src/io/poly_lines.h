// Centerlines in VTK's data model, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::io {

/// Points with radii, and cells over them: polylines, and vertices (spheres of their own). A cell is a list of points,
/// all of which exist.
struct PolyLines {
  std::vector<CenterlineNode> points;
  std::vector<std::vector<Index>> lines, vertices;
};

/// Leaves out points without a cell and lines of fewer than two points, and says so. Throws InvalidInput when nothing
/// remains.
RawCenterline to_raw_centerline(const PolyLines& data, const std::string& source);

/// Names under which the radius may be found, best first: `wanted` alone unless it is empty.
std::vector<std::string> radius_names(const std::string& wanted);

/// Throws InvalidInput that tells the names searched for and those present.
[[noreturn]] void fail_without_radius(const std::string& source, const std::string& wanted,
                                      const std::vector<std::string>& present);

}  // namespace vmesh::io
