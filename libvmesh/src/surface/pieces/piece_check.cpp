#include "surface/pieces/piece_check.h"

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/soundness.h"

#include "surface/remesh/untangle.h"

namespace vmesh {
namespace {

// Depth below another vessel's wall, in radii, from which on no surface can be sound. Less may come from the rounding
// of a third vessel, which guarded steps avoid: at 0.2, noisy tree 315 with a blend of 2 is refused; at 0.4 it is
// sound.
constexpr double kCovered = 0.4;  // idle 0.28 to 0.56

Vec3 center_of(const TriMesh& mesh, Index f) {
  const auto& [a, b, c] = mesh.faces[f];
  return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

void find_crossings(const BoundSurface& surface, const TriMesh& mesh, std::vector<PieceFault>& faults) {
  for (const auto& [f, g] : self_intersections(mesh)) {
    bool overlap = false;
    double radius = std::numeric_limits<double>::infinity();
    for (const Index face : {f, g}) {
      for (const Index v : mesh.faces[face]) {
        overlap = overlap || is_covered(surface.field, mesh.vertices[v], surface[Vertex(v)].cone);
        radius = std::min(radius, surface.radius(Vertex(v)));
      }
    }
    for (const Index face : {f, g})
      faults.push_back({DefectKind::crossing_faces, center_of(mesh, face), radius, overlap});
  }
}

void find_bad_faces(const SweepState& state, PieceFindings& findings) {
  for (const Face f : state.mesh.faces()) {
    if (state.surface.is_lid(f)) continue;
    const auto [a, b, c] = state.corners(f);
    const double skewness = state.surface.metric(a, b, c).skewness(state.point(a), state.point(b), state.point(c));
    findings.worst_skewness = std::max(findings.worst_skewness, skewness);
    if (skewness <= kWorstSkewness) continue;
    const double radius = std::min({state.surface.radius(a), state.surface.radius(b), state.surface.radius(c)});
    findings.faults.push_back(
        {DefectKind::bad_triangle, (state.point(a) + state.point(b) + state.point(c)) / 3, radius});
  }
}

void find_nodes_outside(const BoundSurface& surface, const TriMesh& mesh, const std::vector<Index>& nodes,
                        std::vector<PieceFault>& faults) {
  std::vector<Vec3> positions;
  for (const Index n : nodes) positions.push_back(surface.field.relations().centerline().node(n).position);
  if (positions.empty()) return;
  const std::vector<bool> inside = points_inside(mesh, positions);
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (inside[i]) continue;
    const auto segments = surface.field.relations().centerline().incident_segments(nodes[i]);
    const bool overlap = !segments.empty() && is_covered(surface.field, positions[i], segments.front());
    const double radius = surface.field.relations().centerline().node(nodes[i]).radius;
    faults.push_back({DefectKind::node_outside, positions[i], radius, overlap});
  }
}

}  // namespace

bool is_covered(const VesselField& field, const Vec3& p, Index cone) {
  return field.distance_to_others(p, cone, 0) < -kCovered * field.relations().radius_at(cone, 0.5);
}

PieceFindings check_piece(BoundSurface& surface, const std::vector<Index>& nodes, const GenerateOptions& options,
                          bool may_cross) {
  PieceFindings findings;
  const SweepState state(surface);
  if (may_cross) find_crossings(surface, indexed_mesh(state, false), findings.faults);
  if (options.sweeps > 0) find_bad_faces(state, findings);
  find_nodes_outside(surface, indexed_mesh(state, true), nodes, findings.faults);
  return findings;
}

}  // namespace vmesh
