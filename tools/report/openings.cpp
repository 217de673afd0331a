#include "report/openings.h"

#include <algorithm>
#include <map>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/topology.h"

namespace vmesh::tool {
std::vector<BoundaryLoop> boundary_loops(const TriMesh& mesh) {
  const auto edges = boundary_edges(mesh);
  DisjointSets joined(mesh.vertices.size());
  for (const auto& [from, to] : edges) joined.join(from, to);
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
