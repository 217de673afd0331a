#include "vmesh/fit/fit_surface.h"

#include <cmath>
#include <utility>

#include <tbb/task_arena.h>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/defects.h"

#include "fit/fit_rounds.h"
#include "fit/unmatched.h"

namespace vmesh {
namespace {

using namespace fitting;

constexpr std::size_t kFewerBefore = 4;  // one in this number of samples of the report before the fit

void check(const FitOptions& options) {
  if (options.rounds < 1 || options.rounds > 100) throw InvalidInput("rounds of a fit are 1 to 100");
  if (!(options.max_skewness >= 0.1 && options.max_skewness <= 0.9))
    throw InvalidInput("the largest skewness of a fit is 0.1 to 0.9");
  if (!(options.error >= 0 && std::isfinite(options.error)))
    throw InvalidInput("the error of a fit is 0 or more, and finite");
  if (!(options.max_error >= 0 && std::isfinite(options.max_error)))
    throw InvalidInput("the largest error of a fit is 0 or more, and finite");
  if (options.max_error > 0 && !options.resize)
    throw InvalidInput("a fit that keeps the triangles cannot keep a largest error: leave out one of the two options");
  if (!(options.elongation >= 1 && options.elongation <= kMostElongation))
    throw InvalidInput("the elongation of a fit is 1 to " + std::to_string(kMostElongation));
  if (options.elongation > 1 && !options.resize)
    throw InvalidInput("a fit that keeps the triangles cannot have an elongation: leave out one of the two options");
}

void check(const VesselSurface& surface, const VesselField& field) {
  if (surface.mesh.faces.empty()) throw InvalidInput("the surface to fit has no faces");
  if (surface.binding.size() != surface.mesh.vertices.size())
    throw InvalidInput("the surface has " + std::to_string(surface.mesh.vertices.size()) + " vertices, but " +
                       std::to_string(surface.binding.size()) + " of them are bound to the centerline");
  for (std::size_t v = 0; v < surface.binding.size(); ++v) {
    if (surface.binding[v].segment >= field.relations().cone_count())
      throw InvalidInput("vertex " + std::to_string(v) + " is bound to segment " +
                         std::to_string(surface.binding[v].segment) + ", which the centerline does not have");
  }
  const Topology topology = measure_topology(surface.mesh);
  if (!topology.manifold || !topology.oriented)
    throw InvalidInput("the surface to fit is not manifold and oriented; vmesh evaluate tells where");
  const auto crossing = self_intersections(surface.mesh);
  if (!crossing.empty()) {
    const Index v = surface.mesh.faces[crossing.front().first][0];
    throw InvalidInput("the surface to fit has " + std::to_string(crossing.size()) +
                       " pairs of faces that cross, the first at " + point_text(surface.mesh.vertices[v]) +
                       "; make one without (--overlap separate)");
  }
}

FitDistance distance_between(const TriMesh& surface, const TriMesh& reference, const FitOptions& options,
                             std::size_t samples) {
  HausdorffOptions hausdorff_options;
  hausdorff_options.tolerance = options.tolerance;
  return {hausdorff(surface, reference, hausdorff_options),
          sample_distance(surface, ClosestPointIndex(reference), samples),
          sample_distance(reference, ClosestPointIndex(surface), samples)};
}

}  // namespace

std::vector<Opening> find_openings(const TriMesh& mesh) {
  std::vector<Index> next(mesh.vertices.size(), kNone);  // along the border, in the direction of a lid's faces
  for (const auto& [from, to] : boundary_edges(mesh)) next[to] = from;
  std::vector<Opening> openings;
  for (Index first = 0; first < next.size(); ++first) {
    if (next[first] == kNone) continue;
    Opening opening;
    for (Index v = first; next[v] != kNone;) {
      opening.ring.push_back(v);
      v = std::exchange(next[v], kNone);
    }
    for (const Index v : opening.ring) opening.center += mesh.vertices[v] / static_cast<double>(opening.ring.size());
    opening.normal = normal_of(opening, mesh);
    openings.push_back(std::move(opening));
  }
  return openings;
}

FitResult fit_surface(const VesselSurface& surface, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options, const Progress& progress) {
  check(options);
  const VesselField field(centerline);
  check(surface, field);
  const std::size_t aimed_at = options.error > 0 || options.max_error > 0
                                   ? 0
                                   : options.max_vertices;  // with an error, max_vertices is only a limit
  check_memory(std::max(surface.mesh.vertices.size(), aimed_at), reference);
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  return arena.execute([&] {
    Fit fit(surface, field, reference, options);
    fit.run(progress);
    FitResult result = fit.result();
    FitReport& report = result.report;
    report.vertices_before = surface.mesh.vertices.size();
    report.turned = fit.reference().turned();
    report.rounds = fit.rounds();
    const TriMesh compared = fit.reference_without_apart(report);
    report.before = distance_between(surface.mesh, compared, options, options.samples / kFewerBefore + 1);
    report.after = distance_between(result.surface.mesh, compared, options, options.samples);
    find_far(report, fit.surface(), fit.reference(), field, options.max_error);
    return result;
  });
}

void find_far_parts(FitReport& report, const VesselSurface& surface, const Centerline& centerline,
                    const TriMesh& reference, double max_error) {
  const VesselField field(centerline);
  check(surface, field);
  find_far(report, FitMesh(surface.mesh.faces, vertices_of(surface)), FitReference(reference, field), field, max_error);
}

FitReport fit_surface(GenerateResult& result, const Centerline& centerline, const TriMesh& reference,
                      const FitOptions& options, const Progress& progress) {
  FitResult fitted = fit_surface(VesselSurface{result.mesh, result.binding, result.openings}, centerline, reference,
                                 options, progress);
  result.mesh = std::move(fitted.surface.mesh);
  result.binding = std::move(fitted.surface.binding);
  result.openings = std::move(fitted.surface.openings);
  result.radius = std::move(fitted.radius);
  result.elongation = std::move(fitted.elongation);
  result.defects.clear();
  find_defects(centerline, self_intersections(result.mesh), result);
  std::erase_if(result.defects, [&](const Defect& defect) {
    if (defect.kind != DefectKind::node_outside) return false;
    fitted.report.nodes_outside.push_back(defect);
    return true;
  });
  return std::move(fitted.report);
}

}  // namespace vmesh
