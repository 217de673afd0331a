#include "verbs/moving_surface.h"

#include <algorithm>

#include "vmesh/mesh/triangle_quality.h"

#include "command_line/inputs.h"
#include "command_line/outputs.h"

namespace vmesh::tool {

void FrameWriter::begin(const BoundTree& rest) {
  rest_ = &rest.mesh;
  mesh_ = rest.mesh;
  attributes_ = rest.attributes;
  std::erase_if(attributes_.vertex, [](const MeshAttribute& a) { return a.name == "displacement"; });
  attributes_.vertex.push_back({"displacement", std::vector<double>(mesh_.vertices.size())});
}

void FrameWriter::write(const std::filesystem::path& path, const DeformedSurface& surface,
                        const std::vector<Index>& lane_of_vertex) {
  std::vector<double>& displacement = attributes_.vertex.back().values;
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    mesh_.vertices[v] = surface.position(lane_of_vertex[v]);
    displacement[v] = (mesh_.vertices[v] - rest_->vertices[v]).norm();
    largest_mm_ = std::max(largest_mm_, displacement[v]);
  }
  write_surface(path, mesh_, attributes_, metadata_, writing_);
}

void MovingSurface::cut_until(double time_s) {
  const std::size_t before = cuts_;
  for (; cuts_ < plan_.cuts().size() && plan_.cuts()[cuts_].time_s <= time_s; ++cuts_) {
    const CutPlan::Made& made = plan_.cuts()[cuts_];
    naming(made.element, [&] { stage_.cut(made.cut); });
  }
  if (cuts_ > before) begin();
}

std::vector<Vec3> MovingSurface::last_vertices() {
  if (plan_.cuts().empty()) return writer_.mesh().vertices;
  if (!last_) {
    const BoundTree &tree = plan_.stages()[cuts_], &last = plan_.stages().back();
    last_.emplace(tree.centerline, stage_.simulation().tree(), last.mesh.vertices, vertex_normals(last.mesh),
                  places_on(plan_.last_on(cuts_)));
  }
  DeformedSurface lanes = last_->make_surface();
  last_->apply(stage_.simulation().pose(), lanes);
  std::vector<Vec3> vertices;
  for (const Index lane : last_->lane_of_vertex()) vertices.push_back(lanes.position(lane));
  return vertices;
}

std::vector<Vec3> MovingSurface::last_nodes() const {
  const Centerline& now = plan_.stages()[cuts_].centerline;
  const CenterlineSimulation& simulation = stage_.simulation();
  std::vector<Vec3> positions;
  for (Index n = 0; n < plan_.stages().back().centerline.nodes().size(); ++n) {
    if (n < now.nodes().size()) {
      positions.push_back(simulation.position(n));
      continue;
    }
    const auto [segment, t] = plan_.place_of_node(n, cuts_);
    const auto& [a, b] = now.segment(segment);
    positions.push_back((1 - t) * simulation.position(a) + t * simulation.position(b));
  }
  return positions;
}

void MovingSurface::begin() {
  const BoundTree& tree = plan_.stages()[cuts_];
  binding_.emplace(tree.centerline, stage_.simulation().tree(), tree.mesh.vertices, vertex_normals(tree.mesh),
                   places_on(tree.binding));
  lanes_ = binding_->make_surface();
  if (cuts_ > 0) binding_->apply(stage_.simulation().pose(), lanes_);
  writer_.begin(tree);
  last_.reset();
}

}  // namespace vmesh::tool
