#include "synth/tree_growth.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include <Eigen/Geometry>

#include "synth/liver_region.h"
#include "synth/portable_math.h"
#include "synth/sphere_grid.h"

namespace vmesh::growth {
namespace {

using portable::any_perpendicular;
using portable::dot;
using portable::norm;
using portable::unit;

constexpr double kStep = 0.8;         // between samples of a path, in radii
constexpr double kMaxTurn = 0.15;     // per step, radians: a radius of curvature of at least 5 vessel radii
constexpr double kWideGap = 1.6;      // between axes, in sums of radii: what branches aim for
constexpr double kNarrowGap = 1.25;   // the least that they accept
constexpr double kGapPerPath = 0.55;  // near a fork, a gap of this share of the path between the two points is enough
constexpr double kPointsPerEnd = 14;  // samples of the region
constexpr double kTwigReach =
    0.75;  // how far into its territory a twig grows, as a share of the distance to its centre
constexpr double kDegree = 3.14159265358979323846 / 180;

struct Tip {
  Vec3 position, heading;
};

// The samples of the region that a branch supplies, points_[first, first + count), and the number of its ends.
struct Territory {
  std::size_t first = 0, count = 0, ends = 1;
};

struct Job {
  Tip tip;
  Territory territory;
};

Vec3 rotate(const Vec3& v, const Vec3& axis, double angle) {  // axis perpendicular to v
  return portable::cos(angle) * v + portable::sin(angle) * axis.cross(v);
}

class Grower {
 public:
  Grower(std::size_t ends, std::uint64_t seed)
      : random_(seed), scale_(region_scale(ends)), law_(radius_law(ends)), grid_(law_.root_radius * kWideGap) {
    sample_region(ends);
    law_.total = static_cast<double>(points_.size());
    const Vec3 inward = unit(liver::kInward, Vec3(0, 0, 1));
    Branch trunk;
    trunk.radius = law_.root_radius;
    trunk.weight = law_.total;
    const Tip root{liver::kHilum + (law_.root_radius + 1) * inward, inward};
    trunk.path = {root.position};
    add(std::move(trunk));
    jobs_.push_back({root, {0, points_.size(), ends}});
    push_sample(0, root.position, 0);
  }

  std::vector<Branch> run() {
    // Wide vessels first: thin ones find their way around them.
    std::priority_queue<std::pair<double, std::int64_t>> queue;
    queue.push({branches_[0].weight, 0});
    while (!queue.empty()) {
      const auto b = static_cast<Index>(-queue.top().second);
      queue.pop();
      extend(b);
      for (const Index child : branches_[b].children) {
        if (child != kNone) queue.push({branches_[child].weight, -static_cast<std::int64_t>(child)});
      }
    }
    return std::move(branches_);
  }

  double total() const { return law_.total; }

 private:
  struct Sample {
    Vec3 position;
    double arc;
    Index branch;
  };

