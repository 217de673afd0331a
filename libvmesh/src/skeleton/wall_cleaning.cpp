#include "wall_cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/sorted_by_vertex.h"
#include "vmesh/mesh/topology.h"

#include "wall_text.h"

namespace vmesh::skeleton {
namespace {

// Vertices at boundaries become one within the smallest of these tolerances that closes most edges: from this share of
// the extent, in steps of this factor, up to this share of the median of the faces' shortest
// edges; a larger one closes half of what is left.
constexpr double kSmallestTolerance = 1e-6, kLargestTolerance = 0.1, kNextTolerance = 3;
constexpr double kWorthIt = 0.5;
// A fin has at most this share of the area.
constexpr double kLargestFin = 0.1;
constexpr int kMostFinPasses = 10;
// Edges with three faces that are cut out: in clusters of at most this number, with at most this share of
// the area around them.
constexpr std::size_t kLargestCluster = 4;
constexpr double kLargestCut = 0.01;

bool has_three(const Triangle& face) { return face[0] != face[1] && face[1] != face[2] && face[2] != face[0]; }

double area_of(const TriMesh& mesh, Index f) { return 0.5 * area_normal(mesh, f).norm(); }

/// Vertices that have faces, those at equal positions one; faces that have three.
TriMesh welded(const TriMesh& surface) {
  std::vector<Index> order;
  std::vector<bool> used(surface.vertices.size(), false);
  for (const Triangle& face : surface.faces) {
    for (const Index v : face) used[v] = true;
  }
  for (Index v = 0; v < used.size(); ++v) {
    if (used[v]) order.push_back(v);
  }
  const auto place = [&](Index v) {
    const Vec3& p = surface.vertices[v];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return place(a) != place(b) ? place(a) < place(b) : a < b; });
  std::vector<Index> same(surface.vertices.size(), kNone), number(surface.vertices.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i)
    same[order[i]] = i > 0 && place(order[i]) == place(order[i - 1]) ? same[order[i - 1]] : order[i];
  TriMesh mesh;
  for (Index v = 0; v < same.size(); ++v) {
    if (same[v] != v) continue;
    number[v] = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(surface.vertices[v]);
  }
  for (const auto& [a, b, c] : surface.faces) {
    const Triangle face = {number[same[a]], number[same[b]], number[same[c]]};
    if (has_three(face)) mesh.faces.push_back(face);
  }
  return mesh;
}

std::vector<std::array<Index, 2>> edges_of(const TriMesh& mesh) {
  std::vector<std::array<Index, 2>> edges;
  visit_edges(sides_by_edge(mesh), [&](std::span<const EdgeSide> edge) {
    edges.push_back({edge[0].low, edge[0].high});
  });
  return edges;
}

std::vector<Index> boundary_vertices(const TriMesh& mesh) {
  std::vector<Index> vertices;
  for (const auto& [from, to] : boundary_edges(mesh)) vertices.insert(vertices.end(), {from, to});
  sort_unique(vertices);
  return vertices;
}

/// `mesh` with those of the vertices one that are closer than `tolerance`, but for the ends of an edge. `neighbours`:
/// the edges, ascending.
TriMesh joined_within(const TriMesh& mesh, const std::vector<Index>& vertices,
                      const std::vector<std::array<Index, 2>>& neighbours, double tolerance) {
  Vec3 low = mesh.vertices.front();
  for (const Vec3& p : mesh.vertices) low = low.cwiseMin(p);
  // Cells by a hash: those that share one only cost time.
  const auto key = [&](const Vec3& p, int n) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis, n /= 3) {
      const auto cell = static_cast<std::int64_t>(std::floor((p[axis] - low[axis]) / tolerance)) + n % 3 - 1;
      hash = (hash ^ static_cast<std::uint64_t>(cell)) * 0x9e3779b97f4a7c15;
    }
    return hash;
  };
  constexpr int kCells = 27, kHome = 13;
  std::unordered_map<std::uint64_t, Index> last;  // vertex in a cell
  std::vector<Index> before(mesh.vertices.size(), kNone);
  last.reserve(vertices.size());
  DisjointSets sets(mesh.vertices.size());
  for (const Index v : vertices) {
    for (int n = 0; n < kCells; ++n) {
      const auto there = last.find(key(mesh.vertices[v], n));
      for (Index w = there == last.end() ? kNone : there->second; w != kNone; w = before[w]) {
        if (!((mesh.vertices[v] - mesh.vertices[w]).norm() <= tolerance)) continue;
        if (!std::binary_search(neighbours.begin(), neighbours.end(), std::array{std::min(v, w), std::max(v, w)}))
          sets.join(v, w);
      }
    }
    const auto [home, fresh] = last.try_emplace(key(mesh.vertices[v], kHome), v);
    if (!fresh) before[v] = std::exchange(home->second, v);
  }
  TriMesh result{mesh.vertices, {}};
  for (const auto& [a, b, c] : mesh.faces) {
    const Triangle face = {sets.find(a), sets.find(b), sets.find(c)};
    if (has_three(face)) result.faces.push_back(face);
  }
  return result;
}

