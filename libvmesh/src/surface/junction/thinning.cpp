#include "surface/junction/thinning.h"

#include <numeric>

namespace vmesh {
namespace {

// Least cosine between the normal of a face around a merged vertex and the mean normal of the faces it replaces.
constexpr double kLeastAgreement = 0.2;

class Thinning {
 public:
  explicit Thinning(const LatticeSurface& surface)
      : surface_(surface),
        merged_into_(surface.vertices.size()),
        positions_(surface.vertices),
        next_(surface.vertices.size(), kNone),
        seen_by_(surface.faces.size(), kNone) {
    std::iota(merged_into_.begin(), merged_into_.end(), Index{0});
    list_faces_around();
  }

  LatticeSurface run() {
    std::vector<Index> order(surface_.vertices.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index v, Index w) { return surface_.points[v] < surface_.points[w]; });
    for (std::size_t begin = 0, end; begin < order.size(); begin = end) {
      end = begin + 1;
      while (end < order.size() && surface_.points[order[end]] == surface_.points[order[begin]]) ++end;
      if (end - begin > 1) merge({order.data() + begin, order.data() + end});
    }
    return rest();
  }

 private:
  void list_faces_around() {
    offsets_.assign(surface_.vertices.size() + 1, 0);
    for (const Triangle& face : surface_.faces) {
      for (const Index v : face) ++offsets_[v + 1];
    }
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    around_.resize(offsets_.back());
    std::vector<Index> end(offsets_.begin(), offsets_.end() - 1);
    for (Index f = 0; f < surface_.faces.size(); ++f) {
      for (const Index v : surface_.faces[f]) around_[end[v]++] = f;
    }
  }

  Triangle corners(Index f) const {
    const auto& [a, b, c] = surface_.faces[f];
    return {merged_into_[a], merged_into_[b], merged_into_[c]};
  }

  void merge(std::span<const Index> group) {
    outline_.clear();
    if (is_disc(group)) {
      Vec3 middle = Vec3::Zero();
      for (const Index v : group) middle += surface_.vertices[v] / static_cast<double>(group.size());
      if (stays_upright(middle)) {
        for (const Index v : group) merged_into_[v] = group.front();
        positions_[group.front()] = middle;
      }
    }
    for (const auto& [from, to] : outline_) next_[from] = kNone;
  }

  // Whether the faces around the group form a disc: their outline is one cycle that meets no vertex twice, and their
  // Euler characteristic is 1.
  bool is_disc(std::span<const Index> group) {
    std::size_t faces = 0;
    normal_.setZero();
    const Index point = surface_.points[group.front()];
    const auto in_group = [&](Index v) { return surface_.points[v] == point; };
    for (const Index v : group) {
      for (Index i = offsets_[v]; i < offsets_[v + 1]; ++i) {
        const Index f = around_[i];
        if (seen_by_[f] == point) continue;
        seen_by_[f] = point;
        const Triangle t = corners(f);
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        ++faces;
        normal_ += (positions_[t[1]] - positions_[t[0]]).cross(positions_[t[2]] - positions_[t[0]]);
        for (int k = 0; k < 3; ++k) {
          const Index a = t[k], b = t[(k + 1) % 3];
          if (!in_group(t[(k + 2) % 3]) || in_group(a) || in_group(b)) continue;
          if (next_[a] != kNone) return false;
          next_[a] = b;
          outline_.emplace_back(a, b);
        }
      }
    }
    if (outline_.size() < 3 || 2 * group.size() + outline_.size() != faces + 2) return false;
    std::size_t length = 0;
    Index v = outline_.front().first;
    do {
      v = next_[v];
      ++length;
    } while (v != kNone && v != outline_.front().first && length <= outline_.size());
    return v == outline_.front().first && length == outline_.size();
  }

  bool stays_upright(const Vec3& middle) const {
    return std::ranges::all_of(outline_, [&](const auto& edge) {
      const Vec3 normal = (positions_[edge.first] - middle).cross(positions_[edge.second] - middle);
      return normal.dot(normal_) > kLeastAgreement * normal.norm() * normal_.norm();
    });
  }

  LatticeSurface rest() const {
    LatticeSurface rest;
    rest.handles = surface_.handles;
    std::vector<Index> number(surface_.vertices.size(), kNone);
    for (Index v = 0; v < number.size(); ++v) {
      if (merged_into_[v] != v) continue;
      number[v] = static_cast<Index>(rest.vertices.size());
      rest.vertices.push_back(positions_[v]);
      rest.cones.push_back(surface_.cones[v]);
      rest.points.push_back(surface_.points[v]);
    }
    for (Index f = 0; f < surface_.faces.size(); ++f) {
      const auto [a, b, c] = corners(f);
      if (a != b && b != c && c != a) rest.faces.push_back({number[a], number[b], number[c]});
    }
    return rest;
  }

  const LatticeSurface& surface_;
  std::vector<Index> merged_into_;
  std::vector<Vec3> positions_;
  std::vector<Index> offsets_, around_;           // the faces around every vertex
  std::vector<Index> next_;                       // vertex along the outline
  std::vector<std::pair<Index, Index>> outline_;  // of the faces under consideration
  std::vector<Index> seen_by_;                    // for every face, the point that last visited it
  Vec3 normal_ = Vec3::Zero();
};

}  // namespace

LatticeSurface thinned(const LatticeSurface& surface) { return Thinning(surface).run(); }

}  // namespace vmesh
