#include "vmesh/centerline/simplification.h"

#include <algorithm>
#include <set>

#include "vmesh/centerline/branches.h"

namespace vmesh {
namespace {

using Piece = SimplifiedCenterline::Piece;

// Simplifies one branch at a time, from its first node on.
class Simplifier {
 public:
  Simplifier(const Centerline& centerline, const std::function<double(Index)>& tolerance)
      : centerline_(centerline), tolerance_(tolerance), kept_(centerline.nodes().size(), 1) {}

  SimplifiedCenterline run() {
    const std::vector<Branch> branches = find_branches(centerline_);
    for (const Branch& branch : branches) {
      if (branch.segments.size() == 1) joined_.insert(std::minmax(branch.nodes.front(), branch.nodes.back()));
    }
    for (const Branch& branch : branches) simplify(branch);
    std::vector<Index> number(kept_.size(), kNone), node;
    std::vector<CenterlineNode> nodes;
    for (Index n = 0; n < kept_.size(); ++n) {
      if (!kept_[n]) continue;
      number[n] = static_cast<Index>(node.size());
      node.push_back(n);
      nodes.push_back(centerline_.node(n));
    }
    for (CenterlineSegment& s : segments_) s = {number[s.a], number[s.b]};
    offsets_.push_back(static_cast<Index>(pieces_.size()));
    return {Centerline(std::move(nodes), std::move(segments_)),
            std::move(node),
            std::move(offsets_),
            std::move(pieces_),
            deviation_,
            deviation_relative_};
  }

 private:
  void simplify(const Branch& branch) {
    const std::size_t last = branch.segments.size();
    std::vector<std::size_t> keep = {0};
    const bool closed = branch.nodes.front() == branch.nodes.back();
    const auto go_to = [&](std::size_t end) {
      while (keep.back() < end) keep.push_back(farthest(branch, keep.back(), end));
    };
    if (closed) {
      go_to(last / 3);
      go_to(2 * last / 3);
    }
    go_to(last);
    const bool direct = keep.size() == 2 && last > 1;
    if (direct && !joined_.insert(std::minmax(branch.nodes.front(), branch.nodes.back())).second) {
      keep = {0};
      go_to(last / 2);
      go_to(last);
    }
    for (std::size_t k = 0; k + 1 < keep.size(); ++k) add(branch, keep[k], keep[k + 1]);
  }

  // The farthest node of the branch, up to `end`, found to be reachable from node `first` by a single segment.
  std::size_t farthest(const Branch& branch, std::size_t first, std::size_t end) {
    std::size_t good = first + 1, step = 1;
    while (good < end && fits(branch, first, std::min(end, good + step))) {
      good = std::min(end, good + step);
      step *= 2;
    }
    for (; step > 0; step /= 2) {
      if (good + step <= end && fits(branch, first, good + step)) good += step;
    }
    return good;
  }

  // Whether a single segment may replace the nodes between two nodes of the branch. Fills places_ with where these go
  // on it, ascending.
  bool fits(const Branch& branch, std::size_t first, std::size_t last) {
    const CenterlineNode &a = centerline_.node(branch.nodes[first]), &b = centerline_.node(branch.nodes[last]);
    const Vec3 axis = b.position - a.position;
    const double length2 = axis.squaredNorm();
    if (!(length2 > 0)) return false;
    places_ = {0};
    worst_ = worst_relative_ = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const CenterlineNode& node = centerline_.node(branch.nodes[i]);
      const double foot = (node.position - a.position).dot(axis) / length2;
      const double t = std::clamp(foot, places_.back(), 1.0);
      const double deviation =
          (node.position - a.position - t * axis).norm() + std::abs(node.radius - ((1 - t) * a.radius + t * b.radius));
      if (deviation > tolerance_(branch.nodes[i])) return false;
      worst_ = std::max(worst_, deviation);
      worst_relative_ = std::max(worst_relative_, deviation / node.radius);
      places_.push_back(t);
    }
    places_.push_back(1);
    return true;
  }

  void add(const Branch& branch, std::size_t first, std::size_t last) {
    fits(branch, first, last);
    deviation_ = std::max(deviation_, worst_);
    deviation_relative_ = std::max(deviation_relative_, worst_relative_);
    segments_.push_back({branch.nodes[first], branch.nodes[last]});
    offsets_.push_back(static_cast<Index>(pieces_.size()));
    for (std::size_t i = first; i < last; ++i) {
      const Index s = branch.segments[i];
      const bool forwards = centerline_.segment(s).a == branch.nodes[i];
      pieces_.push_back({s, places_[i - first], forwards ? 0.0 : 1.0, forwards ? 1.0 : 0.0});
      if (i > first) kept_[branch.nodes[i]] = 0;
    }
  }

  const Centerline& centerline_;
  const std::function<double(Index)>& tolerance_;
  std::vector<char> kept_;
  std::set<std::pair<Index, Index>> joined_;  // pairs of nodes with a segment between them: no pair may have two
  std::vector<CenterlineSegment> segments_;
  std::vector<Index> offsets_;
  std::vector<Piece> pieces_;
  std::vector<double> places_;  // of fits()
  double worst_ = 0, worst_relative_ = 0;
  double deviation_ = 0, deviation_relative_ = 0;
};

}  // namespace

std::size_t piece_at(std::span<const Piece> pieces, double t) {
  const auto above =
      std::upper_bound(pieces.begin() + 1, pieces.end(), t, [](double u, const Piece& p) { return u < p.begin; });
  return static_cast<std::size_t>(above - pieces.begin() - 1);
}

SimplifiedCenterline::Place place_on(std::span<const Piece> pieces, double t) {
  const std::size_t i = piece_at(pieces, t);
  const Piece& piece = pieces[i];
  const double piece_end = i + 1 == pieces.size() ? 1 : pieces[i + 1].begin;
  const double length = piece_end - piece.begin;
  const double share = length > 0 ? std::clamp((t - piece.begin) / length, 0.0, 1.0) : 0;
  return {piece.segment, (1 - share) * piece.t_first + share * piece.t_last};
}

SimplifiedCenterline::Place SimplifiedCenterline::original(Index cone, double t) const {
  if (cone >= centerline.segments().size())
    return {static_cast<Index>(cone - centerline.segments().size() + pieces.size()), t};
  return place_on(std::span(pieces).subspan(offsets[cone], offsets[cone + 1] - offsets[cone]), t);
}

SimplifiedCenterline simplify(const Centerline& centerline, const std::function<double(Index)>& tolerance) {
  return Simplifier(centerline, tolerance).run();
}

}  // namespace vmesh
