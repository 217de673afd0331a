#include "edge_radii.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vmesh::io {
namespace {

/// Radii of nodes from those of the segments at them.
void set_radii_of_nodes(RawCenterline& raw, const std::vector<double>& radius) {
  std::vector<std::array<double, 2>> thickest(raw.nodes.size(), {0, 0});  // and second
  for (std::size_t s = 0; s < raw.segments.size(); ++s) {
    for (const Index n : {raw.segments[s].a, raw.segments[s].b}) {
      auto& [first, second] = thickest[n];
      second = std::max(second, std::min(first, radius[s]));
      first = std::max(first, radius[s]);
    }
  }
  for (std::size_t n = 0; n < raw.nodes.size(); ++n)
    raw.nodes[n].radius = thickest[n][1] > 0 ? thickest[n][1] : thickest[n][0];
}

/// Rebuilds the segments, with nodes added where the radius changes.
class Divider {
 public:
  explicit Divider(RawCenterline& raw) : raw_(raw), old_(std::move(raw.segments)), numbers_(raw.segment_numbers) {
    raw_.segments.clear();
    raw_.segment_numbers.clear();
    if (raw_.node_numbers.empty()) {
      for (std::size_t n = 0; n < raw_.nodes.size(); ++n) raw_.node_numbers.push_back(n);
    }
  }

  void run(const std::vector<double>& radius) {
    std::size_t path = 0;
    for (std::size_t s = 0; s < old_.size(); ++s) {
      const auto first = static_cast<Index>(raw_.segments.size());
      while (path < raw_.path_starts.size() && raw_.path_starts[path] == s) raw_.path_starts[path++] = first;
      divide(old_[s], radius[s], s < numbers_.size() ? numbers_[s] : s);
    }
  }

 private:
  void divide(const CenterlineSegment& segment, double radius, std::uint64_t number) {
    const CenterlineNode a = raw_.nodes[segment.a], b = raw_.nodes[segment.b];
    const double length = (b.position - a.position).norm();
    const double from_a = differs(a.radius, radius) ? a.radius : 0, from_b = differs(b.radius, radius) ? b.radius : 0;
    Index last = segment.a;
    const auto add = [&](double distance, Index like) {
      const Vec3 position = a.position + distance / length * (b.position - a.position);
      raw_.nodes.push_back({position, radius});
      raw_.node_numbers.push_back(raw_.node_numbers[like]);
      const auto node = static_cast<Index>(raw_.nodes.size() - 1);
      join(last, node, number);
      last = node;
    };
    if (std::isfinite(length) && length > 0 && from_a + from_b > 0) {
      if (from_a + from_b < length) {
        if (from_a > 0) add(from_a, segment.a);
        if (from_b > 0) add(length - from_b, segment.b);
      } else {
        add(length / 2, segment.a);
      }
    }
    join(last, segment.b, number);
  }

  void join(Index a, Index b, std::uint64_t number) {
    raw_.segments.push_back({a, b});
    raw_.segment_numbers.push_back(number);
  }

  static bool differs(double at_node, double radius) {
    constexpr double kSame = 1e-6;
    return std::isfinite(radius) && radius > 0 && std::abs(at_node - radius) > kSame * radius;
  }

  RawCenterline& raw_;
  const std::vector<CenterlineSegment> old_;
  const std::vector<std::uint64_t> numbers_;
};

}  // namespace

void set_radii_of_segments(RawCenterline& raw, const std::vector<double>& radius) {
  set_radii_of_nodes(raw, radius);
  Divider(raw).run(radius);
}

}  // namespace vmesh::io
