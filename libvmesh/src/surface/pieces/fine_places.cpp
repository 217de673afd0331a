#include "surface/pieces/fine_places.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace vmesh {
namespace {

struct Draw {
  double edge;   // of the square root of limit times radius, which edges of even surfaces have about 3.5 times
  double reach;  // radii
};
constexpr Draw kDraws[] = {{1.5, 1.5}, {2, 2}, {1.2, 1.5}, {2.5, 2.5}, {1.5, 2.5},
                           {1.8, 1.2}, {1, 2}, {3, 3},     {1.3, 1},   {2.2, 1.5}};

}  // namespace

bool FinePlaces::draw(const std::vector<UnprovenPlace>& unproven) {
  const std::size_t known = places_.size();
  std::vector<char> is_drawn(known, 0);
  bool any = false;
  for (const UnprovenPlace& place : unproven) {
    const auto it = std::find_if(places_.begin(), places_.end(),
                                 [&](const FinePlace& p) { return (place.position - p.center).norm() < p.reach; });
    const auto number = static_cast<std::size_t>(it - places_.begin());
    if (it == places_.end()) {
      add(place.position);
      any = true;
    } else if (number < known && !std::exchange(is_drawn[number], char{1}) && draws_[number] + 1 < std::size(kDraws)) {
      ++draws_[number];
      take_draw(number);
      any = true;
    }
  }
  return any;
}

void FinePlaces::add(const Vec3& center) {
  places_.push_back({center, 0, 0});
  draws_.push_back(0);
  take_draw(places_.size() - 1);
}

void FinePlaces::take_draw(std::size_t place) {
  FinePlace& at = places_[place];
  const Draw& draw = kDraws[draws_[place]];
  const FieldSample s = field_->sample_global(at.center);
  const double radius = field_->relations().radius_at(s.cone, s.t);
  at.reach = draw.reach * radius;
  at.edge = draw.edge * std::sqrt(limit_.at(radius) * radius);
}

}  // namespace vmesh