  // A low-discrepancy sequence (Roberts' R3), shifted at random, fills the region evenly.
  void sample_region(std::size_t ends) {
    const Vec3 alpha(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
    Vec3 u = 0.5 * (random_.in_cube() + Vec3::Ones());
    const auto wanted = static_cast<std::size_t>(kPointsPerEnd * static_cast<double>(std::max<std::size_t>(ends, 20)));
    points_.reserve(wanted);
    while (points_.size() < wanted) {
      u += alpha;
      for (int d = 0; d < 3; ++d) u[d] -= std::floor(u[d]);
      const Vec3 in_box = Vec3(-110, -80, -70) + u.cwiseProduct(Vec3(220, 160, 140));
      if (liver::region(in_box) < 0) points_.push_back(liver::kHilum + scale_ * (in_box - liver::kHilum));
    }
  }

  Index add(Branch branch) {
    branches_.push_back(std::move(branch));
    return static_cast<Index>(branches_.size() - 1);
  }

  void push_sample(Index branch, const Vec3& position, double arc) {
    samples_.push_back({position, arc, branch});
    grid_.push(position, kWideGap * branches_[branch].radius);
  }

  // Path length between two points of the tree.
  double path_length(Index a, double arc_a, Index b, double arc_b) const {
    const double sum = arc_a + arc_b;
    while (a != b) {
      Index& deeper = branches_[a].depth >= branches_[b].depth ? a : b;
      double& arc = &deeper == &a ? arc_a : arc_b;
      arc = branches_[deeper].arc;
      deeper = branches_[deeper].parent;
    }
    return sum - 2 * std::min(arc_a, arc_b);
  }

  // Whether a sphere of branch `b` fits at `p`, `arc` from the root along the tree, with a gap to existing vessels.
  bool fits(Index b, const Vec3& p, double arc, double gap) const {
    const double radius = branches_[b].radius;
    if (liver::region(p) > -1.05 * radius) return false;
    return grid_.visit(p, kWideGap * radius, true, [&](Index i) {
      const Sample& s = samples_[i];
      const double wanted = gap * (radius + branches_[s.branch].radius);
      const Vec3 d = p - s.position;
      const double distance2 = dot(d, d);
      if (distance2 >= wanted * wanted) return true;
      const double near_fork = kGapPerPath * path_length(b, arc, s.branch, s.arc);
      return distance2 >= near_fork * near_fork;
    });
  }

  // One step of branch `b` towards `wish`; false if there is no room.
  bool step(Index b, Tip& tip, const Vec3& wish) {
    Branch& branch = branches_[b];
    const double h = kStep * branch.radius;
    const double arc = branch.arc + branch.length + h;
    const auto heading_towards = [&](const Vec3& to, double max_turn) {
      const Vec3 side = to - dot(to, tip.heading) * tip.heading;
      const double sine = norm(side);
      const double limit = portable::sin(max_turn);
      if (sine <= limit && dot(to, tip.heading) > 0) return to;
      const Vec3 sideways = unit(side, any_perpendicular(tip.heading));
      return Vec3(portable::cos(max_turn) * tip.heading + limit * sideways);
    };
    const auto take = [&](const Vec3& heading, double gap, double lookahead) {
      const Vec3 next = tip.position + h * heading;
      if (!fits(b, next, arc, gap)) return false;
      const Vec3 ahead = next + lookahead * branch.radius * heading;
      if (lookahead > 0 && !fits(b, ahead, arc + lookahead * branch.radius, gap)) return false;
      tip = {next, heading};
      branch.path.push_back(next);
      branch.length += h;
      push_sample(b, next, arc);
      return true;
    };

    const Vec3 straight_there = heading_towards(wish, kMaxTurn);
    if (take(straight_there, kWideGap, 2.5)) return true;
    const Vec3 side =
        unit(straight_there - dot(straight_there, tip.heading) * tip.heading, any_perpendicular(tip.heading));
    for (const double gap : {kWideGap, kNarrowGap}) {
      for (const double turn : {0.5, 1.0}) {
        for (const double around : {0., 45., -45., 90., -90., 135., -135., 180.}) {
          const Vec3 direction = rotate(side, tip.heading, around * kDegree);
          if (take(rotate_towards(tip.heading, direction, turn * kMaxTurn), gap, gap == kWideGap ? 2.5 : 0)) {
            return true;
          }
        }
      }
    }
    return false;
  }

  static Vec3 rotate_towards(const Vec3& heading, const Vec3& side, double angle) {
    return unit(portable::cos(angle) * heading + portable::sin(angle) * side, heading);
  }

  // Grows branch `b` to `target`, gently winding.
  void grow_to(Index b, Tip& tip, const Vec3& target) {
    const double h = kStep * branches_[b].radius;
    const double direct = norm(target - tip.position);
    Vec3 wobble = Vec3::Zero();
    for (double gone = 0; gone < 1.5 * direct; gone += h) {
      const Vec3 to = target - tip.position;
      const double left = norm(to);
      if (left < h || dot(to, tip.heading) < -0.1 * left) return;
      wobble = 0.9 * wobble + 0.13 * random_.in_cube();
      if (!step(b, tip, unit(unit(to, tip.heading) + wobble, tip.heading))) return;
    }
  }

  Vec3 centroid(const Territory& t) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < t.count; ++i) sum += points_[t.first + i];
    return sum / static_cast<double>(t.count);
  }

