#include "vmesh/mesh/topology.h"

#include <algorithm>
#include <numeric>

#include "vmesh/core/ascending.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/check_indices.h"

#include "mesh/blocks.h"
#include "mesh/vertex_corners.h"

namespace vmesh {
namespace {

// Calls visit(begin, end) for the runs of sides that lead to the same vertex.
template <class Visit>
void for_edges(const std::vector<SideAt>& sides, Visit&& visit) {
  for (std::size_t i = 0, next; i < sides.size(); i = next) {
    for (next = i + 1; next < sides.size() && sides[next].other == sides[i].other; ++next) {
    }
    visit(std::span(sides).subspan(i, next - i));
  }
}

using Ways = std::vector<std::array<Index, 2>>;

// What the edges around some vertices are like. Every edge is counted at its lower vertex.
struct EdgeCounts {
  std::int64_t edges = 0, vertices = 0;
  std::size_t crowded = 0;
  bool manifold = true, oriented = true;
  bool one_fan_each = true;  // decisive only where edges are manifold
  Ways boundary;             // edges with one face, in its direction

  void add(EdgeCounts&& other) {
    edges += other.edges;
    vertices += other.vertices;
    crowded += other.crowded;
    manifold = manifold && other.manifold;
    oriented = oriented && other.oriented;
    one_fan_each = one_fan_each && other.one_fan_each;
    boundary.insert(boundary.end(), other.boundary.begin(), other.boundary.end());
  }
};

// Counts what there is around vertices, one after the other.
class EdgeCounter {
 public:
  EdgeCounter(const TriMesh& mesh, const VertexCorners& corners) : mesh_(mesh), corners_(corners) {}

  void visit(Index v) {
    list_sides(mesh_, corners_, v, sides_);
    if (sides_.empty()) return;
    ++counts.vertices;
    fans_.resize(corners_.at(v).size());
    std::iota(fans_.begin(), fans_.end(), Index{0});
    std::size_t fans = fans_.size();
    for_edges(sides_, [&](std::span<const SideAt> edge) {
      for (std::size_t i = 1; i < edge.size(); ++i) fans -= join(edge[i - 1].corner, edge[i].corner);
      if (v <= edge.front().other) add_edge(v, edge);
    });
    if (fans > 1) counts.one_fan_each = false;
  }

  EdgeCounts counts;

 private:
  void add_edge(Index v, std::span<const SideAt> edge) {
    const Index other = edge.front().other;
    ++counts.edges;
    if (edge.size() > 2) ++counts.crowded;
    if (edge.size() > 2 || other == v) counts.manifold = false;
    if (edge.size() == 2 && edge[0].outwards == edge[1].outwards) counts.oriented = false;
    if (edge.size() == 1) counts.boundary.push_back({edge[0].outwards ? v : other, edge[0].outwards ? other : v});
  }

  // Joins the fans of two corners; returns whether they were different.
  bool join(Index i, Index j) {
    while (fans_[i] != i) i = fans_[i];
    while (fans_[j] != j) j = fans_[j];
    fans_[std::max(i, j)] = std::min(i, j);
    return i != j;
  }

  const TriMesh& mesh_;
  const VertexCorners& corners_;
  std::vector<SideAt> sides_;
  std::vector<Index> fans_;  // of the corners at a vertex: another one of its fan
};

EdgeCounts count_edges(const TriMesh& mesh) {
  const VertexCorners corners(mesh);
  EdgeCounts all;
  for (EdgeCounts& some : of_blocks<EdgeCounts>(mesh.vertices.size(), [&](std::size_t begin, std::size_t end) {
         EdgeCounter counter(mesh, corners);
         for (std::size_t v = begin; v < end; ++v) counter.visit(static_cast<Index>(v));
         return std::move(counter.counts);
       }))
    all.add(std::move(some));
  return all;
}

// Number of components of a graph, not counting isolated vertices.
std::size_t count_pieces(const std::vector<std::array<Index, 2>>& edges, std::size_t vertices) {
  DisjointSets sets(edges.empty() ? 0 : vertices);
  for (const auto& [from, to] : edges) sets.join(from, to);
  std::vector<Index> roots;
  for (const auto& [from, to] : edges) roots.push_back(sets.find(from));
  sort_unique(roots);
  return roots.size();
}

// The lowest vertices of the components, ascending.
std::vector<Index> components_of(const TriMesh& mesh, DisjointSets& sets) {
  std::vector<Index> lowest;
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) {
      if (sets.find(v) == v) lowest.push_back(v);
    }
  }
  sort_unique(lowest);
  return lowest;
}

// Six times the volume of every component.
std::vector<double> volumes_of(const TriMesh& mesh, DisjointSets& sets, const std::vector<Index>& components) {
  std::vector<double> volumes(components.size(), 0);
  for (const auto& [a, b, c] : mesh.faces) {
    // Relative to a vertex of the component, so that a far origin costs no precision.
    const Index lowest = sets.find(a);
    const Vec3& origin = mesh.vertices[lowest];
    volumes[place_in(components, lowest)] +=
        (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return volumes;
}

}  // namespace

Topology measure_topology(const TriMesh& mesh) {
  check_indices(mesh);
  Topology topology;
  const EdgeCounts counts = count_edges(mesh);
  topology.crowded_edges = counts.crowded;
  topology.oriented = counts.oriented && counts.manifold;
  topology.manifold = counts.manifold && counts.one_fan_each;
  topology.boundary_edges = counts.boundary.size();
  topology.boundary_loops = count_pieces(counts.boundary, mesh.vertices.size());
  topology.closed = !mesh.faces.empty() && topology.boundary_edges == 0;

  DisjointSets sets(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.faces) {
    sets.join(a, b);
    sets.join(a, c);
  }
  const std::vector<Index> components = components_of(mesh, sets);
  topology.components = components.size();
  topology.euler_characteristic = counts.vertices - counts.edges + static_cast<std::int64_t>(mesh.faces.size());
  if (topology.closed && topology.oriented) {
    if (topology.manifold) {
      topology.genus = static_cast<std::int64_t>(topology.components) - topology.euler_characteristic / 2;
    }
    const std::vector<double> volumes = volumes_of(mesh, sets, components);
    topology.outward = std::all_of(volumes.begin(), volumes.end(), [](double volume) { return volume > 0; });
  }
  return topology;
}

std::vector<std::array<Index, 2>> boundary_edges(const TriMesh& mesh) {
  check_indices(mesh);
  return count_edges(mesh).boundary;
}

std::vector<Index> valences(const TriMesh& mesh) {
  check_indices(mesh);
  const VertexCorners corners(mesh);
  std::vector<Index> valence(mesh.vertices.size(), 0);
  for_blocks(valence.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<SideAt> sides;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      list_sides(mesh, corners, v, sides);
      for_edges(sides, [&](std::span<const SideAt> edge) { valence[v] += edge.front().other != v; });
    }
  });
  return valence;
}

double enclosed_volume(const TriMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3& origin = mesh.vertices.front();
  double sum = 0;
  for (const auto& [a, b, c] : mesh.faces) {
    sum += (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return sum / 6;
}

}  // namespace vmesh
