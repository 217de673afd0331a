#include "report/openings.h"

#include <algorithm>
#include <map>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::tool {
namespace {

struct Edge {
  Index from, to;
};

/// Edges with one face, as it runs along them.
std::vector<Edge> boundary_edges(const TriMesh& mesh) {
  std::vector<Edge> edges;
  for (const Triangle& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({face[i], face[(i + 1) % 3]});
  }
  const auto key = [](const Edge& edge) { return std::minmax(edge.from, edge.to); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
  std::vector<Edge> alone;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && key(edges[end]) == key(edges[i])) ++end;
    if (end == i + 1) alone.push_back(edges[i]);
    i = end;
  }
  return alone;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const TriMesh& mesh) {
  const std::vector<Edge> edges = boundary_edges(mesh);
  DisjointSets joined(mesh.vertices.size());
  for (const Edge& edge : edges) joined.join(edge.from, edge.to);
  struct Sum {
    BoundaryLoop loop;
    Vec3 origin = Vec3::Zero(), area = Vec3::Zero();
    double length = 0;
  };
  std::map<Index, Sum> sums;
  for (const auto& [from, to] : edges) {
    const Vec3 &a = mesh.vertices[from], &b = mesh.vertices[to];
    Sum& sum = sums[joined.find(from)];
    if (sum.loop.edges++ == 0) sum.origin = a;  // near, for the digits
    const double length = (b - a).norm();
    sum.length += length;
    sum.loop.center += length * (a + b) / 2;
    sum.area += 0.5 * (a - sum.origin).cross(b - sum.origin);
  }
  std::vector<BoundaryLoop> loops;
  for (auto& [first, sum] : sums) {
    if (sum.length > 0) sum.loop.center /= sum.length;
    sum.loop.area_mm2 = sum.area.norm();
    loops.push_back(sum.loop);
  }
  std::stable_sort(loops.begin(), loops.end(),
                   [](const BoundaryLoop& a, const BoundaryLoop& b) { return a.area_mm2 > b.area_mm2; });
  return loops;
}

}  // namespace vmesh::tool
