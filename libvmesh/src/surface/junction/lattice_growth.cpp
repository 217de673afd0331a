#include "surface/junction/lattice_growth.h"

#include <array>
#include <bit>
#include <queue>
#include <tuple>
#include <unordered_map>

namespace vmesh {
namespace {

using Offset = std::array<int, 3>;

// The 14 neighbours of a point: along the diagonals of the cubes, and along their edges; in half edges.
constexpr int kNeighbours = 14;
constexpr std::array<Offset, kNeighbours> kOffsets = {{{1, 1, 1},
                                                       {-1, -1, -1},
                                                       {1, 1, -1},
                                                       {-1, -1, 1},
                                                       {1, -1, 1},
                                                       {-1, 1, -1},
                                                       {-1, 1, 1},
                                                       {1, -1, -1},
                                                       {2, 0, 0},
                                                       {-2, 0, 0},
                                                       {0, 2, 0},
                                                       {0, -2, 0},
                                                       {0, 0, 2},
                                                       {0, 0, -2}}};
using Mask = std::uint32_t;
constexpr Mask kAll = (1 << kNeighbours) - 1;

constexpr double kNearestToPoint = 0.25;  // of an edge: a surface vertex keeps that far from lattice points
constexpr double kInside = 0.05;          // spacings below the boundary from which on a point counts as inside
constexpr double kFarInside = 1.5;        // spacings below the boundary from which on depths need not be exact
constexpr double kDepthStep = 1e-6;       // spacings below which depths count as equal
constexpr double kBlockedDepth = 0.4;     // spacings below the boundary at which a blocked point asks for a handle

// Which of the 14 are neighbours of each other: the edges of the link of a point, a triangulated sphere.
std::array<Mask, kNeighbours> make_link() {
  std::array<Mask, kNeighbours> link{};
  for (int i = 0; i < kNeighbours; ++i) {
    for (int j = 0; j < kNeighbours; ++j) {
      Offset d;
      for (int c = 0; c < 3; ++c) d[c] = kOffsets[j][c] - kOffsets[i][c];
      if (std::find(kOffsets.begin(), kOffsets.end(), d) != kOffsets.end()) link[i] |= Mask{1} << j;
    }
  }
  return link;
}

int part_count(Mask mask, const std::array<Mask, kNeighbours>& link) {
  int count = 0;
  while (mask) {
    Mask part = mask & (~mask + 1), last = 0;
    while (part != last) {
      last = part;
      for (Mask rest = last; rest; rest &= rest - 1) part |= link[std::countr_zero(rest)] & mask;
    }
    mask &= ~part;
    ++count;
  }
  return count;
}

// For every set of neighbours, whether it falls into so many parts, and the rest of the link into one.
std::vector<char> make_table(int parts_inside) {
  const auto link = make_link();
  std::vector<char> table(1 << kNeighbours);
  for (Mask m = 0; m <= kAll; ++m) table[m] = part_count(m, link) == parts_inside && part_count(kAll & ~m, link) == 1;
  return table;
}

// Whether a point with these neighbours in the set may join it: its link falls into one disc inside and one outside.
const std::vector<char>& simple_table() {
  static const std::vector<char> table = make_table(1);
  return table;
}

// Whether a point with these neighbours in the set joins two parts of it and nothing else: one handle more.
const std::vector<char>& bridge_table() {
  static const std::vector<char> table = make_table(2);
  return table;
}

class LatticeGrowth {
 public:
  LatticeGrowth(const VesselField& field, const Vec3& seed, double spacing, const Eigen::Matrix3d& frame)
      : field_(field), seed_(seed), spacing_(spacing), half_step_(0.5 * spacing * frame) {}

  LatticeSurface run(Index hint, std::size_t max_handles) {
    add(find({0, 0, 0}, {{}, 0, hint}));
    thicken();
    while (surface_.handles < max_handles && bridge()) thicken();
    extract();
    return std::move(surface_);
  }

 private:
  struct Point {
    Offset at;
    double distance;
    Index cone;
    bool in = false;
  };

