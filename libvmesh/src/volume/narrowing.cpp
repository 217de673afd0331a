#include "volume/narrowing.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace vmesh {
namespace {

// Radii: no node is added closer than this to another; safe 0.07 to 0.14.
constexpr double kShortest = 0.1;

// A stretch between two places where shares are known, with the original radii and the shares at its ends.
struct Stretch {
  double length, radius[2], share[2];
};

// Where the radius bends between the ends: where the share has returned to 1 or starts to fall again. Fractions of the
// length.
std::vector<std::pair<double, double>> bends_of(const Stretch& s, double taper) {
  // From an end that lost `lost` of its radius, the radius regains `taper` per length relative to the original.
  const double lost[2] = {(1 - s.share[0]) * s.radius[0], (1 - s.share[1]) * s.radius[1]};
  double up = lost[0] / taper / s.length, down = 1 - lost[1] / taper / s.length;
  const auto original = [&s](double t) { return (1 - t) * s.radius[0] + t * s.radius[1]; };
  std::vector<std::pair<double, double>> bends;
  if (up <= down) {
    if (lost[0] > 0) bends.emplace_back(up, original(up));
    if (lost[1] > 0) bends.emplace_back(down, original(down));
  } else {
    const double meet = (up + down) / 2;
    bends.emplace_back(meet, original(meet) - (up - down) / 2 * taper * s.length);
  }
  const double least = kShortest * std::min(s.radius[0], s.radius[1]) / s.length;
  if (bends.size() == 2 && down - up < least) bends.pop_back();
  std::erase_if(bends, [least](const auto& bend) { return !(bend.first > least && bend.first < 1 - least); });
  return bends;
}

}  // namespace

Narrowing::Narrowing(const Centerline& original, double taper)
    : original_(&original), taper_(taper), node_shares_(original.nodes().size(), 1) {
  for (Index s = 0; s < original.segments().size(); ++s) leaf_counts_.push_back(leaf_count_of(original, s));
}

void Narrowing::hold_node(Index node, double share) { node_shares_[node] = std::min(node_shares_[node], share); }

void Narrowing::hold(Index segment, Index leaf, double share) {
  held_leaves_.emplace(segment, leaf);
  for (const Index end : {leaf, leaf + 1}) {
    if (end == 0) {
      hold_node(original_->segment(segment).a, share);
    } else if (end == leaf_counts_[segment]) {
      hold_node(original_->segment(segment).b, share);
    } else {
      double& known = leaf_shares_.try_emplace({segment, end}, share).first->second;
      known = std::min(known, share);
    }
  }
}

Narrowing::Posts Narrowing::plant_posts() const {
  Posts posts;
  posts.shares = node_shares_;
  posts.on_segment.resize(leaf_counts_.size());
  auto next = leaf_shares_.begin();
  for (Index s = 0; s < leaf_counts_.size(); ++s) {
    auto& line = posts.on_segment[s];
    line.push_back({0, original_->segment(s).a});
    for (; next != leaf_shares_.end() && next->first.first == s; ++next) {
      line.push_back(
          {static_cast<double>(next->first.second) / leaf_counts_[s], static_cast<Index>(posts.shares.size())});
      posts.shares.push_back(next->second);
    }
    line.push_back({1, original_->segment(s).b});
  }
  return posts;
}

// Dijkstra's algorithm from all places where a share is held, lowest share first.
void Narrowing::let_shares_return(Posts& posts) const {
  struct Step {
    Index to;
    double gain;
  };
  std::vector<std::vector<Step>> steps(posts.shares.size());
  for (Index s = 0; s < posts.on_segment.size(); ++s) {
    const auto& line = posts.on_segment[s];
    for (std::size_t n = 1; n < line.size(); ++n) {
      const double radius = std::max(radius_at(s, line[n - 1]), radius_at(s, line[n]));
      const double gain = taper_ * length_between(s, line[n - 1], line[n]) / radius;
      steps[line[n - 1].place].push_back({line[n].place, gain});
      steps[line[n].place].push_back({line[n - 1].place, gain});
    }
  }
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (Index p = 0; p < posts.shares.size(); ++p) {
    if (posts.shares[p] < 1) open.emplace(posts.shares[p], p);
  }
  while (!open.empty()) {
    const auto [share, place] = open.top();
    open.pop();
    if (share > posts.shares[place]) continue;
    for (const Step& step : steps[place]) {
      if (share + step.gain >= posts.shares[step.to]) continue;
      posts.shares[step.to] = share + step.gain;
      open.emplace(posts.shares[step.to], step.to);
    }
  }
}

std::vector<Narrowing::InnerNode> Narrowing::inner_nodes(Index segment, const Posts& posts) const {
  std::vector<InnerNode> inner;
  const auto& line = posts.on_segment[segment];
  for (std::size_t n = 1; n < line.size(); ++n) {
    const Post &p = line[n - 1], &q = line[n];
    const double shares[2] = {posts.shares[p.place], posts.shares[q.place]};
    if (std::min(shares[0], shares[1]) < 1 && !is_held_leaf(segment, p, q)) {
      const Stretch stretch{
          length_between(segment, p, q), {radius_at(segment, p), radius_at(segment, q)}, {shares[0], shares[1]}};
      for (const auto& [fraction, radius] : bends_of(stretch, taper_))
        inner.push_back({p.t + fraction * (q.t - p.t), radius});
    }
    if (n + 1 < line.size()) inner.push_back({q.t, shares[1] * radius_at(segment, q)});
  }
  return inner;
}

bool Narrowing::is_held_leaf(Index segment, const Post& p, const Post& q) const {
  const auto first = static_cast<Index>(std::lround(p.t * leaf_counts_[segment]));
  const auto last = static_cast<Index>(std::lround(q.t * leaf_counts_[segment]));
  return last == first + 1 && held_leaves_.contains({segment, first});
}

DividedCenterline Narrowing::apply() const {
  Posts posts = plant_posts();
  let_shares_return(posts);
  std::vector<CenterlineNode> nodes = original_->nodes();
  for (Index n = 0; n < nodes.size(); ++n) nodes[n].radius *= posts.shares[n];
  std::vector<CenterlineSegment> segments;
  std::vector<SegmentPiece> pieces;
  for (Index s = 0; s < posts.on_segment.size(); ++s) {
    const auto& [a, b] = original_->segment(s);
    SegmentPiece piece{s, 0, 0};
    Index last = a;
    const auto join = [&](Index node, double t) {
      piece = {s, piece.t_last, t};
      pieces.push_back(piece);
      segments.push_back({last, node});
      last = node;
    };
    for (const InnerNode& inner : inner_nodes(s, posts)) {
      nodes.push_back({original_->point_at(s, inner.t), inner.radius});
      join(static_cast<Index>(nodes.size() - 1), inner.t);
    }
    join(b, 1);
  }
  return {Centerline(std::move(nodes), std::move(segments)), std::move(pieces)};
}

}  // namespace vmesh
