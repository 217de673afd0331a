#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/generate.h"

#include "command_line/console.h"

namespace vmesh::tool {

/// Measurements of a surface alone.
struct SurfaceMeasurement {
  Topology topology;
  SkewnessSummary skewness;
  SkewnessSummary metric_skewness;  ///< that of triangles that may be longer than wide, see metric_skewness()
  std::size_t self_intersections = 0;
  std::size_t openings = 0;        ///< boundary_loops(); of a generated surface the intended ones
  std::size_t open_elsewhere = 0;  ///< boundary edges besides those of openings
};

/// `elongation`: of the vertices, see metric_skewness(); empty: none.
SurfaceMeasurement measure_surface(const TriMesh& mesh, const std::vector<Vec3>& elongation = {});

/// The same for a generated surface, from its checks. It may be open at ends of vessels: topology
/// is with these closed, `open_elsewhere` are the boundary edges that do not belong to an opening.
SurfaceMeasurement measurement_of(const GenerateResult& result);

/// What a surface should be, given its centerline and, if that steered growth, the skeleton: loops too short to have a
/// hole are left out there, with a note.
struct SurfaceExpectation {
  std::size_t components = 0;
  std::size_t genus = 0;
};

SurfaceExpectation expected_surface(const Centerline& centerline, const GenerateResult& result);

/// The problems of a surface, one line each.
std::vector<std::string> problems_of(const SurfaceMeasurement& measurement);

/// The same for a surface with further expectations.
std::vector<std::string> problems_of(const SurfaceMeasurement& measurement, const SurfaceExpectation& expected,
                                     std::optional<std::size_t> nodes_inside, std::size_t nodes);

}  // namespace vmesh::tool
