// Taking an excerpt of a field without making that field, and making a field of the excerpt.
#include "vmesh/volume/field_excerpt.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"

namespace vmesh {
namespace {

constexpr double kExcerptRounding = 16 * std::numeric_limits<double>::epsilon();  // relative to coordinates: in a box
// Cones: a quarter of the memory of a tree with leaves of the usual size, and it is asked rarely.
constexpr Index kLeafSize = 16;

void require(bool holds, const char* what) {
  if (!holds) throw InvalidInput(std::string("an excerpt of a field is inconsistent: ") + what);
}

void check(const FieldExcerpt& e) {
  const std::size_t count = e.cone.size();
  const auto ascends = [](const std::vector<Index>& list) {
    return std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
  };
  require(ascends(e.node) && ascends(e.cone), "the order of its nodes and cones");
  require(e.segments.size() <= count &&
              std::all_of(e.segments.begin(), e.segments.end(),
                          [&](const auto& s) { return s.a < e.nodes.size() && s.b < e.nodes.size(); }),
          "its segments");
  require(e.blend >= 0 && e.blend <= 2, "its blend");
  require(e.run.size() == count && e.travel.size() == count && e.complete.size() == count &&
              e.rounding.size() == count && e.local_offsets.size() == count + 1 && e.node.size() == e.nodes.size(),
          "the number of its cones");
  require(e.local_offsets.front() == 0 && e.local_offsets.back() == e.local.size() &&
              std::is_sorted(e.local_offsets.begin(), e.local_offsets.end()) && e.parting.size() == e.local.size(),
          "its local cones");
  require(std::all_of(e.local.begin(), e.local.end(), [&](Index c) { return c < count; }), "its local cones");
  require(std::all_of(e.apart.begin(), e.apart.end(),
                      [&](const auto& p) { return p.first < p.second && p.second < count; }) &&
              std::is_sorted(e.apart.begin(), e.apart.end()),
          "its cones that are apart");
}

}  // namespace

FieldExcerpts::FieldExcerpts(const ConeRelations& relations)
    : relations_(relations),
      tree_(
          static_cast<Index>(relations.cone_count()), [&](Index c) { return box_of(c); }, kLeafSize) {}

// Holds all points at which the cone may be blended in, as in VesselField.
BoxTree::Box FieldExcerpts::box_of(Index c) const {
  const double around = (1 + 2 * relations_.blend()) * relations_.max_radius(c);
  const Vec3 begin = relations_.axis_point(c, 0), end = relations_.axis_point(c, 1);
  const double size = begin.cwiseAbs().cwiseMax(end.cwiseAbs()).maxCoeff() + around;
  const double margin = around + kExcerptRounding * size;
  return {begin.cwiseMin(end).array() - margin, begin.cwiseMax(end).array() + margin};
}

std::vector<Index> FieldExcerpts::near_boxes(std::span<const Index> cones, double reach) const {
  std::vector<Index> near;
  for (const Index c : cones) {
    const double around = (1 + reach) * relations_.max_radius(c);
    const Vec3 begin = relations_.axis_point(c, 0), end = relations_.axis_point(c, 1);
    const Vec3 low = begin.cwiseMin(end).array() - around, high = begin.cwiseMax(end).array() + around;
    tree_.visit_overlapping(low, high, [&](Index other) {
      if (box_of(other).overlaps(low, high)) near.push_back(other);
    });
  }
  sort_unique(near);
  return near;
}

FieldExcerpt FieldExcerpts::take(std::span<const Index> cones, double reach) const {
  std::vector<Index> hints;
  for (const Index c : cones) {
    const auto local = relations_.local_cones(c);
    hints.insert(hints.end(), local.begin(), local.end());
  }
  sort_unique(hints);

  FieldExcerpt result;
  result.blend = relations_.blend();
  result.cone = near_boxes(cones, reach);
  for (const Index c : hints) {
    const auto local = relations_.local_cones(c);
    result.cone.insert(result.cone.end(), local.begin(), local.end());
  }
  sort_unique(result.cone);
  for (const Index c : result.cone) {
    result.node.push_back(relations_.first_node(c));
    result.node.push_back(relations_.last_node(c));
  }
  sort_unique(result.node);

  const Centerline& centerline = relations_.centerline();
  for (const Index n : result.node) result.nodes.push_back(centerline.node(n));
  result.local_offsets.push_back(0);
  for (const Index c : result.cone) {
    const Index a = relations_.first_node(c), b = relations_.last_node(c);
    if (c < centerline.segments().size())
      result.segments.push_back({place_in(result.node, a), place_in(result.node, b)});
    result.run.push_back(relations_.run(c).number);
    result.travel.push_back(relations_.run(c).travel);
    result.rounding.push_back({relations_.rounding_of(a), relations_.rounding_of(b)});
    result.complete.push_back(std::binary_search(hints.begin(), hints.end(), c));
    if (result.complete.back()) {
      for (const Index local : relations_.local_cones(c)) result.local.push_back(place_in(result.cone, local));
      const auto parting = relations_.parting(c);
      result.parting.insert(result.parting.end(), parting.begin(), parting.end());
    }
    result.local_offsets.push_back(static_cast<Index>(result.local.size()));
  }
  const auto& apart = relations_.apart();
  for (Index i = 0; i < result.cone.size(); ++i) {
    const Index c = result.cone[i];
    for (auto it = std::lower_bound(apart.begin(), apart.end(), std::pair(c, Index{0}));
         it != apart.end() && it->first == c; ++it) {
      const Index j = place_in(result.cone, it->second);
      if (j != kNone) result.apart.emplace_back(i, j);
    }
  }
  return result;
}

ConeRelations::ConeRelations(const Centerline& centerline, const FieldExcerpt& excerpt)
    : centerline_(&centerline), blend_(excerpt.blend) {
  check(excerpt);
  find_isolated();
  const std::size_t count = centerline.segments().size() + isolated_.size();
  require(count == excerpt.cone.size(), "its isolated nodes");
  rounding_.assign(centerline.nodes().size(), 1);
  for (Index c = 0; c < count; ++c) {
    runs_.push_back({excerpt.run[c], excerpt.travel[c]});
    rounding_[first_node(c)] = excerpt.rounding[c][0];
    rounding_[last_node(c)] = excerpt.rounding[c][1];
  }
  local_offsets_ = excerpt.local_offsets;
  local_ = excerpt.local;
  is_parting_ = excerpt.parting;
  complete_ = excerpt.complete;
  apart_ = excerpt.apart;
}

FieldExcerpt merged(std::span<const FieldExcerpt> excerpts) {
  for (const FieldExcerpt& excerpt : excerpts) check(excerpt);
  struct Source {
    Index cone, excerpt, place;
    bool complete;
  };
  std::vector<Source> sources;
  FieldExcerpt result;
  for (Index e = 0; e < excerpts.size(); ++e) {
    const FieldExcerpt& excerpt = excerpts[e];
    result.blend = excerpt.blend;
    result.node.insert(result.node.end(), excerpt.node.begin(), excerpt.node.end());
    for (Index c = 0; c < excerpt.cone.size(); ++c)
      sources.push_back({excerpt.cone[c], e, c, excerpt.complete[c] != 0});
  }
  std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) {
    return std::tuple(a.cone, !a.complete, a.excerpt) < std::tuple(b.cone, !b.complete, b.excerpt);
  });
  const auto same = [](const Source& a, const Source& b) { return a.cone == b.cone; };
  sources.erase(std::unique(sources.begin(), sources.end(), same), sources.end());
  sort_unique(result.node);
  result.nodes.resize(result.node.size());
  for (const FieldExcerpt& excerpt : excerpts) {
    for (Index n = 0; n < excerpt.node.size(); ++n)
      result.nodes[place_in(result.node, excerpt.node[n])] = excerpt.nodes[n];
    for (const auto& [i, j] : excerpt.apart) result.apart.emplace_back(excerpt.cone[i], excerpt.cone[j]);
  }
  for (const Source& source : sources) result.cone.push_back(source.cone);
  for (auto& [i, j] : result.apart) {
    i = place_in(result.cone, i);
    j = place_in(result.cone, j);
  }
  sort_unique(result.apart);
  result.local_offsets.push_back(0);
  for (const auto& [cone, e, place, complete] : sources) {
    const FieldExcerpt& from = excerpts[e];
    if (place < from.segments.size()) {
      const auto [a, b] = from.segments[place];
      result.segments.push_back({place_in(result.node, from.node[a]), place_in(result.node, from.node[b])});
    }
    result.run.push_back(from.run[place]);
    result.travel.push_back(from.travel[place]);
    result.rounding.push_back(from.rounding[place]);
    result.complete.push_back(complete);
    for (Index k = from.local_offsets[place]; k < from.local_offsets[place + 1]; ++k) {
      result.local.push_back(place_in(result.cone, from.cone[from.local[k]]));
      result.parting.push_back(from.parting[k]);
    }
    result.local_offsets.push_back(static_cast<Index>(result.local.size()));
  }
  return result;
}

}  // namespace vmesh
