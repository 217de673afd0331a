#include "volume/moving.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "vmesh/core/ascending.h"

namespace vmesh {
namespace {

// A shift fades out over at least this number of radii, however small it is.
constexpr double kShortestFading = 2;  // safe 1.4 to 2.8

// Largest change of the total displacement per length: less than 1, so that an axis does not fold. Measured on three
// random walks of 500 to 2,000 nodes that cross themselves at every seventh node: 8 contacts are left at 0.8 with 8
// extensions and 16 rounds of moves, 1 at 0.95 with 24 and 40; on eleven such walks, 2 contacts.
constexpr double kSteepest = 0.95;  // idle 0.66 to 1.3

// Of a shift's distance: a smaller increase is not worth another round; idle 0.007 to 0.014.
constexpr double kLeastMore = 0.01;
constexpr int kMostExtensions = 24;  // of one shift; idle 17 to 34

// Falls from 1 at x = 0 to 0 at x = 1, with zero slope at both ends and slopes of at most 1.5.
double faded(double x) { return x >= 1 ? 0 : 1 - x * x * (3 - 2 * x); }
constexpr double kSteepestFading = 1.5;  // safe 1 to 2.1

}  // namespace

Moving::Moving(const Centerline& original, double slope) : original_(&original), slope_(slope) {
  auto offset = static_cast<Index>(original.nodes().size());
  for (Index s = 0; s < original.segments().size(); ++s) {
    leaf_counts_.push_back(leaf_count_of(original, s));
    offsets_.push_back(offset);
    offset += leaf_counts_[s] - 1;
    segments_.resize(offset - original.nodes().size(), s);
  }
}

Index Moving::add(Shift shift) {
  const auto number = static_cast<Index>(shifts_.size());
  shifts_.push_back(std::move(shift));
  parts_.emplace_back();
  fade(number);
  if (steepest_along(number) <= kSteepest) return number;
  remove(number);
  return kNone;
}

bool Moving::is_more(Index shift, double distance, const std::vector<MovedStretch>& stretches) const {
  if (distance > (1 + kLeastMore) * shifts_[shift].distance) return true;
  return std::ranges::any_of(stretches,
                             [&](const MovedStretch& stretch) { return part_at(shift, stretch) < 1 - kLeastMore; });
}

bool Moving::extend(Index shift, double distance, const std::vector<MovedStretch>& more) {
  if (shifts_[shift].extensions >= kMostExtensions || !is_more(shift, distance, more)) return false;
  const Shift shift_before = shifts_[shift];
  ++shifts_[shift].extensions;
  const std::map<Index, double> parts_before = parts_[shift];
  shifts_[shift].distance = std::max(shifts_[shift].distance, distance);
  shifts_[shift].stretches.insert(shifts_[shift].stretches.end(), more.begin(), more.end());
  fade(shift);
  if (steepest_along(shift) <= kSteepest) return true;
  shifts_[shift] = shift_before;
  parts_[shift] = parts_before;
  return false;
}

void Moving::remove(Index shift) {
  shifts_.erase(shifts_.begin() + shift);
  parts_.erase(parts_.begin() + shift);
}

double Moving::part_at(Index shift, const MovedStretch& place) const {
  double most = 0;
  for (const Index p : places_of(place)) {
    const auto part = parts_[shift].find(p);
    if (part != parts_[shift].end()) most = std::max(most, part->second);
  }
  return most;
}

Index Moving::place_of(Index segment, Index leaf_end) const {
  if (leaf_end == 0) return original_->segment(segment).a;
  if (leaf_end == leaf_counts_[segment]) return original_->segment(segment).b;
  return offsets_[segment] + leaf_end - 1;
}

// The ends of all leaves that overlap the stretch.
std::vector<Index> Moving::places_of(const MovedStretch& stretch) const {
  if (stretch.segment == kNone) return {stretch.node};
  const double count = leaf_counts_[stretch.segment];
  std::vector<Index> places;
  const auto last = static_cast<Index>(std::min(count, std::ceil(stretch.t_last * count)));
  for (auto end = static_cast<Index>(stretch.t_first * count); end <= last; ++end)
    places.push_back(place_of(stretch.segment, end));
  return places;
}

std::vector<Moving::Step> Moving::steps_from(Index place) const {
  std::vector<Step> steps;
  if (is_node(place)) {
    for (const Index s : original_->incident_segments(place)) {
      const Index next = original_->segment(s).a == place ? 1 : leaf_counts_[s] - 1;
      steps.push_back({place_of(s, next), original_->length(s) / leaf_counts_[s]});
    }
    return steps;
  }
  const Index s = segment_of(place), end = leaf_end_of(place);
  const double length = original_->length(s) / leaf_counts_[s];
  return {{place_of(s, end - 1), length}, {place_of(s, end + 1), length}};
}

double Moving::radius_of(Index place) const {
  if (is_node(place)) return original_->node(place).radius;
  const Index s = segment_of(place);
  return original_->radius_at(s, static_cast<double>(leaf_end_of(place)) / leaf_counts_[s]);
}

double Moving::fading_length(const Shift& shift) const {
  double radius = 0;
  for (const MovedStretch& stretch : shift.stretches) {
    for (const Index p : places_of(stretch)) radius = std::max(radius, radius_of(p));
  }
  return std::max(kSteepestFading * shift.distance / slope_, kShortestFading * radius);
}

// Dijkstra's algorithm from all places that are moved by the full distance.
void Moving::fade(Index shift) {
  const double length = fading_length(shifts_[shift]);
  std::map<Index, double> away;
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](Index place, double distance) {
    if (distance >= length) return;
    const auto [known, is_new] = away.try_emplace(place, distance);
    if (!is_new && known->second <= distance) return;
    known->second = distance;
    open.emplace(distance, place);
  };
  for (const MovedStretch& stretch : shifts_[shift].stretches) {
    for (const Index p : places_of(stretch)) reach(p, 0);
  }
  while (!open.empty()) {
    const auto [distance, place] = open.top();
    open.pop();
    if (distance > away.at(place)) continue;
    for (const Step& step : steps_from(place)) reach(step.place, distance + step.length);
  }
  parts_[shift].clear();
  for (const auto& [place, distance] : away) parts_[shift][place] = faded(distance / length);
}

