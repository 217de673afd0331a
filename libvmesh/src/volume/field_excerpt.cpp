// Taking an excerpt of a VesselField, and making a field of it.
#include "vmesh/volume/field_excerpt.h"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <tuple>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw InvalidInput(std::string("an excerpt of a field does not fit together: ") + what);
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

void VesselField::throw_incomplete(Index cone) {
  throw std::logic_error("an excerpt of a field was asked beyond its reach, at cone " + std::to_string(cone));
}

std::vector<Index> VesselField::near_boxes(std::span<const Index> cones, double reach) const {
  std::vector<Index> near;
  for (const Index c : cones) {
    const Cone& cone = cones_[c];
    const double around = (1 + reach) * max_radius(c);
    const Vec3 end = cone.origin + cone.axis;
    tree_.visit_overlapping(cone.origin.cwiseMin(end).array() - around, cone.origin.cwiseMax(end).array() + around,
                            [&](Index item) { near.push_back(cone_of_item_[item]); });
  }
  sort_unique(near);
  return near;
}

FieldExcerpt VesselField::excerpt(std::span<const Index> cones, double reach) const {
  std::vector<Index> hints;
  for (const Index c : cones) {
    const auto local = local_cones(c);
    hints.insert(hints.end(), local.begin(), local.end());
  }
  sort_unique(hints);

  FieldExcerpt result;
  result.blend = blend_;
  result.cone = near_boxes(cones, reach);
  for (const Index c : hints) {
    const auto local = local_cones(c);
    result.cone.insert(result.cone.end(), local.begin(), local.end());
  }
  sort_unique(result.cone);
  for (const Index c : result.cone) {
    result.node.push_back(cones_[c].a);
    result.node.push_back(cones_[c].b);
  }
  sort_unique(result.node);

  for (const Index n : result.node) result.nodes.push_back(centerline_->node(n));
  result.local_offsets.push_back(0);
  for (const Index c : result.cone) {
    const Cone& cone = cones_[c];
    if (c < centerline_->segments().size())
      result.segments.push_back({place_in(result.node, cone.a), place_in(result.node, cone.b)});
    result.run.push_back(runs_[c].number);
    result.travel.push_back(runs_[c].travel);
    result.rounding.push_back({cone.rounding0, cone.rounding1});
    result.complete.push_back(std::binary_search(hints.begin(), hints.end(), c));
    for (Index k = local_offsets_[c]; result.complete.back() && k < local_offsets_[c + 1]; ++k) {
      result.local.push_back(place_in(result.cone, local_[k]));
      result.parting.push_back(is_parting_[k]);
    }
    result.local_offsets.push_back(static_cast<Index>(result.local.size()));
  }
  for (const Index c : result.cone) {
    if (!cones_[c].is_apart) continue;
    const Index i = place_in(result.cone, c);
    for (auto it = std::lower_bound(apart_.begin(), apart_.end(), std::pair(c, Index{0}));
         it != apart_.end() && it->first == c; ++it) {
      const Index j = place_in(result.cone, it->second);
      if (j != kNone) result.apart.emplace_back(i, j);
    }
  }
  return result;
}

VesselField::VesselField(const Centerline& centerline, const FieldExcerpt& excerpt)
    : centerline_(&centerline), blend_(excerpt.blend) {
  check(excerpt);
  make_cones();
  require(cones_.size() == excerpt.cone.size(), "its isolated nodes");
  for (Index c = 0; c < cones_.size(); ++c) {
    runs_.push_back({excerpt.run[c], excerpt.travel[c]});
    cones_[c].rounding0 = excerpt.rounding[c][0];
    cones_[c].rounding1 = excerpt.rounding[c][1];
  }
  measure_spheres();
  local_offsets_ = excerpt.local_offsets;
  local_ = excerpt.local;
  is_parting_ = excerpt.parting;
  complete_ = excerpt.complete;
  apart_ = excerpt.apart;
  for (const auto& [i, j] : apart_) cones_[i].is_apart = cones_[j].is_apart = true;
  build_tree();
  lonely_.assign(cones_.size(), not_asked);
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
  std::sort(result.apart.begin(), result.apart.end());
  result.apart.erase(std::unique(result.apart.begin(), result.apart.end()), result.apart.end());
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
