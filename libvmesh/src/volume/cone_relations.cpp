#include "vmesh/volume/cone_relations.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "vmesh/core/error.h"
#include "vmesh/volume/field_excerpt.h"

#include "volume/fans.h"
#include "volume/rounded_over.h"
#include "volume/segment_locality_regions.h"

namespace vmesh {

ConeRelations::ConeRelations(const Centerline& centerline, double blend) : centerline_(&centerline), blend_(blend) {
  if (!(blend >= 0 && blend <= 2)) throw InvalidInput("blend must be in [0, 2]");
  find_isolated();
  measure_runs();
  find_local_cones();
}

void ConeRelations::find_isolated() {
  for (Index n = 0; n < centerline_->nodes().size(); ++n) {
    if (centerline_->degree(n) == 0) isolated_.push_back(n);
  }
}

void ConeRelations::measure_runs() {
  runs_.resize(centerline_->segments().size() + isolated_.size());
  for (Index c = 0; c < cone_count(); ++c) {
    const Index a = first_node(c), b = last_node(c);
    const bool continues = c > 0 && last_node(c - 1) == a && a != b;
    const Vec3 axis = centerline_->node(b).position - centerline_->node(a).position;
    const double travel = axis.norm() + (1 + 2 * blend_) * std::abs(radius_of(b) - radius_of(a));
    runs_[c].travel = (continues ? runs_[c - 1].travel : 0) + travel;
    runs_[c].number = c == 0 ? 0 : runs_[c - 1].number + !continues;
  }
}

void ConeRelations::find_local_cones() {
  const Fans fans(*centerline_);
  for (Index s = 0; !fans.empty() && s < centerline_->segments().size(); ++s) hub_of_.push_back(fans.hub_of(s));
  LocalityPairs locality = segment_locality_by_regions(*centerline_, blend_);
  apart_ = std::move(locality.apart);
  std::sort(apart_.begin(), apart_.end());
  rounding_ = std::move(locality.rounding);
  list_local_cones(locality.local, locality.parting);
  const auto more = rounded_over(*this);
  if (more.empty()) return;
  locality.parting.insert(locality.parting.end(), more.begin(), more.end());
  list_local_cones(locality.local, locality.parting);
}

void ConeRelations::list_local_cones(const std::vector<std::pair<Index, Index>>& local,
                                     const std::vector<std::pair<Index, Index>>& parting) {
  using Pairs = std::vector<std::pair<Index, Index>>;
  local_offsets_.assign(cone_count() + 1, 0);
  for (std::size_t c = 0; c < cone_count(); ++c) ++local_offsets_[c + 1];
  for (const Pairs* pairs : {&local, &parting}) {
    for (const auto& [i, j] : *pairs) {
      ++local_offsets_[i + 1];
      ++local_offsets_[j + 1];
    }
  }
  std::partial_sum(local_offsets_.begin(), local_offsets_.end(), local_offsets_.begin());
  std::vector<Index> next(local_offsets_.begin(), local_offsets_.end() - 1);
  const auto fill = [&](const Pairs& pairs, std::vector<Index>& lists) {
    for (const auto& [i, j] : pairs) {
      lists[next[i]++] = j;
      lists[next[j]++] = i;
    }
  };
  local_.resize(local_offsets_.back());
  for (Index c = 0; c < cone_count(); ++c) local_[next[c]++] = c;
  fill(local, local_);
  const std::vector<Index> first_parting = next;
  fill(parting, local_);
  is_parting_.assign(local_.size(), 0);
  std::vector<Index> partners;
  for (Index c = 0; c < cone_count(); ++c) {
    const auto end = local_.begin() + local_offsets_[c + 1];
    partners.assign(local_.begin() + first_parting[c], end);
    std::sort(partners.begin(), partners.end());
    std::sort(local_.begin() + local_offsets_[c], end);
    for (Index k = local_offsets_[c]; !partners.empty() && k < local_offsets_[c + 1]; ++k)
      is_parting_[k] = std::binary_search(partners.begin(), partners.end(), local_[k]);
  }
  row_.clear();
  if (!hub_of_.empty()) list_fans();
}

// Adds the segments of their fans to the lists of cones; those that have no others share one.
void ConeRelations::list_fans() {
  const std::vector<Index> offsets = std::move(local_offsets_), own = std::move(local_);
  const std::vector<char> own_parting = std::move(is_parting_);
  local_offsets_ = {0};
  local_.clear();
  is_parting_.clear();
  row_.assign(cone_count(), kNone);
  std::vector<Index> shared(centerline_->nodes().size(), kNone);  // rows of fans, by hub
  for (Index c = 0; c < cone_count(); ++c) {
    const Index hub = c < hub_of_.size() ? hub_of_[c] : kNone;
    const bool has_others = offsets[c + 1] - offsets[c] > 1;
    if (hub != kNone && !has_others && shared[hub] != kNone) {
      row_[c] = shared[hub];
      continue;
    }
    row_[c] = static_cast<Index>(local_offsets_.size() - 1);
    if (hub != kNone && !has_others) shared[hub] = row_[c];
    Index k = offsets[c];
    const auto add_own_below = [&](Index end) {
      for (; k < offsets[c + 1] && own[k] < end; ++k) {
        if (hub != kNone && own[k] == c) continue;  // it is in the fan
        local_.push_back(own[k]);
        is_parting_.push_back(own_parting[k]);
      }
    };
    if (hub != kNone) {
      for (const Index s : centerline_->incident_segments(hub)) {  // ascending
        if (hub_of_[s] != hub) continue;
        add_own_below(s);
        local_.push_back(s);
        is_parting_.push_back(0);
      }
    }
    add_own_below(kNone);
    local_offsets_.push_back(static_cast<Index>(local_.size()));
  }
}

bool ConeRelations::are_one_volume(Index i, Index j) const {
  if (are_in_one_fan(i, j)) return true;
  const auto local = local_cones(i);
  const auto place = std::lower_bound(local.begin(), local.end(), j);
  return place != local.end() && *place == j && !parting(i)[static_cast<std::size_t>(place - local.begin())];
}

void ConeRelations::throw_incomplete(Index cone) {
  throw std::logic_error("an excerpt of a field was asked beyond its reach, at cone " + std::to_string(cone));
}

}  // namespace vmesh
