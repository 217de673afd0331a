#include "report/measure.h"

#include <algorithm>

#include "vmesh/core/text.h"
#include "vmesh/surface/metric_skewness.h"

#include "command_line/interrupt.h"
#include "report/openings.h"

namespace vmesh::tool {
namespace {

bool has_genus(const Topology& topology) { return topology.closed && topology.manifold && topology.oriented; }

// `plain`: without elongation.
SkewnessSummary metric_summary(const TriMesh& mesh, const std::vector<Vec3>& elongation, const SkewnessSummary& plain) {
  return elongation.empty() ? plain : summarize_skewness(metric_skewness(mesh, elongation));
}

}  // namespace

SurfaceMeasurement measure_surface(const TriMesh& mesh, const std::vector<Vec3>& elongation) {
  SurfaceMeasurement measurement;
  measurement.topology = measure_topology(mesh);
  measurement.openings = boundary_loops(mesh).size();
  measurement.skewness = summarize_skewness(mesh);
  measurement.metric_skewness = metric_summary(mesh, elongation, measurement.skewness);
  stop_if_interrupted();
  measurement.self_intersections = self_intersections(mesh).size();
  return measurement;
}

SurfaceMeasurement measurement_of(const GenerateResult& result) {
  SurfaceMeasurement measurement;
  measurement.topology = result.check.topology;
  measurement.skewness = summarize_skewness(result.mesh);
  measurement.metric_skewness = metric_summary(result.mesh, result.elongation, measurement.skewness);
  measurement.self_intersections = result.check.crossing_pairs;
  measurement.openings = result.openings.size();
  if (measurement.openings > 0) measurement.open_elsewhere = result.check.topology.boundary_edges;
  return measurement;
}

SurfaceExpectation expected_surface(const Centerline& centerline, const GenerateResult& result) {
  if (result.growth.components > 0) return {result.growth.components, result.growth.cycle_rank};
  return {centerline.component_count(), centerline.cycle_rank()};
}

std::vector<std::string> problems_of(const SurfaceMeasurement& measurement) {
  const Topology& topology = measurement.topology;
  std::vector<std::string> problems;
  if (!topology.closed)
    problems.push_back("not closed: " + counted(topology.boundary_edges, "boundary edge", "boundary edges"));
  if (!topology.manifold) problems.push_back("not a manifold: an edge has three faces or a vertex two fans");
  if (!topology.oriented) problems.push_back("not oriented: neighbouring faces disagree about the outside");
  if (topology.closed && topology.oriented && !topology.outward) problems.push_back("faces point inwards");
  if (measurement.open_elsewhere > 0)
    problems.push_back(counted(measurement.open_elsewhere, "boundary edge", "boundary edges") +
                       " besides the openings");
  if (measurement.self_intersections > 0)
    problems.push_back(counted(measurement.self_intersections, "pair of faces intersects", "pairs of faces intersect"));
  return problems;
}

std::vector<std::string> problems_of(const SurfaceMeasurement& measurement, const SurfaceExpectation& expected,
                                     std::optional<std::size_t> nodes_inside, std::size_t nodes) {
  const Topology& topology = measurement.topology;
  std::vector<std::string> problems = problems_of(measurement);
  if (topology.components != expected.components)
    problems.push_back(counted(topology.components, "component", "components") + " where the centerline has " +
                       std::to_string(expected.components));
  if (has_genus(topology) && topology.genus != static_cast<std::int64_t>(expected.genus))
    problems.push_back("genus " + std::to_string(topology.genus) + " where the centerline has " +
                       counted(expected.genus, "independent loop", "independent loops"));
  if (!nodes_inside)
    problems.push_back("whether the centerline's nodes are inside cannot be told of an open surface");
  else if (*nodes_inside != nodes)
    problems.push_back(counted(nodes - *nodes_inside, "centerline node is", "centerline nodes are") + " not inside");
  return problems;
}

}  // namespace vmesh::tool
