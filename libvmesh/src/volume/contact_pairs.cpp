#include "volume/contact_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/disjoint_sets.h"

#include "volume/local_pairs.h"

namespace vmesh {
namespace {

constexpr int kSectionSteps = 48;      // derived: 0.618^48 = 1e-10 of the axis
constexpr double kMostRounding = 0.2;  // sums of radii; safe 0.14 to 0.28
// Largest ratio of a cone's greatest radius to the one by which a gap in mm is expressed in radii. Without it, a waist
// of 1e-6 mm would require a gap of 260 radii; idle 5.6 to 11.
constexpr double kThinnest = 8;
constexpr Touch kFork{0.5, 0.25};  // at a fork, vessels are still parting up to this gap
// Derived: relative to lengths, more than the rounding of an axis distance at any angle.
constexpr double kNearlyParallel = 1e-6;
constexpr double kContactRounding = 16 * std::numeric_limits<double>::epsilon();  // relative to coordinates

// The sphere of a cone that is closest to a point, with its radii multiplied by a weight.
struct NearestSphere {
  double lag = 0, low = 0, high = 1;

  NearestSphere(const AxisStretch& cone, double length, double weight) {
    const double taper = weight * (cone.r0 - cone.r1);
    if (std::abs(taper) >= length) {
      low = high = taper >= 0 ? 0 : 1;
      return;
    }
    const double sine = taper / length;
    lag = sine / std::sqrt(1 - sine * sine) / length;
  }
  // `foot`: where the point's foot is on the axis.
  double at(double foot, double off_axis) const { return std::clamp(foot - off_axis * lag, low, high); }
};

// The excess is jointly convex on the two axes: the norm of a linear map, minus linear radii, minus the gap times a
// minimum of linear functions. So its minimum over the second axis is convex on the first.
class Approach {
 public:
  Approach(const AxisStretch& first, const AxisStretch& second, double gap)
      : first_(first),
        second_(second),
        gap_(gap),
        length_(second.axis.norm()),
        inv_length2_(length_ > 0 ? 1 / (length_ * length_) : 0),
        taper_(second.r1 - second.r0),
        plain_(second, length_, 1),
        widened_(second, length_, 1 + gap) {}

  ClosestApproach at(double s) const {
    const Place place{s, first_.point(s), first_.radius(s)};
    const Vec3 q = place.p - second_.origin;
    const double foot = q.dot(second_.axis) * inv_length2_;
    const double off_axis = (q - foot * second_.axis).norm();
    // Where the second vessel is the wider one, where it is the smaller one, and where they are equal.
    ClosestApproach best = between(place, plain_.at(foot, off_axis));
    if (taper_ == 0) return best;  // both are the same
    keep_closer(best, between(place, widened_.at(foot, off_axis)));
    keep_closer(best, between(place, std::clamp((place.radius - second_.r0) / taper_, 0.0, 1.0)));
    return best;
  }

  ClosestApproach closest() const {
    constexpr double kGolden = 0.61803398874989485;
    double low = 0, high = 1;
    ClosestApproach left = at(1 - kGolden), right = at(kGolden);
    for (int step = 0; step < kSectionSteps; ++step) {
      if (left.excess <= right.excess) {
        high = right.s;
        right = left;
        left = at(high - kGolden * (high - low));
      } else {
        low = left.s;
        left = right;
        right = at(low + kGolden * (high - low));
      }
    }
    ClosestApproach best = at(0);
    for (const ClosestApproach& other : {at(1), left, right}) keep_closer(best, other);
    return best;
  }

 private:
  // On the first axis.
  struct Place {
    double s;
    Vec3 p;
    double radius;
  };

  ClosestApproach between(const Place& place, double t) const {
    const double r = place.radius, q = second_.radius(t);
    const double distance = (place.p - second_.point(t)).norm();
    return {distance - r - q - gap_ * std::min(r, q), place.s, t, distance};
  }
  static void keep_closer(ClosestApproach& best, const ClosestApproach& other) {
    if (other.excess < best.excess) best = other;
  }