/// Of the shortest edge of every face: triangles along a vessel may be long.
double median_edge(const TriMesh& mesh) {
  std::vector<double> lengths;
  for (const auto& [a, b, c] : mesh.faces)
    lengths.push_back(
        std::min({(mesh.vertices[a] - mesh.vertices[b]).norm(), (mesh.vertices[b] - mesh.vertices[c]).norm(),
                  (mesh.vertices[c] - mesh.vertices[a]).norm()}));
  return lengths.empty() ? 0 : median(std::move(lengths));
}

void close_cracks(TriMesh& mesh, std::vector<std::string>& notes) {
  if (mesh.faces.empty()) return;
  const std::vector<Index> vertices = boundary_vertices(mesh);
  if (vertices.empty()) return;
  const std::vector<std::array<Index, 2>> edges = edges_of(mesh);
  const double smallest = kSmallestTolerance * extent_of(mesh);
  const double largest = std::max(smallest, kLargestTolerance * median_edge(mesh));
  std::size_t open = boundary_edges(mesh).size();
  double used = 0;
  TriMesh best;
  for (double tolerance = smallest; tolerance > 0 && tolerance <= largest && open > 0; tolerance *= kNextTolerance) {
    TriMesh joined = joined_within(mesh, vertices, edges, tolerance);
    const std::size_t left = boundary_edges(joined).size();
    if (static_cast<double>(left) > kWorthIt * static_cast<double>(open) || joined.faces.empty()) continue;
    open = left;
    used = tolerance;
    best = std::move(joined);
  }
  if (used == 0) return;
  mesh = std::move(best);
  notes.push_back("vertices at boundaries that are closer than " + text(used) + " mm are taken as one");
}

// Faces with the same three vertices, in whatever order.
struct Same {
  std::array<Index, 3> vertices;
  Index face;
};

std::vector<std::vector<Index>> groups_of_same(const TriMesh& mesh) {
  const auto visit = [&](auto&& take) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      std::array<Index, 3> vertices = mesh.faces[f];
      std::sort(vertices.begin(), vertices.end());
      take(vertices[0], Same{vertices, f});
    }
  };
  const auto before = [](const Same& a, const Same& b) {
    return std::tie(a.vertices, a.face) < std::tie(b.vertices, b.face);
  };
  std::vector<std::vector<Index>> groups;
  const std::vector<Same> faces = sorted_by_vertex<Same>(mesh.vertices.size(), visit, before);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i == 0 || faces[i].vertices != faces[i - 1].vertices) groups.emplace_back();
    groups.back().push_back(faces[i].face);
  }
  return groups;
}

