#include "surface/ends/overhangs.h"

#include <algorithm>
#include <map>

#include "vmesh/edit/crossing_guard.h"
#include "vmesh/surface/disc.h"

#include "surface/ends/ring_moves.h"

namespace vmesh {
namespace {

// Height over the plane of the ring, by the distance from the ring's edge, of what is lowered and after that.
constexpr double kHighest = -0.1, kLowered = -0.15;

class OverhangFinder {
 public:
  explicit OverhangFinder(const GenerateResult& result) : mesh_(result.mesh), is_on_ring_(vertices_on_rings(result)) {
    for (const Opening& opening : result.openings) {
      const Vec3 normal = area_vector(ring_positions(mesh_, opening)).normalized();
      for (const Index v : opening.ring) normal_at_[v] = normal;
    }
    for (const Triangle& face : mesh_.faces) {
      for (std::size_t i = 0; i < 3; ++i) look_at(face[i], face[(i + 1) % 3], face[(i + 2) % 3]);
    }
  }

  /// Moves of the vertices that are too high.
  const std::map<Index, Vec3>& moves() const { return moves_; }

 private:
  // A face with the edge a-b on a ring.
  void look_at(Index a, Index b, Index top) {
    if (!is_on_ring_[a] || !is_on_ring_[b] || is_on_ring_[top]) return;
    const Vec3 &normal = normal_at_.at(a), &p = mesh_.vertices[a];
    const Vec3 edge = mesh_.vertices[b] - p, way = mesh_.vertices[top] - p;
    const double height = normal.dot(way), distance = edge.cross(way).norm() / edge.norm();
    if (!(height > kHighest * distance)) return;
    const Vec3 move = (kLowered * distance - height) * normal;
    const auto [found, is_new] = moves_.try_emplace(top, move);
    if (!is_new && move.squaredNorm() > found->second.squaredNorm()) found->second = move;
  }

  const TriMesh& mesh_;
  std::vector<char> is_on_ring_;
  std::map<Index, Vec3> normal_at_;  // of ring vertices: of the ring
  std::map<Index, Vec3> moves_;
};

}  // namespace

void lower_overhangs(GenerateResult& result) {
  std::vector<Vec3>& positions = result.mesh.vertices;
  const std::map<Index, Vec3> overhangs = OverhangFinder(result).moves();
  std::map<Index, Vec3> before;
  for (const auto& [v, move] : overhangs) {
    before[v] = positions[v];
    positions[v] += move;
  }
  bool any = !before.empty();
  while (any) {
    any = false;
    const TriMesh closed = with_lids(result);
    std::vector<Index> changed;
    for (Index f = 0; f < closed.faces.size(); ++f) {
      const Triangle& face = closed.faces[f];
      if (std::any_of(face.begin(), face.end(), [&](Index v) { return before.contains(v); })) changed.push_back(f);
    }
    for (const auto& [f, g] : crossing_pairs(closed.vertices, closed.faces, changed)) {
      for (const Index face : {f, g}) {
        for (const Index v : closed.faces[face]) {
          const auto found = before.find(v);
          if (found == before.end()) continue;
          positions[v] = found->second;
          before.erase(found);
          any = true;
        }
      }
    }
  }
}

}  // namespace vmesh
