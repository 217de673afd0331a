#include "surface/junction/lattice_growth.h"

#include <array>
#include <queue>

namespace vmesh {
namespace {

// Of an edge: least distance of a surface vertex from lattice points; safe 0.17 to 0.35.
constexpr double kNearestToPoint = 0.25;
// Spacings below the boundary from which on a point counts as inside; safe 0.035 to 0.07.
constexpr double kInside = 0.05;
// Spacings below the boundary from which on depths need not be exact; safe 1 to 2.1.
constexpr double kFarInside = 1.5;
constexpr double kDepthStep = 1e-6;  // radii: depths that differ by less count as equal; idle 7e-7 to 1.4e-6
// Spacings below the boundary from which on a blocked point may become a handle; idle 0.28 to 0.56.
constexpr double kBlockedDepth = 0.4;

class LatticeGrowth {
 public:
  LatticeGrowth(const VesselField& field, const GradedLattice& lattice)
      : field_(field),
        lattice_(lattice),
        points_(lattice.size()),
        in_(lattice.size(), 0),
        seen_by_(lattice.size(), kNone),
        part_(lattice.size(), kNone),
        first_cut_(lattice.size(), kNone) {}

  LatticeSurface run(Index hint, std::size_t max_handles) {
    points_[0] = {0, 1, hint, true};
    add(0);
    thicken();
    while (surface_.handles < max_handles && bridge()) thicken();
    for (const auto& corners : lattice_.tetrahedra()) march(corners);
    return std::move(surface_);
  }

 private:
  struct Point {
    double distance = 0;
    double radius = 1;  // of the vessel there
    Index cone = kNone;
    bool known = false;
  };
  // The surface vertex between a point of the set and one outside it.
  struct Cut {
    Index outside, vertex;
    Index next;  // cut of the same point of the set
  };
  struct Parts {
    int inside, outside;
  };

  // Far inside, an upper bound of the distance is enough; it follows from the neighbour's distance.
  void learn(Index q, Index from) {
    Point& point = points_[q];
    if (point.known) return;
    point.known = true;
    const Vec3 p = lattice_.position(q);
    const double bound = points_[from].distance + (p - lattice_.position(from)).norm();
    if (bound < -kFarInside * lattice_.spacing(q)) {
      point.distance = bound;
      point.radius = points_[from].radius;
      point.cone = points_[from].cone;
    } else {
      const FieldSample s = field_.sample_fast(p, points_[from].cone);
      point.distance = s.distance;
      point.radius = field_.relations().radius_at(s.cone, s.t);
      point.cone = s.cone;
    }
  }

  bool is_inside(Index p) const {
    return points_[p].known && !lattice_.at_border(p) && points_[p].distance < -kInside * lattice_.spacing(p);
  }

  void add(Index p) {
    in_[p] = 1;
    for (const Index t : lattice_.around(p)) {
      for (const Index q : lattice_.tetrahedra()[t]) {
        if (seen_by_[q] == p) continue;
        seen_by_[q] = p;
        learn(q, p);
        if (!in_[q] && is_inside(q)) queue_.emplace(depth(q), q);
      }
    }
  }

  // In radii, so that vessels grow along their axes before they reach walls that touch elsewhere; quantised, so that
  // rounding does not decide between points of equal depth.
  double depth(Index p) const { return std::round(-points_[p].distance / (kDepthStep * points_[p].radius)); }

  // Number of components of the link of a point (a triangulated sphere) inside the set, and outside it.
  Parts parts_around(Index p) {
    link_.clear();
    int parts[2] = {0, 0};
    const auto root = [&](Index q) {
      while (part_[q] != q) q = part_[q] = part_[part_[q]];
      return q;
    };
    for (const Index t : lattice_.around(p)) {
      const auto& corners = lattice_.tetrahedra()[t];
      for (const Index q : corners) {
        if (q == p || part_[q] != kNone) continue;
        part_[q] = q;
        link_.push_back(q);
        ++parts[in_[q]];
      }
      for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) {
          const Index a = corners[i], b = corners[j];
          if (a == p || b == p || in_[a] != in_[b]) continue;
          const Index from = root(a), to = root(b);
          if (from == to) continue;
          part_[from] = to;
          --parts[in_[a]];
        }
      }
    }
    for (const Index q : link_) part_[q] = kNone;
    return {parts[1], parts[0]};
  }

  // Whether it may join the set: its link consists of one disc inside and one outside.
  bool is_simple(Index p) {
    const auto [inside, outside] = parts_around(p);
    return inside == 1 && outside == 1;
  }
  // Whether it joins two components of its link and changes nothing else: this adds one handle.
  bool is_bridge(Index p) {
    const auto [inside, outside] = parts_around(p);
    return inside == 2 && outside == 1;
  }

