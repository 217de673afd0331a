#include "surface/docking.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <stdexcept>

namespace vmesh {
namespace {

constexpr std::array kCutHeights = {-0.3, 0.0, 0.3, 0.6};  // radii beyond the tip's centre, tried in this order

// Shortest way through the grid of pairs (bottom i, top j) from (0, start) once around both loops.
class BandSearch {
 public:
  BandSearch(std::span<const Vec3> bottom, std::span<const Vec3> top)
      : bottom_(bottom), top_(top), cost_((bottom.size() + 1) * (top.size() + 1)), from_bottom_(cost_.size()) {}

  double run(std::size_t first, std::size_t start) {
    first_ = first;
    start_ = start;
    for (std::size_t i = 0; i <= bottom_.size(); ++i) {
      for (std::size_t j = 0; j <= top_.size(); ++j) {
        const double edge = i + j == 0 ? 0 : (low(i) - high(j)).squaredNorm();
        const double via_bottom = i > 0 ? cost(i - 1, j) : kInfinite, via_top = j > 0 ? cost(i, j - 1) : kInfinite;
        from_bottom_[at(i, j)] = via_bottom < via_top;
        cost_[at(i, j)] = i + j == 0 ? 0 : std::min(via_bottom, via_top) + edge;
      }
    }
    return cost_.back();
  }

  std::vector<Triangle> faces() const {
    std::vector<Triangle> result;
    for (std::size_t i = bottom_.size(), j = top_.size(); i + j > 0;) {
      if (from_bottom_[at(i, j)]) {
        result.push_back({index_low(i - 1), index_low(i), index_high(j)});
        --i;
      } else {
        result.push_back({index_low(i), index_high(j), index_high(j - 1)});
        --j;
      }
    }
    return result;
  }

 private:
  static constexpr double kInfinite = std::numeric_limits<double>::infinity();

  std::size_t at(std::size_t i, std::size_t j) const { return i * (top_.size() + 1) + j; }
  double cost(std::size_t i, std::size_t j) const { return cost_[at(i, j)]; }
  Index index_low(std::size_t i) const { return static_cast<Index>((first_ + i) % bottom_.size()); }
  Index index_high(std::size_t j) const { return static_cast<Index>(bottom_.size() + (start_ + j) % top_.size()); }
  const Vec3& low(std::size_t i) const { return bottom_[index_low(i)]; }
  const Vec3& high(std::size_t j) const { return top_[index_high(j) - bottom_.size()]; }

  std::span<const Vec3> bottom_, top_;
  std::size_t first_ = 0, start_ = 0;
  std::vector<double> cost_;
  std::vector<char> from_bottom_;
};

double distance2_to(std::span<const Vec3> loop, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& q : loop) least = std::min(least, (q - p).squaredNorm());
  return least;
}

}  // namespace

std::vector<Triangle> stitch(std::span<const Vec3> bottom, std::span<const Vec3> top) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < bottom.size(); ++i) {
    if (distance2_to(top, bottom[i]) < distance2_to(top, bottom[first])) first = i;
  }
  BandSearch search(bottom, top);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t start = 0; start < top.size(); ++start) {
    const double cost = search.run(first, start);
    if (cost < least) {
      least = cost;
      best = start;
    }
  }
  search.run(first, best);
  return search.faces();
}

DiscCutter::DiscCutter(const std::vector<Vec3>& vertices, const std::vector<Triangle>& faces)
    : vertices_(vertices),
      faces_(faces),
      faces_of_(vertices.size()),
      cut_(faces.size(), 0),
      on_loop_(vertices.size(), 0) {
  for (Index f = 0; f < faces.size(); ++f) {
    for (const Index v : faces[f]) faces_of_[v].push_back(f);
  }
}