  // The direction perpendicular to `along` in which the territory is widest.
  Vec3 widest_direction(const Territory& t, const Vec3& centre, const Vec3& along) {
    Vec3 direction = any_perpendicular(along) + 0.3 * random_.in_cube();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < t.count; ++i) {
      const Vec3 q = points_[t.first + i] - centre;
      const Vec3 d = q - dot(q, along) * along;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) covariance(r, c) += d[r] * d[c];
      }
    }
    for (int i = 0; i < 12; ++i) {
      const Vec3 next(dot(covariance.row(0), direction), dot(covariance.row(1), direction),
                      dot(covariance.row(2), direction));
      direction = unit(next, any_perpendicular(along));
    }
    return direction;
  }

  // Cuts the territory along the line from `from` to its centre, with about `share` of its ends on one side.
  std::array<Territory, 2> split(const Territory& t, const Vec3& from, double share) {
    const Vec3 centre = centroid(t);
    const Vec3 along = unit(centre - from, Vec3(0, 0, 1));
    const Vec3 normal = widest_direction(t, centre, along);
    const double wanted = (share + random_.uniform(-0.2, 0.2)) * static_cast<double>(t.ends);
    const std::size_t ends = std::clamp<std::size_t>(static_cast<std::size_t>(wanted + 0.5), 1, t.ends - 1);
    // Not quite in proportion, so that twigs differ.
    const double points = static_cast<double>(ends) / static_cast<double>(t.ends) * static_cast<double>(t.count);
    const double odd = random_.uniform(0.8, 1.2);
    const auto count = std::clamp<std::size_t>(static_cast<std::size_t>(odd * points), 1, t.count - 1);

    keys_.resize(t.count);
    for (std::size_t i = 0; i < t.count; ++i) keys_[i] = dot(points_[t.first + i], normal);
    std::nth_element(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(count), keys_.end());
    const double threshold = keys_[count];
    const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(t.first);
    const auto middle = std::stable_partition(begin, begin + static_cast<std::ptrdiff_t>(t.count),
                                              [&](const Vec3& p) { return dot(p, normal) < threshold; });
    const auto low = static_cast<std::size_t>(middle - begin);
    return {Territory{t.first, low, ends}, Territory{t.first + low, t.count - low, t.ends - ends}};
  }

  // A point on the line to the territory's centre from which the halves' centres appear at a good angle for a fork.
  Vec3 fork_position(Index b, const Tip& tip, const Territory& t, const Vec3& c0, const Vec3& c1) const {
    const Vec3 way = centroid(t) - tip.position;
    const double nearest = std::min(0.8, 2 * branches_[b].radius / std::max(norm(way), 1e-9));
    for (double s = nearest; s < 0.75; s += 0.05) {
      const Vec3 p = tip.position + s * way;
      if (dot(unit(c0 - p, way), unit(c1 - p, way)) < 0.17) return p;
    }
    return tip.position + std::max(nearest, 0.75) * way;
  }

  // The two headings of a fork whose plane is turned by `roll` around the parent's heading.
  std::array<Vec3, 2> fork_headings(const Tip& tip, const std::array<Vec3, 2>& targets,
                                    const std::array<double, 2>& radii, double spread, double roll) const {
    const Vec3 to0 = unit(targets[0] - tip.position, tip.heading), to1 = unit(targets[1] - tip.position, tip.heading);
    const Vec3 mean = unit(to0 + to1, tip.heading);
    const Vec3 forward = unit(tip.heading + 0.6 * mean, tip.heading);
    const Vec3 apart = to0 - to1;
    const Vec3 side = rotate(unit(apart - dot(apart, forward) * forward, any_perpendicular(forward)), forward, roll);
    // The smaller vessel turns off, the larger one continues; neither turns back.
    const double w0 = portable::pow(radii[0], 1.3), w1 = portable::pow(radii[1], 1.3);
    const double most = 60 * kDegree;
    const double angle0 = std::clamp(spread * w1 / (w0 + w1), spread - most, most);
    return {rotate_towards(forward, side, angle0), rotate_towards(forward, -side, spread - angle0)};
  }

  // Starts a child of `parent` with enough room to be distinct from its sibling; kNone if there is none.
  Index start_child(Index parent, Tip& tip, double weight) {
    Branch child;
    child.parent = parent;
    child.depth = branches_[parent].depth + 1;
    child.arc = branches_[parent].arc + branches_[parent].length;
    child.radius = law_(weight);
    child.weight = weight;
    child.path = {tip.position};
    const double wanted = 0.9 * branches_[parent].radius + 2.2 * child.radius;
    const Index b = add(std::move(child));
    while (branches_[b].length < wanted) {
      if (!step(b, tip, tip.heading)) {
        remove_last();
        return kNone;
      }
    }
    return b;
  }

  void remove_last() {
    const auto b = static_cast<Index>(branches_.size() - 1);
    while (samples_.back().branch == b) {
      samples_.pop_back();
      grid_.pop();
    }
    branches_.pop_back();
  }

  bool fork(Index b, const Tip& tip, const std::array<Territory, 2>& halves) {
    const std::array<Vec3, 2> targets{centroid(halves[0]), centroid(halves[1])};
    const std::array<double, 2> weights{static_cast<double>(halves[0].count), static_cast<double>(halves[1].count)};
    const double spread = random_.uniform(76, 100) * kDegree;
    for (const double roll : {0., 25., -25., 50., -50., 75., -75., 90.}) {
      const auto headings = fork_headings(tip, targets, {law_(weights[0]), law_(weights[1])}, spread, roll * kDegree);
      Tip tips[2] = {{tip.position, headings[0]}, {tip.position, headings[1]}};
      const Index first = start_child(b, tips[0], weights[0]);
      if (first == kNone) continue;
      const Index second = start_child(b, tips[1], weights[1]);
      if (second == kNone) {
        remove_last();
        continue;
      }
      branches_[b].children = {first, second};
      jobs_.resize(branches_.size());
      jobs_[first] = {tips[0], halves[0]};
      jobs_[second] = {tips[1], halves[1]};
      return true;
    }
    return false;
  }

  // Grows branch `b` into its territory and divides it there.
  void extend(Index b) {
    Job job = jobs_[b];
    if (job.territory.ends < 2 || job.territory.count < 4) {
      grow_to(b, job.tip, job.tip.position + kTwigReach * (centroid(job.territory) - job.tip.position));
      return;
    }
    auto halves = split(job.territory, job.tip.position, 0.5);
    grow_to(b, job.tip, fork_position(b, job.tip, job.territory, centroid(halves[0]), centroid(halves[1])));
    for (int attempt = 0; attempt < 12; ++attempt) {
      if (fork(b, job.tip, halves)) return;
      // A little farther on, or with a thinner side branch, there may be room.
      step(b, job.tip, unit(centroid(job.territory) - job.tip.position, job.tip.heading));
      halves = split(job.territory, job.tip.position, random_.uniform(0.1, 0.9));
    }
    branches_[b].weight /= static_cast<double>(job.territory.ends);
  }

  portable::Random random_;
  double scale_;
  RadiusLaw law_;
  SphereGrid grid_;
  std::vector<Sample> samples_;
  std::vector<Vec3> points_;
  std::vector<double> keys_;
  std::vector<Branch> branches_;
  std::vector<Job> jobs_;
};

}  // namespace

