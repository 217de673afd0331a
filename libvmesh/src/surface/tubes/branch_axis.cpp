#include "surface/tubes/branch_axis.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr double kFlat = 1e-9;  // derived: relative taper below which the angle of a cone is lost in rounding

// Integral of ds / r over a segment whose radius runs from r0 to r1.
double radii_along(double length, double r0, double r1) {
  const double taper = (r1 - r0) / r0;
  return std::abs(taper) < kFlat ? length / r0 : length * std::log1p(taper) / (r1 - r0);
}

}  // namespace

BranchAxis::BranchAxis(const Centerline& centerline, const Branch& branch)
    : centerline_(&centerline),
      branch_(&branch),
      periodic_(is_loop(centerline, branch)),
      starts_at_tip_(centerline.degree(branch.nodes.front()) == 1),
      ends_at_tip_(centerline.degree(branch.nodes.back()) == 1),
      places_(1, 0),
      radii_(1, 0) {
  for (std::size_t i = 0; i < branch.segments.size(); ++i) {
    const double length = centerline.length(branch.segments[i]);
    const double r0 = centerline.node(branch.nodes[i]).radius, r1 = centerline.node(branch.nodes[i + 1]).radius;
    places_.push_back(places_.back() + length);
    radii_.push_back(radii_.back() + radii_along(length, r0, r1));
  }
}

bool BranchAxis::reversed(std::size_t nth) const {
  return centerline_->segment(branch_->segments[nth]).a != branch_->nodes[nth];
}

BranchAxis::Point BranchAxis::at(double place) const {
  if (periodic_) place -= length() * std::floor(place / length());
  place = std::clamp(place, 0.0, length());
  const auto above = std::upper_bound(places_.begin(), places_.end(), place);
  const std::size_t nth = std::min<std::size_t>(above - places_.begin(), branch_->segments.size()) - 1;
  const double along = (place - places_[nth]) / (places_[nth + 1] - places_[nth]);
  const double t = std::clamp(reversed(nth) ? 1 - along : along, 0.0, 1.0);
  const Index s = branch_->segments[nth];
  return {nth, t, centerline_->point_at(s, t), centerline_->radius_at(s, t)};
}

Vec3 BranchAxis::direction(double place, double reach) const {
  if (periodic_) reach = std::min(reach, length() / 4);
  const Vec3 chord = at(place + reach).position - at(place - reach).position;
  const double norm = chord.norm();
  if (norm > 0.1 * reach) return chord / norm;
  const std::size_t nth = at(place).nth;  // a hairpin
  return (centerline_->node(branch_->nodes[nth + 1]).position - centerline_->node(branch_->nodes[nth]).position)
      .normalized();
}

double BranchAxis::place_of(std::size_t nth, double t) const {
  const double along = reversed(nth) ? 1 - t : t;
  return places_[nth] + along * (places_[nth + 1] - places_[nth]);
}

double BranchAxis::apart(double place, double other) const {
  const double distance = std::abs(place - other);
  return periodic_ ? std::min(distance, length() - distance) : distance;
}

double BranchAxis::shortest_at(double place) const {
  const std::size_t nth = at(place).nth;
  const auto length_of = [&](std::size_t i) { return places_[i + 1] - places_[i]; };
  double shortest = length_of(nth);
  if (place <= places_[nth] && nth > 0) shortest = std::min(shortest, length_of(nth - 1));
  if (place >= places_[nth + 1] && nth + 2 < places_.size()) shortest = std::min(shortest, length_of(nth + 1));
  return shortest;
}

double BranchAxis::radii_of(double place) const {
  const Point point = at(place);
  if (periodic_) place -= length() * std::floor(place / length());
  const double along = std::clamp(place, 0.0, length()) - places_[point.nth];
  return along > 0
             ? radii_[point.nth] + radii_along(along, centerline_->node(branch_->nodes[point.nth]).radius, point.radius)
             : radii_[point.nth];
}

double BranchAxis::place_at_radii(double radii) const {
  radii = std::clamp(radii, 0.0, radii_.back());
  const auto above = std::upper_bound(radii_.begin(), radii_.end(), radii);
  const std::size_t nth = std::min<std::size_t>(above - radii_.begin(), branch_->segments.size()) - 1;
  const double r0 = centerline_->node(branch_->nodes[nth]).radius;
  const double r1 = centerline_->node(branch_->nodes[nth + 1]).radius;
  const double length = places_[nth + 1] - places_[nth], slope = (r1 - r0) / length;
  const double rest = radii - radii_[nth];
  const double along = std::abs(r1 - r0) < kFlat * r0 ? rest * r0 : r0 * std::expm1(slope * rest) / slope;
  return places_[nth] + std::clamp(along, 0.0, length);
}

}  // namespace vmesh
