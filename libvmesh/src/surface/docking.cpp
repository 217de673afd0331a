#include "surface/docking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

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
        const double edge = i + j == 0 ? 0 : in_step(i, j) ? (low(i) - high(j)).squaredNorm() : kInfinite;
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

  // Neither loop may be walked around while the other stands still: an edge would come back.
  bool in_step(std::size_t i, std::size_t j) const {
    const auto n = static_cast<double>(bottom_.size()), m = static_cast<double>(top_.size());
    return std::abs(static_cast<double>(i) / n - static_cast<double>(j) / m) < 0.5;
  }

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

DiscCutter::DiscCutter(std::vector<Vec3> vertices, std::vector<Triangle> faces)
    : vertices_(std::move(vertices)),
      faces_(std::move(faces)),
      source_(vertices_.size()),
      faces_of_(vertices_.size()),
      cut_(faces_.size(), 0) {
  std::iota(source_.begin(), source_.end(), Index{0});
  for (Index f = 0; f < faces_.size(); ++f) {
    for (const Index v : faces_[f]) faces_of_[v].push_back(f);
  }
}

std::vector<Index> DiscCutter::cut(const Vec3& center, const Vec3& normal, double radius,
                                   const std::vector<Index>& own) {
  const Index apex = farthest(normal, own);
  if (apex == kNone) return open_window(center + radius * normal);
  std::vector<Index> cut_faces;
  for (const double height : kCutHeights) {
    const auto rim = rim_around(tip_region(apex, center, normal, height * radius, own), cut_faces);
    if (!rim.empty()) return take(rim, cut_faces);
  }
  const auto rim = rim_around({apex}, cut_faces);
  return rim.empty() ? open_window(vertices_[apex]) : take(rim, cut_faces);
}

Index DiscCutter::farthest(const Vec3& normal, const std::vector<Index>& own) const {
  Index apex = kNone;
  for (const Index v : own) {
    const bool whole = std::none_of(faces_of_[v].begin(), faces_of_[v].end(), [&](Index f) { return cut_[f]; });
    if (whole && (apex == kNone || vertices_[v].dot(normal) > vertices_[apex].dot(normal))) apex = v;
  }
  return apex;
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

std::vector<Index> DiscCutter::rim_around(const std::vector<Index>& region, std::vector<Index>& cut_faces) const {
  cut_faces.clear();
  for (const Index v : region) cut_faces.insert(cut_faces.end(), faces_of_[v].begin(), faces_of_[v].end());
  std::sort(cut_faces.begin(), cut_faces.end());
  cut_faces.erase(std::unique(cut_faces.begin(), cut_faces.end()), cut_faces.end());
  std::vector<Index> corners;
  std::set<std::pair<Index, Index>> edges;  // directed
  for (const Index f : cut_faces) {
    if (cut_[f]) return {};
    for (int i = 0; i < 3; ++i) {
      corners.push_back(faces_[f][i]);
      edges.emplace(faces_[f][i], faces_[f][(i + 1) % 3]);
    }
  }
  std::map<Index, Index> next;
  for (const auto& [from, to] : edges) {
    if (edges.count({to, from})) continue;
    if (!next.emplace(from, to).second) return {};  // the rim touches itself
  }
  if (next.size() < 3) return {};
  std::vector<Index> rim = {next.begin()->first};
  for (Index v = next.begin()->second; v != rim.front(); v = next.at(v)) rim.push_back(v);
  // One rim, and as many faces as a disc with these vertices has.
  std::sort(corners.begin(), corners.end());
  const auto vertex_count = static_cast<std::size_t>(std::unique(corners.begin(), corners.end()) - corners.begin());
  if (rim.size() != next.size() || cut_faces.size() != 2 * vertex_count - rim.size() - 2) return {};
  return rim;
}

std::vector<Index> DiscCutter::take(const std::vector<Index>& rim, const std::vector<Index>& cut_faces) {
  for (const Index f : cut_faces) cut_[f] = 1;
  return rim;
}

std::vector<Index> DiscCutter::open_window(const Vec3& near) {
  const auto center = [&](Index f) -> Vec3 {
    return (vertices_[faces_[f][0]] + vertices_[faces_[f][1]] + vertices_[faces_[f][2]]) / 3;
  };
  Index best = kNone;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (cut_[f]) continue;
    if (best == kNone || (center(f) - near).squaredNorm() < (center(best) - near).squaredNorm()) best = f;
  }
  const Triangle outer = faces_[best];
  std::vector<Index> window;
  for (const Index v : outer) {
    window.push_back(static_cast<Index>(vertices_.size()));
    vertices_.push_back(0.5 * (vertices_[v] + center(best)));
    source_.push_back(source_[v]);
    faces_of_.emplace_back();
  }
  const auto add = [&](const Triangle& face) {
    for (const Index v : face) faces_of_[v].push_back(static_cast<Index>(faces_.size()));
    faces_.push_back(face);
    cut_.push_back(0);
  };
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    add({outer[i], outer[next], window[i]});
    add({outer[next], window[next], window[i]});
  }
  return take(window, {best});
}

std::vector<Triangle> DiscCutter::rest() const {
  std::vector<Triangle> result;
  for (Index f = 0; f < faces_.size(); ++f) {
    if (!cut_[f]) result.push_back(faces_[f]);
  }
  return result;
}

}  // namespace vmesh