double RadiusLaw::operator()(double weight) const { return root_radius * portable::pow(weight / total, exponent); }

RadiusLaw radius_law(std::size_t ends) {
  RadiusLaw law;
  const auto n = static_cast<double>(ends);
  law.root_radius *= std::min(1.0, portable::cbrt(n / 12));
  if (ends < 2) return law;
  const double twig = 0.72 * portable::cbrt(200 / n);
  law.exponent = std::clamp(portable::log(law.root_radius / twig) / portable::log(n), 0.36, 0.58);
  return law;
}

double region_scale(std::size_t ends) {
  return std::clamp(portable::pow(static_cast<double>(ends) / 200, 0.14), 0.6, 1.0);
}

std::vector<Branch> grow(std::size_t ends, std::uint64_t seed, double& total) {
  constexpr int kAttempts = 8;
  // Large trees lose a few ends everywhere; for them only an early dead end warrants another attempt.
  const double enough = ends < 1000 ? 0.97 : 0.85;
  std::vector<Branch> best;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Grower grower(ends, seed + static_cast<std::uint64_t>(attempt) * 0xd1b54a32d192ed03u);
    total = grower.total();
    auto branches = grower.run();
    if (branches.size() > best.size()) best = std::move(branches);
    const auto grown_ends = static_cast<double>((best.size() + 1) / 2);
    if (grown_ends >= enough * static_cast<double>(ends)) break;
  }
  return best;
}

}  // namespace vmesh::growth
