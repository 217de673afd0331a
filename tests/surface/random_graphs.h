#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

#include "draw.h"

namespace vmesh::testing {

/// Random parameters that make guided growth hard.
enum class GraphKind {
  crowded_tree,
  shallow_siblings,
  ring_with_chords,
  parallel_branches,
  forest,
  random_loops,
  star,
  loose_tree
};
constexpr int kGraphKinds = 8;

class RandomGraph {
 public:
  RandomGraph(std::uint32_t seed, GraphKind kind) : draw_(seed) {
    switch (kind) {
      case GraphKind::crowded_tree:
        walk({4 + draw_.below(10), 0.3, 2.5, 1.0, 0.4, 0.3, 1.2});
        break;
      case GraphKind::shallow_siblings:
        siblings();
        break;
      case GraphKind::ring_with_chords:
        ring();
        break;
      case GraphKind::parallel_branches:
        parallel();
        break;
      case GraphKind::forest:
        walk({3 + draw_.below(8), 1, 6, 0.6, 0.3, 0.3, 1.2});
        walk({1 + draw_.below(8), 1, 6, 0.6, 0.3, 0.3, 1.2, {60, 0, 0}});
        if (draw_.chance(0.5)) add({0, 60, 0}, draw_.uniform(0.1, 3));
        break;
      case GraphKind::random_loops:
        walk({3 + draw_.below(10), 0.5, 5, 0.8, 0.5, 0.05, 2});
        for (int i = 0; i < 2; ++i) link(any_node(), any_node());
        break;
      case GraphKind::star:
        star();
        break;
      case GraphKind::loose_tree:
        walk({6 + draw_.below(12), 2, 8, 0.5, 0.35, 0.2, 1.5});
    }
  }

  Centerline build() const { return Centerline(nodes_, segments_); }

 private:
  struct Walk {
    Index count;
    double shortest, longest;  // steps, in radii
    double turn, branching;
    double thinnest, widest;
    Vec3 from = Vec3::Zero();
  };

  Index add(const Vec3& position, double radius, Index from = kNone) {
    nodes_.push_back({position, radius});
    const auto n = static_cast<Index>(nodes_.size() - 1);
    if (from != kNone) link(from, n);
    return n;
  }

  void link(Index a, Index b) {
    if (a != b && edges_.insert(std::minmax(a, b)).second) segments_.push_back({a, b});
  }

  Index any_node() { return draw_.below(static_cast<Index>(nodes_.size())); }

  void walk(const Walk& w) {
    const auto first = static_cast<Index>(nodes_.size());
    add(w.from, draw_.uniform(w.thinnest, w.widest));
    std::vector<Vec3> ways = {draw_.direction()};
    for (Index i = 1; i < w.count; ++i) {
      const Index from = draw_.chance(w.branching) ? draw_.below(i) : i - 1;
      const Vec3 way = (ways[from] + w.turn * draw_.direction()).normalized();
      const CenterlineNode start = nodes_[first + from];
      const double radius = std::clamp(start.radius * draw_.uniform(0.7, 1.2), w.thinnest, w.widest);
      add(start.position + radius * draw_.uniform(w.shortest, w.longest) * way, radius, first + from);
      ways.push_back(way);
    }
  }

  void siblings() {
    const Index fork = add({0, 0, 0}, 1);
    add({-draw_.uniform(2, 6), 0, 0}, 1, fork);
    const Index count = 2 + draw_.below(3);
    for (Index i = 0; i < count; ++i) {
      const double angle = draw_.uniform(0.05, 0.6), around = 2.4 * i;
      const Vec3 way(std::cos(angle), std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around));
      const double radius = draw_.uniform(0.3, 1), length = draw_.uniform(6, 16);
      Index last = fork;
      for (double s = 0; s < length;) {
        s += draw_.uniform(0.5, 3);
        last = add(s * way, radius, last);
      }
    }
  }

  void ring() {
    const Index count = 3 + draw_.below(12);
    const double size = draw_.uniform(0.5, 6);
    for (Index i = 0; i < count; ++i) {
      const double angle = 2 * M_PI * i / count;
      const double z = draw_.uniform(-0.3, 0.3);
      add({size * std::cos(angle), size * std::sin(angle), z}, draw_.uniform(0.3, 1));
    }
    for (Index i = 0; i < count; ++i) link(i, (i + 1) % count);
    if (draw_.chance(0.6)) link(draw_.below(count), draw_.below(count));
    if (draw_.chance(0.6)) {
      const Index from = draw_.below(count);
      add(draw_.uniform(1.5, 3) * nodes_[from].position + Vec3(0, 0, 1), 0.5, from);
    }
  }

  void parallel() {
    const double length = draw_.uniform(2, 12);
    const Index begin = add({0, 0, 0}, 1), end = add({length, 0, 0}, 1);
    add({-4, 0, 0}, 1, begin);
    if (draw_.chance(0.5)) add({length + 4, 0, 0}, 1, end);
    const Index count = 2 + draw_.below(2);
    for (Index i = 0; i < count; ++i) {
      const double height = draw_.uniform(0.1, 4), angle = 2 * M_PI * i / count + draw_.uniform(0, 0.5);
      Index last = begin;
      for (const double x : {0.25, 0.5, 0.75}) {
        const double off = height * std::sin(M_PI * x);
        last = add({length * x, off * std::cos(angle), off * std::sin(angle)}, draw_.uniform(0.2, 0.8), last);
      }
      link(last, end);
    }
  }

  void star() {
    const Index middle = add({0, 0, 0}, draw_.uniform(0.3, 2));
    const Index count = 3 + draw_.below(18);
    for (Index i = 0; i < count; ++i) {
      const Vec3 way = draw_.direction();
      const double length = draw_.uniform(3, 9);
      add(length * way, draw_.uniform(0.2, 0.8), middle);
    }
  }

  Draw draw_;
  std::vector<CenterlineNode> nodes_;
  std::vector<CenterlineSegment> segments_;
  std::set<std::pair<Index, Index>> edges_;
};

inline Centerline random_graph(std::uint32_t seed) {
  return RandomGraph(seed, static_cast<GraphKind>(seed % kGraphKinds)).build();
}

}  // namespace vmesh::testing
