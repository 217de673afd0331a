#include "vmesh/mesh/topology.h"

#include <algorithm>
#include <tuple>

#include "vmesh/core/ascending.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/check_indices.h"
#include "vmesh/mesh/sorted_by_vertex.h"

namespace vmesh {
namespace {

// One side of a face, keyed by its edge.
struct Side {
  Index low, high;  // the edge's vertices
  Index face;
  bool forward;  // the face runs from low to high

  auto key() const { return std::pair(low, high); }
};

// All sides, those of an edge adjacent.
std::vector<Side> sorted_sides(const TriMesh& mesh) {
  const auto visit_sides = [&](auto&& visit) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (int i = 0; i < 3; ++i) {
        const Index a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
        visit(std::min(a, b), Side{std::min(a, b), std::max(a, b), f, a < b});
      }
    }
  };
  return sorted_by_vertex<Side>(mesh.vertices.size(), visit_sides, [](const Side& x, const Side& y) {
    return std::tie(x.high, x.face) < std::tie(y.high, y.face);
  });
}

// A vertex is manifold when its faces, joined across edges at it, form one fan: count fans as classes of face corners.
bool one_fan_each(const TriMesh& mesh, const std::vector<Side>& sides) {
  DisjointSets corners(3 * mesh.faces.size());
  const auto corner_of = [&](Index face, Index vertex) {
    const auto& f = mesh.faces[face];
    return 3 * face + (f[0] == vertex ? 0 : f[1] == vertex ? 1 : 2);
  };
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].key() != sides[i + 1].key()) continue;
    for (const Index v : {sides[i].low, sides[i].high}) {
      corners.join(corner_of(sides[i].face, v), corner_of(sides[i + 1].face, v));
    }
  }
  std::vector<Index> fan(mesh.vertices.size(), kNone);
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (Index i = 0; i < 3; ++i) {
      Index& known = fan[mesh.faces[f][i]];
      const Index root = corners.find(3 * f + i);
      if (known == kNone) known = root;
      if (known != root) return false;
    }
  }
  return true;
}

// Edges with a single side, in the direction of its face.
std::vector<std::array<Index, 2>> boundary_of(const std::vector<Side>& sides) {
  std::vector<std::array<Index, 2>> boundary;
  for (std::size_t i = 0, next; i < sides.size(); i = next) {
    for (next = i + 1; next < sides.size() && sides[next].key() == sides[i].key(); ++next) {
    }
    const Side& side = sides[i];
    if (next - i == 1) boundary.push_back({side.forward ? side.low : side.high, side.forward ? side.high : side.low});
  }
  return boundary;
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

}  // namespace

Topology measure_topology(const TriMesh& mesh) {
  check_indices(mesh);
  Topology topology;
  const std::vector<Side> sides = sorted_sides(mesh);
  const std::vector<std::array<Index, 2>> boundary = boundary_of(sides);
  std::int64_t edges = 0;
  bool edge_manifold = true;
  topology.oriented = true;
  for (std::size_t i = 0, next; i < sides.size(); i = next) {
    for (next = i + 1; next < sides.size() && sides[next].key() == sides[i].key(); ++next) {
    }
    ++edges;
    if (next - i > 2) ++topology.crowded_edges;
    if (next - i > 2 || sides[i].low == sides[i].high) edge_manifold = false;
    if (next - i == 2 && sides[i].forward == sides[i + 1].forward) topology.oriented = false;
  }
  topology.oriented = topology.oriented && edge_manifold;
  topology.manifold = edge_manifold && one_fan_each(mesh, sides);
  topology.boundary_edges = boundary.size();
  topology.boundary_loops = count_pieces(boundary, mesh.vertices.size());
  topology.closed = !mesh.faces.empty() && topology.boundary_edges == 0;

  DisjointSets sets(mesh.vertices.size());
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& [a, b, c] : mesh.faces) {
    used[a] = used[b] = used[c] = 1;
    sets.join(a, b);
    sets.join(a, c);
  }
  std::int64_t vertices = 0;
  for (Index v = 0; v < used.size(); ++v) {
    vertices += used[v];
    if (used[v] && sets.find(v) == v) ++topology.components;
  }
  topology.euler_characteristic = vertices - edges + static_cast<std::int64_t>(mesh.faces.size());
  if (topology.closed && topology.oriented) {
    if (topology.manifold) {
      topology.genus = static_cast<std::int64_t>(topology.components) - topology.euler_characteristic / 2;
    }
    std::vector<double> volume(mesh.vertices.size(), 0);
    for (const auto& [a, b, c] : mesh.faces) {
      // Relative to a vertex of the component, so that a far origin costs no precision.
      const Vec3& origin = mesh.vertices[sets.find(a)];
      volume[sets.find(a)] +=
          (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
    }
    topology.outward = true;
    for (Index v = 0; v < used.size(); ++v) {
      if (used[v] && sets.find(v) == v && !(volume[v] > 0)) topology.outward = false;
    }
  }
  return topology;
}

std::vector<std::array<Index, 2>> boundary_edges(const TriMesh& mesh) {
  check_indices(mesh);
  return boundary_of(sorted_sides(mesh));
}

std::vector<Index> valences(const TriMesh& mesh) {
  check_indices(mesh);
  std::vector<Index> valence(mesh.vertices.size(), 0);
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i].low == sides[i].high || (i > 0 && sides[i].key() == sides[i - 1].key())) continue;
    ++valence[sides[i].low];
    ++valence[sides[i].high];
  }
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
