#include "surface/tubes/elongation_profile.h"

#include <algorithm>
#include <cmath>

#include "surface/remesh/edge_lengths.h"
#include "surface/tubes/vessel_rings.h"

namespace vmesh {
namespace {

constexpr double kGrowth = 0.405;        // derived: logarithm of 1.5, of the growth from one ring to the next
constexpr double kAtDock = 1.5;          // the most at a junction: the rings there are graded in its bare stretches
constexpr double kCoarser = 1.15;        // from one elongation that is tried to the next
constexpr double kMostSag = 0.25;        // radii: whatever the limit, so that the axis stays inside
constexpr double kLeftForBends = 0.8;    // of what edges across leave of the limit
constexpr double kFlatSlope = 1e-6;      // derived: below it, linear samples count as equal
constexpr double kOneElongation = 1e-9;  // derived: what exceeds 1 by less is rounding

// How far what is straight between two rings may be from the vessel: as far as edges across cut off, or what balanced
// edges across leave of the limit. Balanced, half of that is outside.
double most_sag(double radius, const RingOptions& options) {
  const double edge = edge_length_per_radius(options.around) * radius, most = kMostSag * radius;
  if (!options.limit.is_set()) return std::min(edge * edge / (8 * radius), most);
  const double limit = options.limit.at(radius);
  const double across = std::min(edge, edge_length_for(limit, radius));
  return std::min(2 * kLeftForBends * (limit - across * across / (16 * radius)), most);
}

// What a branch deviates from straight bands between two places.
class SagSearch {
 public:
  SagSearch(const BranchAxis& axis, std::span<const Ring> run) : axis_(axis) {
    double last = -1;
    for (const Ring& ring : run) {
      add_nodes(last, ring.place);
      last = ring.place;
      double farthest = 0;
      for (const RingPoint& p : ring.points) farthest = std::max(farthest, (p.position - ring.center).norm());
      samples_.push_back({ring.place, ring.center, std::max(farthest, ring.radius)});
    }
  }

  double sag(double from, double to) const {
    const Sample a = at(from), b = at(to);
    const auto before = [](const Sample& s, double place) { return s.place < place; };
    auto it = std::lower_bound(samples_.begin(), samples_.end(), from, before);
    double worst = 0;
    for (; it != samples_.end() && it->place < to; ++it) {
      const double share = (it->place - from) / (to - from);
      worst = std::max(worst, (it->position - (a.position + share * (b.position - a.position))).norm() +
                                  std::abs(it->radius - (a.radius + share * (b.radius - a.radius))));
    }
    return worst;
  }

 private:
  struct Sample {
    double place;
    Vec3 position;
    double radius;  // of the wall, at its farthest
  };

  // Those of the branch between two places.
  void add_nodes(double from, double to) {
    if (from < 0) return;
    const std::size_t count = axis_.branch().nodes.size();
    for (; node_ < count && axis_.node_place(node_) < to; ++node_) {
      const double place = axis_.node_place(node_);
      if (place <= from) continue;
      const auto point = axis_.at(place);
      samples_.push_back({place, point.position, point.radius});
    }
  }

  Sample at(double place) const {
    const auto before = [](const Sample& s, double p) { return s.place < p; };
    const auto it = std::lower_bound(samples_.begin(), samples_.end(), place, before);
    if (it == samples_.begin()) return *it;
    if (it == samples_.end()) return samples_.back();
    const Sample &a = *(it - 1), &b = *it;
    const double share = (place - a.place) / (b.place - a.place);
    return {place, a.position + share * (b.position - a.position), a.radius + share * (b.radius - a.radius)};
  }