Vec3 Moving::displacement_at(Index place) const {
  Vec3 sum = Vec3::Zero();
  for (Index shift = 0; shift < shifts_.size(); ++shift) {
    const auto part = parts_[shift].find(place);
    if (part != parts_[shift].end()) sum += part->second * shifts_[shift].distance * shifts_[shift].direction;
  }
  return sum;
}

std::map<Index, Vec3> Moving::displacements() const {
  std::map<Index, Vec3> displacements;
  for (Index shift = 0; shift < shifts_.size(); ++shift) {
    const Vec3 whole = shifts_[shift].distance * shifts_[shift].direction;
    for (const auto& [place, part] : parts_[shift]) {
      displacements.try_emplace(place, Vec3::Zero()).first->second += part * whole;
    }
  }
  return displacements;
}

double Moving::steepest_along(Index shift) const {
  double most = 0;
  for (const auto& [place, part] : parts_[shift]) {
    const Vec3 here = displacement_at(place);
    for (const Step& step : steps_from(place))
      most = std::max(most, (displacement_at(step.place) - here).norm() / step.length);
  }
  return most;
}

double Moving::steepest() const {
  double most = 0;
  for (Index shift = 0; shift < shifts_.size(); ++shift) most = std::max(most, steepest_along(shift));
  return most;
}

// The leaf ends that become nodes, by segment, ascending: those that are displaced and those next to them.
std::map<Index, std::vector<Index>> Moving::divisions(const std::map<Index, Vec3>& displaced) const {
  std::map<Index, std::vector<Index>> ends;
  const auto divide_at = [&](Index place) {
    if (!is_node(place)) ends[segment_of(place)].push_back(leaf_end_of(place));
  };
  for (const auto& [place, displacement] : displaced) {
    divide_at(place);
    for (const Step& step : steps_from(place)) divide_at(step.place);
  }
  for (auto& [segment, inner] : ends) sort_unique(inner);
  return ends;
}

DividedCenterline Moving::apply() const {
  const std::map<Index, Vec3> displaced = displacements();
  const std::map<Index, std::vector<Index>> ends = divisions(displaced);
  std::vector<CenterlineNode> nodes = original_->nodes();
  for (const auto& [place, displacement] : displaced) {
    if (is_node(place)) nodes[place].position += displacement;
  }
  std::vector<CenterlineSegment> segments;
  std::vector<SegmentPiece> pieces;
  for (Index s = 0; s < leaf_counts_.size(); ++s) {
    const auto& [a, b] = original_->segment(s);
    Index last = a;
    double t_last = 0;
    const auto join = [&](Index node, double t) {
      pieces.push_back({s, t_last, t});
      segments.push_back({last, node});
      last = node;
      t_last = t;
    };
    const auto inner = ends.find(s);
    for (const Index end : inner == ends.end() ? std::vector<Index>() : inner->second) {
      const double t = static_cast<double>(end) / leaf_counts_[s];
      const auto displacement = displaced.find(place_of(s, end));
      const Vec3 aside = displacement == displaced.end() ? Vec3(Vec3::Zero()) : displacement->second;
      nodes.push_back({original_->point_at(s, t) + aside, original_->radius_at(s, t)});
      join(static_cast<Index>(nodes.size() - 1), t);
    }
    join(b, 1);
  }
  return {Centerline(std::move(nodes), std::move(segments)), std::move(pieces)};
}

}  // namespace vmesh
