#include "surface/input/buried_branches.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "vmesh/centerline/branches.h"

namespace vmesh {
namespace {

// Radii: length of the intervals, each of which must lie in a single cone; idle 0.35 to 0.7.
constexpr double kPiece = 0.5;
constexpr double kSlack = 0.1;  // radii by which an interval may protrude; idle 0.07 to 0.14
// Of the radius of a node's sphere: vessels thinner than that are needles; safe 0.35 to 0.7.
constexpr double kNeedle = 0.5;
constexpr double kNeedleSlack =
    0.25;  // of that radius: how far a needle may protrude where a branch ends; safe 0.17 to 0.35
constexpr int kMaxPieces = 2000;  // derived: per segment; a hair that long is not buried, or not worth testing

class Burial {
 public:
  /// `field`, which is faster, may be null.
  Burial(const ConeRelations& cones, const VesselField* field)
      : cones_(cones),
        field_(field),
        centerline_(cones.centerline()),
        left_(centerline_.segments().size(), 1),
        in_branch_(left_.size(), 0) {}

  std::vector<BuriedBranch> run() {
    for (const auto& node : centerline_.nodes()) widest_ = std::max(widest_, node.radius);
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      if (degree_left(n) == 1) trim(n);
    }
    while (bury_some()) {
    }
    return std::move(buried_);
  }

 private:
  // Trims from an end what lies within the sphere of one node of the branch: there the radius falls faster than the
  // length grows.
  void trim(Index tip) {
    std::vector<Index> nodes = {tip}, segments;
    std::size_t trimmed = 0;
    double along = 0;
    while (along < widest_) {
      const Index s = first_left(nodes.back(), segments.empty() ? kNone : segments.back());
      if (s == kNone || (!segments.empty() && degree_left(nodes.back()) != 2)) break;
      segments.push_back(s);
      nodes.push_back(centerline_.other_node(s, nodes.back()));
      along += centerline_.length(s);
      const bool holds_all =
          std::all_of(nodes.rbegin() + 1, nodes.rend(), [&](Index n) { return sphere_within(n, nodes.back()); });
      const bool goes_on = degree_left(nodes.back()) > 1;  // some of the vessel must remain
      if (holds_all && goes_on) trimmed = segments.size();
    }
    if (trimmed == 0) return;
    segments.resize(trimmed);
    for (const Index s : segments) left_[s] = 0;
    buried_.push_back({std::move(segments)});
  }

  bool sphere_within(Index inner, Index outer) const {
    const auto &a = centerline_.node(inner), &b = centerline_.node(outer);
    const double slack = a.radius < kNeedle * b.radius ? kNeedleSlack * b.radius : 0;
    return (a.position - b.position).norm() + a.radius <= b.radius + slack;
  }

  Index first_left(Index node, Index other_than) const {
    for (const Index s : centerline_.incident_segments(node)) {
      if (left_[s] && s != other_than) return s;
    }
    return kNone;
  }

  // One pass over the remaining branches, thinnest first. Removing one changes the branches around it, so passes are
  // repeated.
  bool bury_some() {
    const BranchTable branches = branches_left();
    bool left_out = false;
    for (const Index b : thinnest_first(branches)) {
      const auto nodes = branches.nodes(b), segments = branches.segments(b);
      if (!is_covered(segments)) continue;
      const bool has_tip = degree_left(nodes.front()) == 1 || degree_left(nodes.back()) == 1;
      if (!has_tip) continue;  // a branch that closes a loop joins vessels that overlap there, and must stay
      for (const Index s : segments) left_[s] = 0;
      buried_.push_back({{segments.begin(), segments.end()}});
      left_out = true;
    }
    return left_out;
  }

  std::vector<Index> thinnest_first(const BranchTable& branches) const {
    std::vector<std::pair<double, Index>> by_radius;
    by_radius.reserve(branches.size());
    for (Index b = 0; b < branches.size(); ++b) by_radius.emplace_back(mean_radius(branches.segments(b)), b);
    std::sort(by_radius.begin(), by_radius.end());
    std::vector<Index> order;
    order.reserve(by_radius.size());
    for (const auto& [radius, b] : by_radius) order.push_back(b);
    return order;
  }

  // In the numbers of the full centerline.
  BranchTable branches_left() const {
    if (std::all_of(left_.begin(), left_.end(), [](char left) { return left != 0; })) return BranchTable(centerline_);
    std::vector<CenterlineSegment> segments;
    std::vector<Index> number;
    for (Index s = 0; s < left_.size(); ++s) {
      if (!left_[s]) continue;
      segments.push_back(centerline_.segment(s));
      number.push_back(s);
    }
    BranchTable branches(Centerline(centerline_.nodes(), std::move(segments)));
    branches.renumber_segments(number);
    return branches;
  }

  std::size_t degree_left(Index n) const {
    const auto incident = centerline_.incident_segments(n);
    return static_cast<std::size_t>(
        std::count_if(incident.begin(), incident.end(), [&](Index s) { return left_[s] != 0; }));
  }

