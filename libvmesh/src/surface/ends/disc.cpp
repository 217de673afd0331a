#include "vmesh/surface/disc.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "vmesh/mesh/polygon_triangulation.h"

#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

constexpr int kRounds = 4, kSmoothingRounds = 10;
constexpr double kHalfTurn = std::numbers::pi * (1 + 1e-9);  // pi with a tolerance for rounding

/// Points of the ring at even steps of its parameter, scaled towards the centre.
std::vector<Vec3> inner_ring(const std::vector<Vec3>& ring, const Vec3& center, double scale, std::size_t count) {
  std::vector<Vec3> inner;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i * ring.size()) / static_cast<double>(count);
    const auto j = static_cast<std::size_t>(at);
    const Vec3 p = ring[j] + (at - static_cast<double>(j)) * (ring[(j + 1) % ring.size()] - ring[j]);
    inner.push_back(center + scale * (p - center));
  }
  return inner;
}

class DiscBuilder {
 public:
  DiscBuilder(const std::vector<Vec3>& ring, const Vec3& normal) : all_(ring), ring_(ring), normal_(normal) {}

  Disc run() {
    const auto bands = static_cast<std::size_t>(std::lround(static_cast<double>(ring_.size()) / 6));
    if (ring_.size() == 3) return {{}, {{0, 1, 2}}};
    const Vec3 center = area_centroid(ring_);
    std::vector<Index> outer(ring_.size());
    for (Index j = 0; j < outer.size(); ++j) outer[j] = j;
    for (std::size_t k = 1; k < std::max<std::size_t>(bands, 1); ++k) {
      const double scale = static_cast<double>(bands - k) / static_cast<double>(bands);
      const std::size_t count = 6 * (bands - k);  // as in a lattice of equilateral triangles
      outer = add_band(outer, inner_ring(ring_, center, scale, count));
    }
    const auto middle = static_cast<Index>(all_.size());
    all_.push_back(center);
    for (std::size_t j = 0; j < outer.size(); ++j) faces_.push_back({outer[j], outer[(j + 1) % outer.size()], middle});
    if (!faces_up()) return {{}, triangulate_polygon(ring_)};
    for (int round = 0; round < kRounds; ++round) {
      smooth();
      flip();
    }
    return {{all_.begin() + static_cast<std::ptrdiff_t>(ring_.size()), all_.end()}, faces_};
  }

 private:
  std::vector<Vec3> positions(const std::vector<Index>& loop) const {
    std::vector<Vec3> result;
    for (const Index v : loop) result.push_back(all_[v]);
    return result;
  }

  std::vector<Index> add_band(const std::vector<Index>& outer, const std::vector<Vec3>& points) {
    std::vector<Index> inner;
    for (const Vec3& p : points) {
      inner.push_back(static_cast<Index>(all_.size()));
      all_.push_back(p);
    }
    const auto vertex = [&](Index i) { return i < outer.size() ? outer[i] : inner[i - outer.size()]; };
    for (const auto& [a, b, c] : stitch(positions(outer), points)) faces_.push_back({vertex(a), vertex(b), vertex(c)});
    return inner;
  }

  bool face_up(const Triangle& f) const {
    return (all_[f[1]] - all_[f[0]]).cross(all_[f[2]] - all_[f[0]]).dot(normal_) > 0;
  }

  bool faces_up() const {
    return std::all_of(faces_.begin(), faces_.end(), [&](const Triangle& f) { return face_up(f); });
  }

  // Moves every added vertex to the mean of its neighbours unless that turns a face over.
  void smooth() {
    std::vector<std::vector<Index>> around(all_.size());
    for (Index f = 0; f < faces_.size(); ++f) {
      for (const Index v : faces_[f]) around[v].push_back(f);
    }
    for (int round = 0; round < kSmoothingRounds; ++round) {
      for (std::size_t v = ring_.size(); v < all_.size(); ++v) {
        Vec3 sum = Vec3::Zero();
        for (const Index f : around[v]) {
          for (const Index w : faces_[f]) sum += all_[w] - all_[v];
        }
        const Vec3 before = all_[v];
        all_[v] += sum / static_cast<double>(2 * around[v].size());  // every neighbour shares two faces with v
        const bool good = std::all_of(around[v].begin(), around[v].end(), [&](Index f) { return face_up(faces_[f]); });
        if (!good) all_[v] = before;
      }
    }
  }

  double angle(Index at, Index a, Index b) const {
    const Vec3 u = all_[a] - all_[at], v = all_[b] - all_[at];
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

  // Flips edges whose opposite angles add up to more than pi (Delaunay).
  void flip() {
    std::map<std::array<Index, 2>, Index> face_of;  // keyed by the edge in the face's direction
    const auto enter = [&](Index f) {
      for (std::size_t i = 0; i < 3; ++i) face_of[{faces_[f][i], faces_[f][(i + 1) % 3]}] = f;
    };
    for (Index f = 0; f < faces_.size(); ++f) enter(f);
    for (Index f = 0; f < faces_.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = faces_[f][i], b = faces_[f][(i + 1) % 3], top = faces_[f][(i + 2) % 3];
        const auto other = face_of.find({b, a});
        if (other == face_of.end()) continue;
        const Index g = other->second;
        const Index bottom =
            *std::find_if(faces_[g].begin(), faces_[g].end(), [&](Index v) { return v != a && v != b; });
        const Triangle left = {top, a, bottom}, right = {bottom, b, top};
        if (angle(top, a, b) + angle(bottom, a, b) < kHalfTurn || face_of.contains({top, bottom}) ||
            face_of.contains({bottom, top}) || !face_up(left) || !face_up(right))
          continue;
        face_of.erase({a, b});
        face_of.erase({b, a});
        faces_[f] = left;
        faces_[g] = right;
        enter(f);
        enter(g);
        break;
      }
    }
  }

  std::vector<Vec3> all_;
  const std::vector<Vec3>& ring_;
  Vec3 normal_;
  std::vector<Triangle> faces_;
};

}  // namespace

Vec3 area_vector(const std::vector<Vec3>& ring) {
  Vec3 area = Vec3::Zero();
  for (std::size_t j = 1; j + 1 < ring.size(); ++j) area += (ring[j] - ring[0]).cross(ring[j + 1] - ring[0]) / 2;
  return area;
}

Vec3 area_centroid(const std::vector<Vec3>& ring) {
  const Vec3 whole = area_vector(ring);
  Vec3 offset = Vec3::Zero();
  for (std::size_t j = 1; j + 1 < ring.size(); ++j) {
    const Vec3 a = ring[j] - ring[0], b = ring[j + 1] - ring[0];
    offset += a.cross(b).dot(whole) / 2 * (a + b) / 3;
  }
  return ring[0] + offset / whole.squaredNorm();
}

Disc fill_ring(const std::vector<Vec3>& ring, const Vec3& normal) { return DiscBuilder(ring, normal).run(); }

}  // namespace vmesh
