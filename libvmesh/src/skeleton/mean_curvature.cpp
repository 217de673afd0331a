#include "mean_curvature.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ordered_memory.h"
// The allocator of the flow's own mesh.
#define CGAL_ALLOCATOR(T) vmesh::skeleton::OrderedAllocator<T>

#include <CGAL/Mean_curvature_flow_skeletonization.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

namespace vmesh::skeleton {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Flow = CGAL::Mean_curvature_flow_skeletonization<Surface>;

// Coarse meshes are subdivided until edges are shorter than this times the mean radius, unless they become too large.
constexpr double kFine = 0.5;
constexpr std::size_t kEnoughVertices = 20'000;
constexpr int kMostDivisions = 2;
// Twice what the whole process was measured to need per vertex of contours and of grown surfaces.
constexpr std::size_t kBytesPerVertex = 8'192;

TriMesh divided(const TriMesh& mesh) {
  TriMesh fine{mesh.vertices, {}};
  fine.faces.reserve(4 * mesh.faces.size());
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.vertices.size()));
    if (fresh) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.faces) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

Surface to_surface(const TriMesh& mesh) {
  Surface surface;
  for (const Vec3& v : mesh.vertices) surface.add_vertex({v.x(), v.y(), v.z()});
  using Vertex = Surface::Vertex_index;
  for (const auto& [a, b, c] : mesh.faces)
    if (surface.add_face(Vertex(a), Vertex(b), Vertex(c)) == Surface::null_face())
      throw InvalidInput("a surface that is not manifold has no skeleton");
  return surface;
}

double mean_edge_length(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces)
    sum += (mesh.vertices[a] - mesh.vertices[b]).norm() + (mesh.vertices[b] - mesh.vertices[c]).norm() +
           (mesh.vertices[c] - mesh.vertices[a]).norm();
  return sum / static_cast<double>(3 * mesh.faces.size());
}

/// The radius of a long cylinder of the same volume and area.
double mean_radius(const TriMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) area += 0.5 * area_normal(mesh, f).norm();
  return 2 * enclosed_volume(mesh) / area;
}

TriMesh fine_enough(TriMesh mesh) {
  const double wanted = kFine * mean_radius(mesh);
  for (int i = 0; i < kMostDivisions && mesh.vertices.size() < kEnoughVertices && mean_edge_length(mesh) > wanted; ++i)
    mesh = divided(mesh);
  return mesh;
}

/// Gives radii to nodes at which no vertex ended up, outwards from those with some.
void fill_radii(Graph& graph) {
  const auto edges_at = incidence(graph);
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<Node> filled = graph.nodes;
    for (Index n = 0; n < graph.nodes.size(); ++n) {
      if (graph.nodes[n].radius > 0) continue;
      double sum = 0;
      int count = 0;
      for (const Index e : edges_at[n]) {
        const double radius = graph.nodes[other_end(graph, e, n)].radius;
        if (radius > 0) sum += radius, ++count;
      }
      if (count == 0) continue;
      filled[n].radius = sum / count;
      changed = true;
    }
    graph.nodes = std::move(filled);
  }
}

double area_of(const Flow& flow) {
  const auto& mesh = flow.meso_skeleton();
  return CGAL::Polygon_mesh_processing::area(
      mesh, CGAL::parameters::vertex_point_map(get(CGAL::vertex_point, mesh)).geom_traits(Kernel()));
}

/// Flow::contract_until_convergence() step by step, for progress.
void contract(Flow& flow, const Progress& progress) {
  const double original = area_of(flow);
  double last = 0;
  for (std::size_t i = 0; i < flow.max_iterations(); ++i) {
    report_progress(progress, "skeleton", 0);  // the number of steps is unknown
    flow.contract();
    const double area = area_of(flow);
    if (std::abs(last - area) / original < flow.area_variation_factor()) break;
    last = area;
  }
}

}  // namespace

Graph mean_curvature_skeleton(const TriMesh& coarse, const Progress& progress) {
  const TriMesh mesh = fine_enough(coarse);
  Surface surface = to_surface(mesh);
  const OrderedMemory memory(kBytesPerVertex * (mesh.vertices.size() + 1000));
  Flow flow(surface);
  // CGAL's default depends on the overall extent, which is unrelated to the thinnest vessels.
  flow.set_min_edge_length(std::min(flow.min_edge_length(), 0.5 * mean_edge_length(mesh)));
  contract(flow, progress);
  Flow::Skeleton skeleton;
  flow.convert_to_skeleton(skeleton);

  Graph graph;
  for (const auto v : CGAL::make_range(boost::vertices(skeleton))) {
    const auto& p = skeleton[v].point;
    Node node{{p.x(), p.y(), p.z()}, 0};
    for (const auto s : skeleton[v].vertices) node.radius += (mesh.vertices[s] - node.position).norm();
    if (!skeleton[v].vertices.empty()) node.radius /= static_cast<double>(skeleton[v].vertices.size());
    graph.nodes.push_back(node);
  }
  for (const auto e : CGAL::make_range(boost::edges(skeleton)))
    graph.edges.push_back({static_cast<Index>(source(e, skeleton)), static_cast<Index>(target(e, skeleton))});
  if (graph.nodes.empty()) throw InvalidInput("the flow left no skeleton; the surface is too small or too coarse");
  fill_radii(graph);
  for (Node& node : graph.nodes)
    if (!(node.radius > 0)) node.radius = mean_radius(mesh);  // all its vertices had been there from the start
  return graph;
}

}  // namespace vmesh::skeleton