  double mean_radius(std::span<const Index> segments) const {
    double sum = 0, length = 0;
    for (const Index s : segments) {
      sum += centerline_.length(s) * centerline_.radius_at(s, 0.5);
      length += centerline_.length(s);
    }
    return sum / length;
  }

  bool is_covered(std::span<const Index> segments) {
    for (const Index s : segments) in_branch_[s] = 1;
    const bool covered =
        std::all_of(segments.begin(), segments.end(), [&](Index s) { return is_covered_by_others(s); });
    for (const Index s : segments) in_branch_[s] = 0;
    return covered;
  }

  bool is_covered_by_others(Index s) {
    const double pieces = std::ceil(centerline_.length(s) / (kPiece * centerline_.radius_at(s, 0.5)));
    if (pieces > kMaxPieces) return false;
    for (int k = 0; k < pieces; ++k) {
      const double begin = k / pieces, end = (k + 1) / pieces;
      const std::span<const Index> near = local_cones_near(s, begin);
      const bool covered = std::any_of(near.begin(), near.end(), [&](Index cone) {
        return is_other(cone) && holds(cone, s, begin) && holds(cone, s, end);
      });
      if (!covered) return false;
    }
    return true;
  }

  /// At least those that can hold the vessel there.
  std::span<const Index> local_cones_near(Index s, double t) {
    if (field_ == nullptr) return cones_.local_cones(s);
    field_->local_cones_near(centerline_.point_at(s, t), s, depth_in_others(s, t), near_);
    return near_;
  }

  bool is_other(Index cone) const { return left_[cone] && !in_branch_[cone]; }

  // The signed distance from another cone at which it contains the vessel there.
  double depth_in_others(Index s, double t) const { return (kSlack - 1) * centerline_.radius_at(s, t); }

  bool holds(Index cone, Index s, double t) const {
    const Vec3 p = centerline_.point_at(s, t);
    return (field_ ? field_->sample_cone(p, cone) : cones_.sample_cone(p, cone)).distance <= depth_in_others(s, t);
  }

  const ConeRelations& cones_;
  const VesselField* field_;
  const Centerline& centerline_;
  double widest_ = 0;
  std::vector<char> left_, in_branch_;
  std::vector<Index> near_;
  std::vector<BuriedBranch> buried_;
};

}  // namespace

std::vector<BuriedBranch> find_buried_branches(const VesselField& field) {
  return Burial(field.relations(), &field).run();
}

std::vector<BuriedBranch> find_buried_branches(const ConeRelations& cones) { return Burial(cones, nullptr).run(); }

GrowthCenterline without_buried_branches(const Centerline& full, std::vector<BuriedBranch> buried) {
  std::vector<char> left(full.segments().size(), 1);
  for (const BuriedBranch& branch : buried) {
    for (const Index s : branch.segments) left[s] = 0;
  }
  std::vector<Index> number(full.nodes().size(), kNone), kept_nodes, kept_segments, kept_cones;
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  const auto count = static_cast<std::size_t>(std::count(left.begin(), left.end(), 1));
  nodes.reserve(full.nodes().size());
  kept_nodes.reserve(full.nodes().size());
  segments.reserve(count);
  kept_segments.reserve(count);
  std::size_t isolated = 0;
  for (Index n = 0; n < full.nodes().size(); ++n) {
    const auto incident = full.incident_segments(n);
    isolated += incident.empty();
    if (!incident.empty() && std::none_of(incident.begin(), incident.end(), [&](Index s) { return left[s] != 0; }))
      continue;
    number[n] = static_cast<Index>(nodes.size());
    nodes.push_back(full.node(n));
    kept_nodes.push_back(n);
  }
  for (Index s = 0; s < full.segments().size(); ++s) {
    if (!left[s]) continue;
    segments.push_back({number[full.segment(s).a], number[full.segment(s).b]});
    kept_segments.push_back(s);
  }
  kept_cones = kept_segments;
  for (std::size_t i = 0; i < isolated; ++i) kept_cones.push_back(static_cast<Index>(full.segments().size() + i));
  return {Centerline(std::move(nodes), std::move(segments)), std::move(kept_nodes), std::move(kept_segments),
          std::move(kept_cones), std::move(buried)};
}

GrowthCenterline without_buried_branches(const VesselField& field) {
  return without_buried_branches(field.relations().centerline(), find_buried_branches(field));
}

std::vector<GrowthSimplification> notes_of_buried(const std::vector<BuriedBranch>& all_buried, const Centerline& full) {
  std::vector<GrowthSimplification> notes;
  for (const BuriedBranch& buried : all_buried) {
    const Index middle = buried.segments[buried.segments.size() / 2];
    GrowthSimplification note{
        GrowthSimplification::Kind::buried_branch, full.point_at(middle, 0.5), {}, buried.segments, {}};
    std::ostringstream text;
    text << "the branch at (" << note.position.x() << ", " << note.position.y() << ", " << note.position.z()
         << ") was left out: the other vessels cover it";
    note.message = text.str();
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace vmesh