  static std::uint64_t key(const Offset& at) {
    std::uint64_t k = 0;
    for (const int c : at) k = k << 21 | static_cast<std::uint64_t>(c + (1 << 20));
    return k;
  }
  Vec3 position(const Offset& at) const { return seed_ + half_step_ * Vec3(at[0], at[1], at[2]); }
  static Offset plus(const Offset& a, const Offset& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

  // The number of the neighbour `at` of a point; it is made where it is not known yet. Far inside, an upper bound of
  // its distance will do, which a step from the point gives.
  Index find(const Offset& at, const Point& from) {
    const auto [it, is_new] = number_.emplace(key(at), static_cast<Index>(points_.size()));
    if (is_new) {
      const double bound = from.distance + spacing_;
      if (bound < -kFarInside * spacing_) {
        points_.push_back({at, bound, from.cone});
      } else {
        const FieldSample s = field_.sample(position(at), from.cone);
        points_.push_back({at, s.distance, s.cone});
      }
    }
    return it->second;
  }

  Index known(const Offset& at) const {
    const auto it = number_.find(key(at));
    return it == number_.end() ? kNone : it->second;
  }

  bool in(const Offset& at) const {
    const Index p = known(at);
    return p != kNone && points_[p].in;
  }

  Mask neighbours_in(const Offset& at) const {
    Mask mask = 0;
    for (int i = 0; i < kNeighbours; ++i) mask |= Mask{in(plus(at, kOffsets[i]))} << i;
    return mask;
  }

  void add(Index p) {
    points_[p].in = true;
    const Offset at = points_[p].at;
    for (const Offset& offset : kOffsets) {
      const Index q = find(plus(at, offset), Point(points_[p]));
      if (!points_[q].in && points_[q].distance < -kInside * spacing_) queue_.emplace(depth(q), key(points_[q].at), q);
    }
  }

  // In steps, so that rounding does not decide between points of equal depth.
  double depth(Index p) const { return std::round(-points_[p].distance / (kDepthStep * spacing_)); }

  // Deepest first. A point that is not simple is tried again when a neighbour has joined.
  void thicken() {
    const auto& simple = simple_table();
    while (!queue_.empty()) {
      const Index p = std::get<Index>(queue_.top());
      queue_.pop();
      if (!points_[p].in && simple[neighbours_in(points_[p].at)]) add(p);
    }
  }

  // Joins two fronts at the deepest point that keeps them apart.
  bool bridge() {
    const auto& bridges = bridge_table();
    Index deepest = kNone;
    for (Index p = 0; p < points_.size(); ++p) {
      if (points_[p].in || points_[p].distance > -kBlockedDepth * spacing_) continue;
      if (deepest != kNone && depth(p) <= depth(deepest)) continue;
      if (bridges[neighbours_in(points_[p].at)]) deepest = p;
    }
    if (deepest == kNone) return false;
    add(deepest);
    ++surface_.handles;
    return true;
  }

  // Every tetrahedron has two opposite long edges, along different axes; it is met at the one along the lower axis.
  void extract() {
    const auto count = static_cast<Index>(points_.size());
    for (Index p = 0; p < count; ++p) {
      for (int d = 0; d < 3; ++d) {
        const Index q = known(far_end(points_[p].at, d));
        if (q != kNone) extract_around(p, q, d);
      }
    }
  }

  static Offset far_end(Offset at, int axis) {
    at[axis] += 2;
    return at;
  }

  void extract_around(Index p, Index q, int d) {
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    std::array<Index, 4> ring;
    constexpr std::array<std::array<int, 2>, 4> kRound = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    for (int i = 0; i < 4; ++i) {
      Offset at = points_[p].at;
      at[d] += 1;
      at[u] += kRound[i][0];
      at[v] += kRound[i][1];
      ring[i] = known(at);
    }
    for (int i = 0; i < 4; ++i) {
      const int other_axis = i % 2 == 0 ? u : v;  // along which ring[i] and the next differ
      const Index a = ring[i], b = ring[(i + 1) % 4];
      if (other_axis > d && a != kNone && b != kNone) march({p, q, a, b});
    }
  }

  // The tetrahedron's corners are in positive order.
  void march(const std::array<Index, 4>& corner) {
    std::array<Index, 4> inside{}, outside{};
    std::array<int, 4> inside_rank{}, outside_rank{};
    int n_in = 0, n_out = 0;
    for (int i = 0; i < 4; ++i) {
      if (points_[corner[i]].in) {
        inside_rank[n_in] = i;
        inside[n_in++] = corner[i];
      } else {
        outside_rank[n_out] = i;
        outside[n_out++] = corner[i];
      }
    }
    if (n_in == 0 || n_out == 0) return;
    if (n_in == 1) {
      face(cut(inside[0], outside[0]), cut(inside[0], outside[1]), cut(inside[0], outside[2]), odd(inside_rank[0]));
    } else if (n_out == 1) {
      face(cut(inside[0], outside[0]), cut(inside[1], outside[0]), cut(inside[2], outside[0]), !odd(outside_rank[0]));
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

  // The surface vertex between a point of the set and one outside it.
  Index cut(Index p, Index q) {
    const auto [it, is_new] = vertex_.emplace(std::uint64_t{p} << 32 | q, static_cast<Index>(surface_.vertices.size()));
    if (is_new) {
      const double inside = points_[p].distance, outside = points_[q].distance;
      const double t =
          outside > 0 ? std::clamp(inside / (inside - outside), kNearestToPoint, 1 - kNearestToPoint) : 0.5;
      surface_.vertices.push_back((1 - t) * position(points_[p].at) + t * position(points_[q].at));
      surface_.cones.push_back(points_[p].cone);
    }
    return it->second;
  }

  const VesselField& field_;
  Vec3 seed_;
  double spacing_;
  Eigen::Matrix3d half_step_;
  std::vector<Point> points_;
  std::unordered_map<std::uint64_t, Index> number_, vertex_;
  std::priority_queue<std::tuple<double, std::uint64_t, Index>> queue_;  // depth, key, number
  LatticeSurface surface_;
};

}  // namespace

LatticeSurface grow_in_lattice(const VesselField& field, const Vec3& seed, Index hint, double spacing,
                               const Eigen::Matrix3d& frame, std::size_t max_handles) {
  return LatticeGrowth(field, seed, spacing, frame).run(hint, max_handles);
}

}  // namespace vmesh
