#include "vmesh/surface/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/edit/crossing_guard.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/soundness.h"

#include "surface/cut/plane_parting.h"

namespace vmesh {
namespace {

/// Steps along the vessel in which room for a cut is looked for, in radii, and how many.
constexpr double kSearchStep = 0.1;
constexpr int kSearchSteps = 100;

/// The branch of a cut as a line, and where places are along it.
class BranchLine {
 public:
  BranchLine(const Centerline& centerline, Index segment) : centerline_(centerline) {
    for (const Branch& branch : find_branches(centerline)) {
      if (std::find(branch.segments.begin(), branch.segments.end(), segment) != branch.segments.end()) branch_ = branch;
    }
    double length = 0;
    for (const Index s : branch_.segments) {
      start_.push_back(length);
      length += centerline.length(s);
    }
    start_.push_back(length);
    for (std::size_t i = 0; i < branch_.segments.size(); ++i) rank_.emplace_back(branch_.segments[i], i);
    std::sort(rank_.begin(), rank_.end());
  }

  bool is_loop() const { return branch_.nodes.front() == branch_.nodes.back(); }
  double length() const { return start_.back(); }
  bool has(Index segment) const { return rank_of(segment) != kNone; }

  /// mm from the branch's first node.
  double at(const SegmentPlace& place) const {
    const Index i = rank_of(place.segment);
    return start_[i] + (runs_along(i) ? place.t : 1 - place.t) * (start_[i + 1] - start_[i]);
  }

  SegmentPlace place(double along) const {
    const auto next = std::upper_bound(start_.begin() + 1, start_.end() - 1, along);
    const auto i = static_cast<Index>(next - start_.begin() - 1);
    const double t = std::clamp((along - start_[i]) / (start_[i + 1] - start_[i]), 0.0, 1.0);
    return {branch_.segments[i], runs_along(i) ? t : 1 - t};
  }

  /// How far along a place is from another, the short way around if the branch is a loop.
  double offset(double from, double to) const {
    const double by = to - from;
    if (!is_loop() || std::abs(by) <= length() / 2) return by;
    return by > 0 ? by - length() : by + length();
  }

  bool runs_along(Index i) const { return centerline_.segment(branch_.segments[i]).a == branch_.nodes[i]; }
  Index rank_of(Index segment) const {
    const auto found = std::lower_bound(rank_.begin(), rank_.end(), std::pair<Index, Index>(segment, 0));
    return found != rank_.end() && found->first == segment ? found->second : kNone;
  }
  const Branch& branch() const { return branch_; }

 private:
  const Centerline& centerline_;
  Branch branch_;
  std::vector<double> start_;                  // of every segment, and the end of the last
  std::vector<std::pair<Index, Index>> rank_;  // of every segment, ascending
};

SegmentPlace place_of(const CenterlineBinding& b) { return {b.segment, b.t}; }

/// A place that is an end of a cut.
CenterlineBinding binding_of_end(const CenterlineCut& cut, std::size_t side) {
  const Index segment = cut.end_segment[side];
  return {segment, cut.centerline.segment(segment).b == cut.end[side] ? 1.0 : 0.0};
}

/// How places are called in messages.
using Names = std::function<SegmentPlace(const SegmentPlace&)>;

/// Makes cuts of one surface, none of which changes it.
class SurfaceCutter {
 public:
  SurfaceCutter(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const Centerline& centerline,
                Index segment, Names names)
      : mesh_(mesh),
        binding_(binding),
        centerline_(centerline),
        table_(mesh.faces, mesh.vertices.size()),
        line_(centerline, segment),
        names_(std::move(names)) {}

  /// Empties `reason`, or says why there is no cut.
  std::optional<CutSurface> attempt(const CenterlineCut& cut, std::string& reason) const {
    reason.clear();
    SurfaceAtPlane surface{table_, {cut.position, cut.direction}, mesh_.vertices, {}};
    for (const Vec3& p : mesh_.vertices) surface.distance.push_back(distance_of(surface.plane, p));
    const auto loop = loop_around(surface.positions, table_, surface.plane, surface.distance);
    if (!loop) {
      reason = "the surface is not closed around the vessel there";
      return std::nullopt;
    }
    reason = other_vessel(*loop);
    if (!reason.empty()) return std::nullopt;
    const std::vector<Index> moved = snap_to_plane(surface, *loop);
    auto result = part_at_plane(surface, *loop, moved);
    if (!result) {
      reason = "the surface's triangles are too coarse there";
      return std::nullopt;
    }
    bind(cut, *result);
    reason = fault_of(cut, *result);
    if (!reason.empty()) return std::nullopt;
    return result;
  }

