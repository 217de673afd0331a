#include "surface/ends/ring_moves.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vmesh {
namespace {

constexpr double kStretch = 0.25;  // of edges, at most

}  // namespace

std::vector<std::vector<Index>> neighbours(const TriMesh& mesh) {
  std::vector<std::vector<Index>> around(mesh.vertices.size());
  for (const Triangle& f : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      around[f[i]].push_back(f[(i + 1) % 3]);
      around[f[(i + 1) % 3]].push_back(f[i]);
    }
  }
  return around;
}

std::vector<Vec3> ring_positions(const TriMesh& mesh, const Opening& opening) {
  std::vector<Vec3> ring;
  for (const Index v : opening.ring) ring.push_back(mesh.vertices[v]);
  return ring;
}

std::vector<char> vertices_on_rings(const GenerateResult& result) {
  std::vector<char> on_ring(result.mesh.vertices.size(), 0);
  for (const Opening& opening : result.openings) {
    for (const Index v : opening.ring) on_ring[v] = 1;
  }
  return on_ring;
}

std::vector<VertexMove> spread_moves(const std::vector<std::vector<Index>>& neighbours,
                                     const std::vector<char>& is_on_ring, const std::vector<Index>& ring,
                                     const std::vector<Vec3>& ways, double edge) {
  double farthest = 0;
  for (const Vec3& way : ways) farthest = std::max(farthest, way.norm());
  const double layers = std::max(1.0, std::ceil(farthest / (kStretch * edge)));
  std::map<Index, Vec3> moved;
  std::vector<Index> front = ring;
  for (std::size_t j = 0; j < ring.size(); ++j) moved[ring[j]] = ways[j];
  for (double layer = 1; layer < layers && !front.empty(); ++layer) {
    struct Sum {
      Vec3 ways = Vec3::Zero();
      double count = 0;
    };
    std::map<Index, Sum> sums;
    for (const Index v : front) {
      for (const Index w : neighbours[v]) {
        if (moved.contains(w) || is_on_ring[w]) continue;
        sums[w].ways += moved[v];
        sums[w].count += 1;
      }
    }
    front.clear();
    for (const auto& [w, sum] : sums) {
      moved[w] = sum.ways / sum.count * (layers - layer) / (layers - layer + 1);
      front.push_back(w);
    }
  }
  std::vector<VertexMove> moves;
  for (const auto& [v, way] : moved) moves.push_back({v, way});
  return moves;
}

void apply_moves(const std::vector<VertexMove>& moves, TriMesh& mesh) {
  for (const auto& [v, way] : moves) mesh.vertices[v] += way;
}

}  // namespace vmesh