/// Patches of faces that are there twice and whose borders are edges of an even number of others: walls between two
/// volumes, each of which has them.
std::vector<bool> partitions(const TriMesh& mesh, const std::vector<bool>& twice) {
  DisjointSets patches(mesh.faces.size());
  std::vector<std::size_t> inner(mesh.faces.size(), 0), outer(mesh.faces.size(), 0);
  const std::vector<EdgeSide> sides = sides_by_edge(mesh);
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2 && twice[edge[0].side / 3] && twice[edge[1].side / 3])
      patches.join(edge[0].side / 3, edge[1].side / 3);
  });
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2 && twice[edge[0].side / 3] && twice[edge[1].side / 3]) return;
    for (const EdgeSide& side : edge) {
      if (!twice[side.side / 3]) continue;
      ++(edge.size() > 1 && edge.size() % 2 == 1 ? inner : outer)[patches.find(side.side / 3)];
    }
  });
  std::vector<bool> is_partition(mesh.faces.size(), false);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    is_partition[f] = twice[f] && inner[patches.find(f)] > outer[patches.find(f)];
  return is_partition;
}

void drop_duplicates(TriMesh& mesh, std::vector<std::string>& notes) {
  const std::vector<std::vector<Index>> groups = groups_of_same(mesh);
  const std::size_t before = mesh.faces.size();
  if (groups.size() == before) return;
  std::vector<bool> kept(before, false), even(before, false);
  for (const std::vector<Index>& group : groups) {
    kept[group.front()] = true;
    even[group.front()] = group.size() % 2 == 0;
  }
  std::vector<bool> twice;
  for (Index f = 0; f < before; ++f) {
    if (kept[f]) twice.push_back(even[f]);
  }
  keep_faces(mesh, kept);
  const std::vector<bool> is_partition = partitions(mesh, twice);
  kept.assign(mesh.faces.size(), true);
  for (Index f = 0; f < mesh.faces.size(); ++f) kept[f] = !is_partition[f];
  keep_faces(mesh, kept);
  notes.push_back(counted(before - mesh.faces.size(), "duplicate face is left out", "duplicate faces are left out"));
}

struct Patch {
  double area = 0;
  bool is_open = false, hangs = false;
  std::vector<std::array<Index, 2>> border;
};

/// Patches that are joined by edges of two faces, under the numbers of their first faces.
std::map<Index, Patch> patches_of(const TriMesh& mesh, DisjointSets& sets) {
  const std::vector<EdgeSide> sides = sides_by_edge(mesh);
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2) sets.join(edge[0].side / 3, edge[1].side / 3);
  });
  std::map<Index, Patch> patches;
  for (Index f = 0; f < mesh.faces.size(); ++f) patches[sets.find(f)].area += area_of(mesh, f);
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() == 2) return;
    for (const EdgeSide& side : edge) {
      Patch& patch = patches[sets.find(side.side / 3)];
      (edge.size() == 1 ? patch.is_open : patch.hangs) = true;
      patch.border.push_back({side.low, side.high});
    }
  });
  return patches;
}

bool in_one_piece(const std::vector<std::array<Index, 2>>& border) {
  std::map<Index, Index> number;
  for (const auto& edge : border) {
    for (const Index v : edge) number.emplace(v, static_cast<Index>(number.size()));
  }
  DisjointSets sets(number.size());
  std::size_t pieces = number.size();
  for (const auto& [a, b] : border) pieces -= sets.join(number[a], number[b]) ? 1 : 0;
  return pieces == 1;
}

bool has_crowded_edge(const TriMesh& mesh) {
  bool crowded = false;
  visit_edges(sides_by_edge(mesh), [&](std::span<const EdgeSide> edge) { crowded = crowded || edge.size() > 2; });
  return crowded;
}

/// Edges with an odd number of faces, three or more.
std::vector<EdgeSide> odd_edges(const std::vector<EdgeSide>& sides) {
  std::vector<EdgeSide> odd;
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() > 2 && edge.size() % 2 == 1) odd.push_back(edge[0]);
  });
  return odd;
}