  SegmentPlace named(const SegmentPlace& place) const { return names_ ? names_(place) : place; }

  /// Where the nearest place with room is.
  std::string advice(const CenterlineCut& cut) const {
    const double from = line_.at(cut.at), step = kSearchStep * cut.radius;
    for (int i = 1; i <= kSearchSteps; ++i) {
      for (const int way : {1, -1}) {
        if (const std::string text = advice_at(from, way * i * step); !text.empty()) return text;
      }
    }
    const double searched = kSearchSteps * step;
    return "; there is no room for a cut on this vessel" +
           (searched < line_.length() ? formatted(" within %.3g mm", searched) : std::string());
  }

 private:
  /// A vertex exactly in the plane counts as before it, until it is moved there.
  static double distance_of(const CutPlane& plane, const Vec3& p) {
    const double distance = plane.distance(p);
    return distance == 0 ? std::numeric_limits<double>::min() : distance;
  }

  std::string other_vessel(const PlaneLoop& loop) const {
    for (const Index f : loop.faces) {
      for (const Index v : mesh_.faces[f]) {
        if (line_.has(binding_[v].segment)) continue;
        return "the plane across the vessel meets another one, segment " +
               std::to_string(named(place_of(binding_[v])).segment);
      }
    }
    return {};
  }

  std::string advice_at(double from, double by) const {
    double to = from + by;
    if (line_.is_loop()) to = std::fmod(to + line_.length(), line_.length());
    if (!(to > 0 && to < line_.length())) return {};
    const SegmentPlace place = line_.place(to);
    std::string reason;
    try {
      if (!attempt(cut_centerline(centerline_, place), reason)) return {};
    } catch (const InvalidInput&) {
      return {};  // a node that cannot be cut
    }
    const SegmentPlace called = named(place);
    return "; cut it " + formatted("%.3g mm", std::abs(by)) + " farther along, at segment " +
           std::to_string(called.segment) + formatted(", parameter %.4g", called.t);
  }

  /// Whether the branch runs as the cut's direction does, from end[0] to end[1].
  bool runs_along(const CenterlineCut& cut) const {
    const Index rank = line_.rank_of(cut.at.segment);
    if (!cut.between_segments) return line_.runs_along(rank);
    // end_segment[0] comes before the node in the direction.
    const bool node_is_b = centerline_.segment(cut.at.segment).b == cut.end[0];
    return line_.runs_along(rank) == node_is_b;
  }

  void bind(const CenterlineCut& cut, CutSurface& result) const {
    for (const CenterlineBinding& b : binding_) {
      const SegmentPlace place = cut.after(place_of(b));
      result.binding.push_back({place.segment, place.t});
    }
    const FaceTable table(result.mesh.faces, result.mesh.vertices.size());
    result.binding.resize(result.mesh.vertices.size());
    const double sense = runs_along(cut) ? 1 : -1, at = line_.at(cut.at);
    for (std::size_t side = 0; side < 2; ++side) {
      const CenterlineBinding end = binding_of_end(cut, side);
      const CutSurface::Cap& cap = result.cap[side];
      for (Index f = cap.first_face; f < cap.first_face + cap.face_count; ++f) {
        for (const Index v : result.mesh.faces[f]) result.binding[v] = end;
      }
      // Vertices near the ring that were bound beyond the plane.
      const auto is_beyond = [&](Index v) {
        if (v >= binding_.size() || !line_.has(binding_[v].segment)) return false;
        const double offset = sense * line_.offset(at, line_.at(place_of(binding_[v])));
        return side == 0 ? offset > 0 : offset < 0;
      };
      rebind_beyond(table, cap.ring, is_beyond, end, result);
    }
  }

  template <class IsBeyond>
  static void rebind_beyond(const FaceTable& table, const std::vector<Index>& ring, IsBeyond is_beyond,
                            const CenterlineBinding& end, CutSurface& result) {
    std::vector<Index> front = ring, around;
    std::vector<Index> seen = ring;
    std::sort(seen.begin(), seen.end());
    while (!front.empty()) {
      std::vector<Index> next;
      for (const Index v : front) {
        table.neighbours(v, around);
        for (const Index w : around) {
          const auto place = std::lower_bound(seen.begin(), seen.end(), w);
          if ((place != seen.end() && *place == w) || !is_beyond(w)) continue;
          seen.insert(place, w);
          result.binding[w] = end;
          next.push_back(w);
        }
      }
      front = std::move(next);
    }
  }