  const AxisStretch &first_, &second_;
  double gap_, length_, inv_length2_, taper_;
  NearestSphere plain_, widened_;
};

// The distance between the two axes; slightly too large at most where they are nearly parallel.
double axis_distance(const AxisStretch& first, const AxisStretch& second) {
  const Vec3 between = first.origin - second.origin;
  const double a = first.axis.squaredNorm(), b = first.axis.dot(second.axis), e = second.axis.squaredNorm();
  const double c = first.axis.dot(between), f = second.axis.dot(between);
  const auto share = [](double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; };
  const double t = share(b * share(b * f - c * e, a * e - b * b) + f, e);
  const double s = share(b * t - c, a);
  return (between + s * first.axis - t * second.axis).norm();
}

// Box of the cone grown by `margin` times its larger radius.
BoxTree::Box box_of(const AxisStretch& cone, double margin) {
  const Vec3 end = cone.origin + cone.axis;
  BoxTree::Box box{(cone.origin.array() - cone.r0).min(end.array() - cone.r1),
                   (cone.origin.array() + cone.r0).max(end.array() + cone.r1)};
  const double size = box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).maxCoeff();
  const double around = margin * std::max(cone.r0, cone.r1) + kContactRounding * size;
  box.low.array() -= around;
  box.high.array() += around;
  return box;
}

double most_rounding(double blend) { return std::min(blend / 2, kMostRounding); }

Touch fork_touch(double gap) { return {std::max(kFork.smaller, gap / 0.8), kFork.larger}; }

// No larger gap is required of vessels that part: they have walls of their own from a little more on.
double fork_gap(double blend) { return near_again(blend).smaller; }

// Besides the gap, vessels must leave room for what the blend adds to each: at most half the blend, in its radii.
class PairFinder {
 public:
  PairFinder(const ConeRelations& cones, double gap)
      : cones_(cones),
        axes_(cones.centerline()),
        gap_(gap),
        fork_gap_(fork_gap(cones.blend())),
        most_rounding_(most_rounding(cones.blend())) {
    tree_ = BoxTree(axes_.cone_count(), [&](Index c) { return box_of(axes_.stretch(c), most_rounding_); });
  }

  // Pairs of which is_wanted(i, j), i < j.
  template <class IsWanted>
  std::vector<ContactPair> run(IsWanted&& is_wanted) {
    for (Index i = 0; i < axes_.cone_count(); ++i) {
      const BoxTree::Box box = box_of(axes_.stretch(i), gap_ + most_rounding_);
      near_.clear();
      tree_.visit_overlapping(box.low, box.high, [&](Index j) {
        if (j > i && is_wanted(i, j) && !cones_.are_in_one_fan(i, j)) near_.push_back(j);
      });
      std::sort(near_.begin(), near_.end());
      for (const Index j : near_) examine(i, j);
    }
    return std::move(pairs_);
  }

 private:
  // Whether the pair is at a fork: close along the graph in the wider sense of kFork.
  bool are_parting(Index i, Index j) {
    if (gap_ <= fork_gap_) return false;
    if (!parting_) parting_ = local_pairs(cones_.centerline(), fork_touch(gap_));
    return parting_->contains(i, j);
  }

  bool out_of_reach(const AxisStretch& a, const AxisStretch& b) const {
    const double ra = std::max(a.r0, a.r1), rb = std::max(b.r0, b.r1);
    const double reach =
        (a.axis.norm() + b.axis.norm()) / 2 + (1 + most_rounding_) * (ra + rb) + gap_ * std::min(ra, rb);
    return (a.point(0.5) - b.point(0.5)).squaredNorm() > reach * reach * (1 + kContactRounding);
  }

  void examine(Index i, Index j) {
    const AxisStretch first = axes_.stretch(i), second = axes_.stretch(j);
    if (out_of_reach(first, second) || are_apart(first, second, gap_, most_rounding_) || cones_.are_one_volume(i, j))
      return;
    const double gap = are_parting(i, j) ? fork_gap_ : gap_;
    ContactPair pair{i, j, gap, closest_approach(first, second, gap), kNone};
    if (pair.closest.excess >= 0) {
      const double r = first.radius(pair.closest.s), q = second.radius(pair.closest.t);
      if (pair.closest.excess >= most_rounding_ * (r + q)) return;
      // The gap is required all along the cones, also where radii are much larger.
      const double smaller = std::max(std::min(r, q), std::min(cones_.max_radius(i), cones_.max_radius(j)) / kThinnest);
      const double most = std::max(gap, are_parting(i, j) ? fork_gap_ : kMostRounding * (r + q) / smaller);
      pair.gap = std::min(gap + rounding(pair) / smaller, most);
      pair.closest = closest_approach(first, second, pair.gap);
    }
    if (pair.closest.excess < 0) pairs_.push_back(pair);
  }