  const BranchAxis& axis_;
  std::size_t node_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace

void ElongationProfile::add(double radii, double elongation) {
  radii_.push_back(radii);
  elongation_.push_back(elongation);
}

void ElongationProfile::append(const ElongationProfile& next, double fade) {
  if (next.elongation_.front() > 1) {
    double before = next.radii_.front() - fade;
    if (!radii_.empty() && before <= radii_.back()) {
      // Halfway to the last sample that is not a fade.
      if (elongation_.back() == 1 && radii_.size() > 1) radii_.pop_back(), elongation_.pop_back();
      before = 0.5 * (radii_.back() + next.radii_.front());
    }
    add(before, 1);
  }
  radii_.insert(radii_.end(), next.radii_.begin(), next.radii_.end());
  elongation_.insert(elongation_.end(), next.elongation_.begin(), next.elongation_.end());
  if (elongation_.back() > 1) add(radii_.back() + fade, 1);
}

double ElongationProfile::at(double radii) const {
  const auto above = std::upper_bound(radii_.begin(), radii_.end(), radii);
  if (above == radii_.begin() || above == radii_.end()) return 1;
  const auto i = static_cast<std::size_t>(above - radii_.begin());
  const double share = (radii - radii_[i - 1]) / (radii_[i] - radii_[i - 1]);
  return elongation_[i - 1] + share * (elongation_[i] - elongation_[i - 1]);
}

std::vector<double> ElongationProfile::spread(double step) const {
  // Rings up to every sample: the integral of d radii / (step * elongation).
  std::vector<double> rings = {0};
  for (std::size_t i = 1; i < radii_.size(); ++i) {
    const double way = (radii_[i] - radii_[i - 1]) / step, rise = elongation_[i] - elongation_[i - 1];
    const double mean =
        std::abs(rise) < kFlatSlope ? elongation_[i] : rise / std::log(elongation_[i] / elongation_[i - 1]);
    rings.push_back(rings.back() + way / mean);
  }
  const double bands = std::max(1.0, std::round(rings.back()));
  std::vector<double> places;
  std::size_t i = 1;
  for (double k = 0; k < bands; ++k) {
    const double until = rings.back() * k / bands;
    while (i + 1 < rings.size() && rings[i] < until) ++i;
    const double way = radii_[i] - radii_[i - 1], slope = step * (elongation_[i] - elongation_[i - 1]) / way;
    const double rest = until - rings[i - 1];
    const double along = std::abs(slope) < kFlatSlope ? step * elongation_[i - 1] * rest
                                                      : step * elongation_[i - 1] * std::expm1(slope * rest) / slope;
    places.push_back(radii_[i - 1] + std::clamp(along, 0.0, way));
  }
  places.push_back(radii_.back());
  return places;
}

ElongationProfile elongation_of_run(const BranchAxis& axis, std::span<const Ring> run, double step,
                                    const RingOptions& options) {
  const SagSearch search(axis, run);
  const std::size_t count = run.size();
  std::vector<double> radii, elongation;
  for (const Ring& ring : run) radii.push_back(axis.radii_of(ring.place));
  if (axis.periodic()) {
    for (std::size_t k = 1; k < count; ++k) {
      if (radii[k] < radii[k - 1]) radii[k] += axis.length_in_radii();
    }
  }
  // A ring at a tip is followed by a cap.
  const bool from_tip = axis.starts_at_tip() && radii.front() <= 0;
  const bool to_tip = axis.ends_at_tip() && radii.back() >= axis.length_in_radii();
  for (std::size_t k = 0; k < count; ++k) {
    const double most = most_sag(run[k].radius, options);
    const double from_first = (from_tip ? 1 : kAtDock) + kGrowth * static_cast<double>(k);
    const double from_last = (to_tip ? 1 : kAtDock) + kGrowth * static_cast<double>(count - 1 - k);
    double times = std::min({options.elongation, from_first, from_last});
    if (options.ring_per_node) times = std::min(times, axis.shortest_at(run[k].place) / (step * run[k].radius));
    const auto sag = [&] {
      const double reach = times * step / 2;
      const double from = std::max(radii.front(), radii[k] - reach), to = std::min(radii.back(), radii[k] + reach);
      return search.sag(axis.place_at_radii(from), axis.place_at_radii(to));
    };
    while (times > 1 && sag() > most) times /= kCoarser;
    elongation.push_back(std::max(1.0, times));
  }
  for (std::size_t k = 1; k < count; ++k) elongation[k] = std::min(elongation[k], elongation[k - 1] + kGrowth);
  for (std::size_t k = count - 1; k-- > 0;) elongation[k] = std::min(elongation[k], elongation[k + 1] + kGrowth);
  ElongationProfile profile;
  for (std::size_t k = 0; k < count; ++k)
    profile.add(radii[k], elongation[k] > 1 + kOneElongation ? elongation[k] : 1.0);
  return profile;
}

}  // namespace vmesh