std::vector<Index> DiscCutter::cut(const Vec3& center, const Vec3& normal, double radius,
                                   const std::vector<Index>& own) {
  Index apex = kNone;
  double highest = -std::numeric_limits<double>::infinity();
  for (const Index v : own) {
    const double height = (vertices_[v] - center).dot(normal);
    const bool whole = std::none_of(faces_of_[v].begin(), faces_of_[v].end(), [&](Index f) { return cut_[f]; });
    if (height > highest && whole && !on_loop_[v]) {
      highest = height;
      apex = v;
    }
  }
  if (apex == kNone) return cut_one_face(center + radius * normal);
  std::vector<Index> cut_faces;
  for (const double height : kCutHeights) {
    const auto loop = loop_around(tip_region(apex, center, normal, height * radius, own), cut_faces);
    if (!loop.empty()) return take(loop, cut_faces);
  }
  const auto loop = loop_around({apex}, cut_faces);
  return loop.empty() ? cut_one_face(vertices_[apex]) : take(loop, cut_faces);
}

std::vector<Index> DiscCutter::tip_region(Index apex, const Vec3& center, const Vec3& normal, double height,
                                          const std::vector<Index>& own) const {
  std::vector<char> open(vertices_.size(), 0);  // may join and has not yet
  for (const Index v : own) open[v] = (vertices_[v] - center).dot(normal) > height;
  std::vector<Index> region = {apex};
  open[apex] = 0;
  for (std::size_t i = 0; i < region.size(); ++i) {
    for (const Index f : faces_of_[region[i]]) {
      for (const Index v : faces_[f]) {
        if (!open[v]) continue;
        open[v] = 0;
        region.push_back(v);
      }
    }
  }
  return region;
}

std::vector<Index> DiscCutter::loop_around(const std::vector<Index>& region, std::vector<Index>& cut_faces) const {
  cut_faces.clear();
  for (const Index v : region) {
    if (on_loop_[v]) return {};
    cut_faces.insert(cut_faces.end(), faces_of_[v].begin(), faces_of_[v].end());
  }
  std::sort(cut_faces.begin(), cut_faces.end());
  cut_faces.erase(std::unique(cut_faces.begin(), cut_faces.end()), cut_faces.end());
  std::map<std::pair<Index, Index>, int> edges;  // directed
  for (const Index f : cut_faces) {
    if (cut_[f]) return {};
    for (int i = 0; i < 3; ++i) edges[{faces_[f][i], faces_[f][(i + 1) % 3]}] = 1;
  }
  std::map<Index, Index> next;
  for (const auto& [edge, used] : edges) {
    if (edges.count({edge.second, edge.first})) continue;
    if (!next.emplace(edge.first, edge.second).second) return {};  // the rim touches itself
  }
  if (next.size() < 3) return {};
  std::vector<Index> loop = {next.begin()->first};
  for (Index v = next.begin()->second; v != loop.front(); v = next.at(v)) loop.push_back(v);
  // One rim, and as many faces as a disc with these vertices has.
  std::vector<Index> inner;
  for (const Index f : cut_faces) inner.insert(inner.end(), faces_[f].begin(), faces_[f].end());
  std::sort(inner.begin(), inner.end());
  const auto vertex_count = static_cast<std::size_t>(std::unique(inner.begin(), inner.end()) - inner.begin());
  if (loop.size() != next.size() || cut_faces.size() != 2 * vertex_count - loop.size() - 2) return {};
  return loop;
}

std::vector<Index> DiscCutter::take(const std::vector<Index>& loop, const std::vector<Index>& cut_faces) {
  for (const Index v : loop) on_loop_[v] = 1;
  for (const Index f : cut_faces) cut_[f] = 1;
  return loop;
}

std::vector<Index> DiscCutter::cut_one_face(const Vec3& near) {
  Index best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < faces_.size(); ++f) {
    if (cut_[f]) continue;
    const auto& [a, b, c] = faces_[f];
    const double distance = ((vertices_[a] + vertices_[b] + vertices_[c]) / 3 - near).squaredNorm();
    if (distance < least) {
      least = distance;
      best = f;
    }
  }
  if (best == kNone) throw std::logic_error("a junction has fewer faces than branches");
  const auto& [a, b, c] = faces_[best];
  return take({a, b, c}, {best});
}

std::vector<Triangle> DiscCutter::rest() const {
  std::vector<Triangle> result;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (!cut_[f]) result.push_back(faces_[f]);
  }
  return result;
}

}  // namespace vmesh