  // How far rounding at branches moves the walls towards each other, mm. Measured at the axes: the blended distance at
  // the other's axis bounds how close a wall comes.
  double rounding(const ContactPair& pair) const {
    return rounding_at(cones_.axis_point(pair.j, pair.closest.t), pair.i, pair.j) +
           rounding_at(cones_.axis_point(pair.i, pair.closest.s), pair.j, pair.i);
  }

  // How much the blend of cone `c` with cones other than `other` lowers the distance at `p`.
  double rounding_at(const Vec3& p, Index c, Index other) const {
    const FieldSample own = cones_.sample_cone(p, c);
    const double reach = reach_at(c, own.t);
    double most = 0;
    for (const Index k : cones_.local_cones(c)) {
      if (k == c || cones_.are_one_volume(k, other)) continue;
      const FieldSample next = cones_.sample_cone(p, k);
      const double thinner = std::min(reach, reach_at(k, next.t));
      const double width = thinner * (1 - own.gradient.dot(next.gradient));
      const double apart = std::abs(next.distance - own.distance);
      if (apart >= width) continue;
      const double h = 1 - apart / width;
      most = std::max(most, h * h * width / 4);
    }
    return most;
  }

  // Of the blend, mm.
  double reach_at(Index c, double t) const {
    return cones_.blend() * cones_.radius_at(c, t) * cones_.rounding_at(c, t);
  }

  const ConeRelations& cones_;
  ConeAxes axes_;
  double gap_, fork_gap_;  // smaller radii
  double most_rounding_;   // of either vessel, in its radii
  std::optional<LocalSegments> parting_;
  BoxTree tree_;
  std::vector<Index> near_;
  std::vector<ContactPair> pairs_;
};

}  // namespace

bool are_apart(const AxisStretch& first, const AxisStretch& second, double gap, double margin) {
  const double r = std::max(first.r0, first.r1), q = std::max(second.r0, second.r1);
  const double reach = (1 + margin) * (r + q) + gap * std::min(r, q);
  const double size = first.axis.norm() + second.axis.norm() + reach;
  return axis_distance(first, second) > reach + kNearlyParallel * size;
}

ClosestApproach closest_approach(const AxisStretch& first, const AxisStretch& second, double gap) {
  return Approach(first, second, gap).closest();
}

double ContactQuestion::reach() const { return std::max({1.0, 2 * blend, gap + most_rounding(blend)}); }

Touch ContactQuestion::widest_relation() const {
  const Touch rounded = farthest_local(blend);
  if (gap <= fork_gap(blend)) return rounded;
  const Touch fork = fork_touch(gap);
  return {std::max(rounded.smaller, fork.smaller), std::max(rounded.larger, fork.larger)};
}

std::vector<ContactPair> find_contact_pairs(const ConeRelations& cones, double gap) {
  std::vector<ContactPair> pairs = PairFinder(cones, gap).run([](Index, Index) { return true; });
  number_regions(ConeAxes(cones.centerline()), pairs);
  return pairs;
}

std::vector<ContactPair> find_contact_pairs_of(const ConeRelations& cones, double gap,
                                               const std::vector<char>& marked) {
  return PairFinder(cones, gap).run([&](Index i, Index j) { return marked[i] || marked[j]; });
}

void number_regions(const ConeAxes& cones, std::vector<ContactPair>& pairs) {
  DisjointSets joined(pairs.size());
  std::unordered_map<std::uint64_t, std::size_t> first_with;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    for (const Index a : {cones.first_node(pairs[n].i), cones.last_node(pairs[n].i)}) {
      for (const Index b : {cones.first_node(pairs[n].j), cones.last_node(pairs[n].j)}) {
        const auto [low, high] = std::minmax(a, b);
        const auto [known, is_new] = first_with.try_emplace(std::uint64_t{low} << 32 | high, n);
        if (is_new) continue;
        joined.join(static_cast<Index>(known->second), static_cast<Index>(n));
      }
    }
  }
  Index count = 0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const std::size_t first = joined.find(static_cast<Index>(n));
    pairs[n].region = first == n ? count++ : pairs[first].region;
  }
}

}  // namespace vmesh