bool are_scattered(const std::vector<EdgeSide>& edges, std::size_t vertices) {
  DisjointSets sets(vertices);
  for (const EdgeSide& edge : edges) sets.join(edge.low, edge.high);
  std::map<Index, std::size_t> cluster;
  std::size_t largest = 0;
  for (const EdgeSide& edge : edges) largest = std::max(largest, ++cluster[sets.find(edge.low)]);
  return largest <= kLargestCluster;
}

}  // namespace

double extent_of(const TriMesh& mesh) {
  Vec3 low = mesh.vertices.front(), high = low;
  for (const Vec3& p : mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

double area_of(const TriMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) area += area_of(mesh, f);
  return area;
}

std::vector<EdgeSide> sides_by_edge(const TriMesh& mesh) {
  const auto visit = [&](auto&& take) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      for (Index i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]);
        take(low, EdgeSide{low, high, 3 * f + i});
      }
    }
  };
  return sorted_by_vertex<EdgeSide>(mesh.vertices.size(), visit, [](const EdgeSide& a, const EdgeSide& b) {
    return std::tie(a.high, a.side) < std::tie(b.high, b.side);
  });
}

void keep_faces(TriMesh& mesh, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (kept[f]) mesh.faces[count++] = mesh.faces[f];
  }
  mesh.faces.resize(count);
}

TriMesh cleaned_soup(const TriMesh& surface, std::vector<std::string>& notes) {
  TriMesh mesh = welded(surface);
  close_cracks(mesh, notes);
  if (const std::size_t lost = surface.faces.size() - mesh.faces.size(); lost > 0) {
    notes.push_back(
        counted(lost, "face whose corners coincide is left out", "faces whose corners coincide are left out"));
  }
  drop_duplicates(mesh, notes);
  return mesh;
}

void drop_fins(TriMesh& mesh, std::vector<std::string>& notes) {
  const double largest = kLargestFin * area_of(mesh);
  std::size_t count = 0;
  for (int pass = 0; pass < kMostFinPasses && has_crowded_edge(mesh); ++pass) {
    DisjointSets sets(mesh.faces.size());
    const std::map<Index, Patch> patches = patches_of(mesh, sets);
    std::vector<bool> kept(mesh.faces.size(), true);
    std::size_t dropped = 0;
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const Index root = sets.find(f);
      if (root == f) {
        const Patch& patch = patches.at(f);
        kept[f] = !(patch.is_open && patch.hangs && patch.area < largest && in_one_piece(patch.border));
        dropped += kept[f] ? 0 : 1;
      }
      kept[f] = kept[root];
    }
    if (dropped == 0) break;
    count += dropped;
    keep_faces(mesh, kept);
  }
  if (count > 0) {
    notes.push_back(counted(count, "patch that hangs on an edge of others is left out",
                            "patches that hang on an edge of others are left out"));
  }
}

void cut_out_odd_edges(TriMesh& mesh, std::vector<std::string>& notes) {
  const std::vector<EdgeSide> sides = sides_by_edge(mesh), odd = odd_edges(sides);
  if (odd.empty() || !are_scattered(odd, mesh.vertices.size())) return;
  std::vector<bool> kept(mesh.faces.size(), true);
  visit_edges(sides, [&](std::span<const EdgeSide> edge) {
    if (edge.size() <= 2 || edge.size() % 2 == 0) return;
    for (const EdgeSide& side : edge) kept[side.side / 3] = false;
  });
  double cut = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) cut += kept[f] ? 0 : area_of(mesh, f);
  if (cut > kLargestCut * area_of(mesh)) return;
  keep_faces(mesh, kept);
  const Vec3& at = mesh.vertices[odd.front().low];
  notes.push_back(counted(odd.size(), "edge with three faces is cut out", "edges with three faces are cut out") +
                  ", the first at " + text(at));
}

}  // namespace vmesh::skeleton