  // Deepest first. A point that is not simple is tried again when a neighbour has joined.
  void thicken() {
    while (!queue_.empty()) {
      const Index p = queue_.top().second;
      queue_.pop();
      if (!in_[p] && is_simple(p)) add(p);
    }
  }

  // Joins two fronts at the deepest point that keeps them apart.
  bool bridge() {
    Index deepest = kNone;
    for (Index p = 0; p < points_.size(); ++p) {
      if (in_[p] || !is_inside(p) || points_[p].distance > -kBlockedDepth * lattice_.spacing(p)) continue;
      if (deepest != kNone && depth(p) <= depth(deepest)) continue;
      if (is_bridge(p)) deepest = p;
    }
    if (deepest == kNone) return false;
    add(deepest);
    ++surface_.handles;
    return true;
  }

  // The tetrahedron's corners are in positive order.
  void march(const std::array<Index, 4>& corner) {
    const int in = in_[corner[0]] + in_[corner[1]] + in_[corner[2]] + in_[corner[3]];
    if (in == 0 || in == 4) return;
    std::array<Index, 4> inside{}, outside{};
    std::array<int, 4> inside_rank{}, outside_rank{};
    int n_in = 0, n_out = 0;
    for (int i = 0; i < 4; ++i) {
      if (in_[corner[i]]) {
        inside_rank[n_in] = i;
        inside[n_in++] = corner[i];
      } else {
        outside_rank[n_out] = i;
        outside[n_out++] = corner[i];
      }
    }
    // cut() numbers vertices: one after the other, as compilers evaluate arguments in orders of their own.
    if (n_in == 1) {
      const Index c = cut(inside[0], outside[2]), b = cut(inside[0], outside[1]), a = cut(inside[0], outside[0]);
      face(a, b, c, odd(inside_rank[0]));
    } else if (n_out == 1) {
      const Index c = cut(inside[2], outside[0]), b = cut(inside[1], outside[0]), a = cut(inside[0], outside[0]);
      face(a, b, c, !odd(outside_rank[0]));
    } else {
      const bool flip = (inside_rank[0] == 0 && inside_rank[1] == 2) || (inside_rank[0] == 1 && inside_rank[1] == 3);
      const Index ac = cut(inside[0], outside[0]), ad = cut(inside[0], outside[1]), bc = cut(inside[1], outside[0]),
                  bd = cut(inside[1], outside[1]);
      face(ac, ad, bd, flip);
      face(ac, bd, bc, flip);
    }
  }

  static bool odd(int i) { return i % 2 == 1; }

  void face(Index a, Index b, Index c, bool flip) {
    if (flip) {
      surface_.faces.push_back({a, c, b});
    } else {
      surface_.faces.push_back({a, b, c});
    }
  }

  Index cut(Index p, Index q) {
    for (Index i = first_cut_[p]; i != kNone; i = cuts_[i].next) {
      if (cuts_[i].outside == q) return cuts_[i].vertex;
    }
    const auto vertex = static_cast<Index>(surface_.vertices.size());
    cuts_.push_back({q, vertex, first_cut_[p]});
    first_cut_[p] = static_cast<Index>(cuts_.size() - 1);
    const double inside = points_[p].distance, outside = points_[q].distance;
    const double t = outside > 0 ? std::clamp(inside / (inside - outside), kNearestToPoint, 1 - kNearestToPoint) : 0.5;
    surface_.vertices.push_back((1 - t) * lattice_.position(p) + t * lattice_.position(q));
    surface_.cones.push_back(points_[p].cone);
    surface_.points.push_back(p);
    return vertex;
  }

  const VesselField& field_;
  const GradedLattice& lattice_;
  std::vector<Point> points_;
  std::vector<std::uint8_t> in_;                         // the set
  std::priority_queue<std::pair<double, Index>> queue_;  // depth, point
  std::vector<Index> seen_by_;                           // the last added point from which this one was visited
  std::vector<Index> part_, link_;                       // scratch of parts_around()
  std::vector<Index> first_cut_;                         // of every point of the set
  std::vector<Cut> cuts_;
  LatticeSurface surface_;
};

}  // namespace

LatticeSurface grow_in_lattice(const VesselField& field, const GradedLattice& lattice, Index hint,
                               std::size_t max_handles) {
  return LatticeGrowth(field, lattice).run(hint, max_handles);
}

}  // namespace vmesh
