#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"

#include "console.h"

namespace vmesh::tool {

/// What can be told of a surface alone.
struct SurfaceMeasurement {
  Topology topology;
  SkewnessSummary skewness;
  std::size_t self_intersections = 0;
};

SurfaceMeasurement measure_surface(const TriMesh& mesh);

/// What a surface should be, given its centerline.
struct SurfaceExpectation {
  std::size_t components = 0;
  std::size_t genus = 0;
};

SurfaceExpectation expected_surface(const Centerline& centerline);

/// Number of nodes inside the mesh; nothing when the mesh is not closed.
std::optional<std::size_t> count_nodes_inside(const Centerline& centerline, const TriMesh& mesh);

/// What keeps a surface from being flawless, one line each.
std::vector<std::string> problems_of(const SurfaceMeasurement& measurement);

/// The same for a surface of which more is expected.
std::vector<std::string> problems_of(const SurfaceMeasurement& measurement, const SurfaceExpectation& expected,
                                     std::optional<std::size_t> nodes_inside, std::size_t nodes);

}  // namespace vmesh::tool