  std::string fault_of(const CenterlineCut& cut, const CutSurface& result) const {
    std::vector<Index> changed;
    for (Index f = 0; f < result.mesh.faces.size(); ++f) {
      if (f >= mesh_.faces.size() || result.mesh.faces[f] != mesh_.faces[f] || has_moved(result, f))
        changed.push_back(f);
    }
    if (worst_of(result.mesh, changed) > std::max(kWorstSkewness, worst_of(mesh_, old_faces(changed))))
      return "triangles at the cut would be nearly degenerate";
    if (cross(result.mesh, changed)) return "faces at the cut would cross each other";
    return disagreement(cut, result);
  }

  /// The sides of a cut, of this or an earlier one, coincide at rest and have corners at the same places. They are not
  /// held against each other.
  static bool are_sides(const TriMesh& mesh, Index f, Index g) {
    for (const Index v : mesh.faces[f]) {
      for (const Index w : mesh.faces[g])
        if (v != w && mesh.vertices[v] == mesh.vertices[w]) return true;
    }
    return false;
  }

  static bool cross(const TriMesh& mesh, const std::vector<Index>& changed) {
    const auto pairs = crossing_pairs(mesh.vertices, mesh.faces, changed);
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const auto& pair) { return !are_sides(mesh, pair.first, pair.second); });
  }

  static bool has_moved(const CutSurface& result, Index f) {
    return std::any_of(result.mesh.faces[f].begin(), result.mesh.faces[f].end(),
                       [&](Index v) { return std::binary_search(result.moved.begin(), result.moved.end(), v); });
  }

  std::vector<Index> old_faces(std::vector<Index> faces) const {
    std::erase_if(faces, [&](Index f) { return f >= mesh_.faces.size(); });
    return faces;
  }

  static double worst_of(const TriMesh& mesh, const std::vector<Index>& faces) {
    double worst = 0;
    for (const Index f : faces) {
      const auto& [a, b, c] = mesh.faces[f];
      worst = std::max(worst, equiangle_skewness(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
    }
    return worst;
  }

  /// Whether the surface falls apart exactly if the centerline does, its vertices with their places.
  std::string disagreement(const CenterlineCut& cut, const CutSurface& result) const {
    const std::vector<Index>& component = cut.centerline.component_of_node();
    const bool falls_apart = component[cut.end[0]] != component[cut.end[1]];
    DisjointSets parts(result.mesh.vertices.size());
    for (const auto& [a, b, c] : result.mesh.faces) parts.join(a, b), parts.join(b, c);
    const std::array<Index, 2> part = {parts.find(result.cap[0].vertex), parts.find(result.cap[1].vertex)};
    if ((part[0] != part[1]) != falls_apart)
      return falls_apart ? "the surface is not that of these vessels: it would not fall apart as they do"
                         : "the vessels form a loop there, and the surface does not";
    if (!falls_apart) return {};
    for (Index v = 0; v < result.binding.size(); ++v) {
      const Index segment = result.binding[v].segment;
      if (segment >= cut.centerline.segments().size()) continue;
      const Index of = component[cut.centerline.segment(segment).a];
      for (std::size_t side = 0; side < 2; ++side) {
        if (parts.find(v) == part[side] && of == component[cut.end[1 - side]])
          return "a vertex of one part of the surface, " + std::to_string(v) + ", is bound to the other part";
      }
    }
    return {};
  }

  const TriMesh& mesh_;
  const std::vector<CenterlineBinding>& binding_;
  const Centerline& centerline_;
  FaceTable table_;
  BranchLine line_;
  Names names_;
};

void check_input(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const Centerline& centerline,
                 const CenterlineCut& cut) {
  if (binding.size() != mesh.vertices.size())
    throw InvalidInput("cutting a surface: there are " + std::to_string(mesh.vertices.size()) + " vertices and " +
                       std::to_string(binding.size()) + " bindings; every vertex needs one");
  if (cut.at.segment >= centerline.segments().size())
    throw InvalidInput("cutting a surface: the cut is of another centerline");
}

}  // namespace

CutSurface cut_surface(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const Centerline& centerline,
                       const CenterlineCut& cut, const std::function<SegmentPlace(const SegmentPlace&)>& named) {
  check_input(mesh, binding, centerline, cut);
  const SurfaceCutter cutter(mesh, binding, centerline, cut.at.segment, named);
  std::string reason;
  if (auto result = cutter.attempt(cut, reason)) return *std::move(result);
  const SegmentPlace called = cutter.named(cut.at);
  throw InvalidInput("the surface cannot be cut at segment " + std::to_string(called.segment) +
                     formatted(", parameter %.4g, ", called.t) + point_text(cut.position) + ": " + reason +
                     cutter.advice(cut));
}

}  // namespace vmesh
