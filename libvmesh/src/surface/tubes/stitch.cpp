#include "surface/tubes/stitch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmesh {
namespace {

constexpr std::size_t kStarts = 6;    // places from which a band is tried; idle 4 to 8
constexpr double kTie = 1 - 1e-9;     // derived: ratio of two values from which on they are equal up to rounding
constexpr double kSurely = 1 + 1e-6;  // derived: ratio from which on one is longer, ties on the way included

// Shortest path through the grid of pairs (bottom i, top j) from (0, start) once around both loops.
class BandSearch {
 public:
  BandSearch(std::span<const Vec3> bottom, std::span<const Vec3> top)
      : bottom_(bottom), top_(top), cost_((bottom.size() + 1) * (top.size() + 1)), from_bottom_(cost_.size()) {}

  // Infinite if no path is shorter than `enough`. Pairs that only longer ones lead through are not looked at.
  double run(std::size_t first, std::size_t start, double enough = kInfinite) {
    first_ = first;
    start_ = start;
    const double most = kSurely * std::min(enough, greedy_cost());
    std::size_t begin = 0, end = top_.size() + 1;  // of the pairs worth it in the row before
    for (std::size_t i = 0; i <= bottom_.size(); ++i) {
      std::size_t first_worth = kNoPair, last_worth = 0;
      double via_top = kInfinite;
      for (std::size_t j = begin; j <= top_.size(); ++j) {
        const double via_bottom = i > 0 && j < end ? cost(i - 1, j) : kInfinite;
        if (j >= end && via_top == kInfinite) break;
        const double edge = i + j == 0 ? 0 : in_step(i, j) ? (low(i) - high(j)).squaredNorm() : kInfinite;
        from_bottom_[at(i, j)] = via_bottom < kTie * via_top;
        double here = i + j == 0 ? 0 : std::min(via_bottom, via_top) + edge;
        if (here > most) here = kInfinite;
        cost_[at(i, j)] = via_top = here;
        if (here == kInfinite) continue;
        first_worth = std::min(first_worth, j);
        last_worth = j;
      }
      if (first_worth == kNoPair) return kInfinite;
      begin = first_worth;
      end = last_worth + 1;
    }
    return end > top_.size() ? cost_.back() : kInfinite;
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
  static constexpr std::size_t kNoPair = std::numeric_limits<std::size_t>::max();

  // Of the path that takes the shorter of both next edges each time.
  double greedy_cost() const {
    double sum = 0;
    for (std::size_t i = 0, j = 0; i < bottom_.size() || j < top_.size();) {
      const auto edge = [&](std::size_t k, std::size_t l) {
        return k <= bottom_.size() && l <= top_.size() && in_step(k, l) ? (low(k) - high(l)).squaredNorm() : kInfinite;
      };
      const double at_bottom = edge(i + 1, j), at_top = edge(i, j + 1);
      sum += std::min(at_bottom, at_top);
      if (!(sum < kInfinite)) return kInfinite;  // nor for ever where a place is not a number
      ++(at_bottom < at_top ? i : j);
    }
    return sum;
  }

  // Neither loop may be walked all the way around while the other stands still: an edge would occur twice.
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

// The numbers of the kStarts nearest points, nearest first; ties (up to rounding) by number.
std::vector<std::size_t> nearest_of(std::span<const Vec3> points, const Vec3& p) {
  double farthest = 0;
  for (const Vec3& q : points) farthest = std::max(farthest, (q - p).squaredNorm());
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    order.emplace_back(std::round((points[i] - p).squaredNorm() / ((1 - kTie) * farthest)), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> nearest;
  for (std::size_t i = 0; i < std::min(order.size(), kStarts); ++i) nearest.push_back(order[i].second);
  return nearest;
}

}  // namespace

std::vector<Triangle> stitch(std::span<const Vec3> bottom, std::span<const Vec3> top) {
  std::size_t first = 0;
  for (std::size_t i = 1; i < bottom.size(); ++i) {
    if (distance2_to(top, bottom[i]) < kTie * distance2_to(top, bottom[first])) first = i;
  }
  BandSearch search(bottom, top);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t start : nearest_of(top, bottom[first])) {
    const double cost = search.run(first, start, least);
    if (cost < kTie * least) {
      least = cost;
      best = start;
    }
  }
  search.run(first, best);
  return search.faces();
}

}  // namespace vmesh
