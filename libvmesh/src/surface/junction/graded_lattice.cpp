#include "surface/junction/graded_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace vmesh {
namespace {

constexpr double kMargin = 2;          // units: how far tetrahedra extend beyond a ball, one spacing
constexpr double kLongest = 2;         // units: the longest edge of an unbisected tetrahedron
constexpr int kTetrahedraAround = 24;  // around a point, before any bisection

using Tetrahedron = GradedLattice::Tetrahedron;

std::uint64_t key_of_pair(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

// Numbers of points with integer coordinates, stored in blocks because neighbouring points are looked up together. The
// blocks themselves are in a grid, unless that would be very large.
class PlaceNumbers {
 public:
  // For places from `low` to `high`.
  void cover(const Vec3& low, const Vec3& high) {
    double count = 1;
    for (int i = 0; i < 3; ++i) {
      first_[i] = static_cast<std::int32_t>(std::floor(low[i])) >> kBits;
      side_[i] = (static_cast<std::int32_t>(std::ceil(high[i])) >> kBits) - first_[i] + 1;
      count *= side_[i];
    }
    if (count <= kMostInGrid) grid_.assign(static_cast<std::size_t>(count), kNone);
  }

  // kNone where no number has been assigned yet.
  Index& at(const Vec3& place) {
    std::array<std::int32_t, 3> c;
    for (int i = 0; i < 3; ++i) c[i] = static_cast<std::int32_t>(place[i]);
    const std::array<std::int32_t, 3> block = {c[0] >> kBits, c[1] >> kBits, c[2] >> kBits};
    if (block != last_block_) {
      last_block_ = block;
      Index& number = number_of(block);
      if (number == kNone) {
        number = static_cast<Index>(blocks_.size());
        blocks_.emplace_back().fill(kNone);
      }
      last_ = number;
    }
    constexpr int kMask = kSide - 1;
    return blocks_[last_][static_cast<std::size_t>(((c[0] & kMask) * kSide + (c[1] & kMask)) * kSide + (c[2] & kMask))];
  }

 private:
  static constexpr int kBits = 3, kSide = 1 << kBits;
  static constexpr double kMostInGrid = 1 << 16;
  using Block = std::array<Index, kSide * kSide * kSide>;

  Index& number_of(const std::array<std::int32_t, 3>& block) {
    if (!grid_.empty()) {
      const std::array<std::int32_t, 3> at = {block[0] - first_[0], block[1] - first_[1], block[2] - first_[2]};
      return grid_[static_cast<std::size_t>((at[0] * side_[1] + at[1]) * side_[2] + at[2])];
    }
    std::uint64_t key = 0;
    for (const std::int32_t x : block) key = key << 21 | (static_cast<std::uint64_t>(x) & 0x1FFFFF);
    return far_apart_.try_emplace(key, kNone).first->second;
  }

  std::array<std::int32_t, 3> first_{}, side_{};
  std::vector<Index> grid_;
  std::unordered_map<std::uint64_t, Index> far_apart_;
  std::vector<Block> blocks_;
  std::array<std::int32_t, 3> last_block_{INT32_MAX, 0, 0};
  Index last_ = kNone;
};

}  // namespace

class GradedLattice::Maker {
 public:
  Maker(GradedLattice& lattice, std::span<const LatticeBall> balls) : lattice_(lattice), at_(lattice.at_) {
    for (const LatticeBall& ball : balls) {
      const Vec3 center = lattice.frame_.transpose() * (ball.center - lattice.origin_) / lattice.unit_;
      balls_.push_back({center, ball.radius / lattice.unit_, ball.longest / lattice.unit_});
    }
  }

  void run() {
    Vec3 low = Vec3::Zero(), high = low;
    for (const LatticeBall& ball : balls_) {
      low = low.cwiseMin((ball.center.array() - ball.radius).matrix());
      high = high.cwiseMax((ball.center.array() + ball.radius).matrix());
    }
    const double beyond = kMargin + kLongest;  // of the balls
    root_number_.cover((low.array() - beyond).matrix(), (high.array() + beyond).matrix());
    add_root(Vec3::Zero());
    for (const LatticeBall& ball : balls_) for_points_near(ball, kMargin, [&](const Vec3& at) { add_root(at); });
    make_roots();
    const auto is_fine = [](const LatticeBall& ball) { return ball.longest < kLongest; };
    if (std::any_of(balls_.begin(), balls_.end(), is_fine)) {
      note_roots();
      for (Index i = 0; i < balls_.size(); ++i) {
        if (is_fine(balls_[i])) refine(i);
      }
    }
    finish();
  }

 private:
  struct Edge {
    int a, b;  // corners
    double length2;
  };
  struct Node {
    Tetrahedron corners;
    Edge longest;
    double coarsest2;           // bound on the squared edges of all its descendants
    Index child = kNone;        // the first of its two children; kNone: not bisected
    std::array<Index, 4> next;  // in the list of tetrahedra around each corner: 4 * number + corner
  };

  static bool is_odd(double whole) { return (static_cast<std::int64_t>(whole) & 1) != 0; }

  // Lattice points are all even or all odd.
  template <class Visit>
  static void for_points_near(const LatticeBall& ball, double margin, const Visit& visit) {
    const double reach = ball.radius + margin;
    for (double x = std::ceil(ball.center.x() - reach); x <= ball.center.x() + reach; ++x) {
      const double over_x = reach * reach - (x - ball.center.x()) * (x - ball.center.x());
      const auto first = [&](double low) {
        const double least = std::ceil(low);
        return is_odd(least) == is_odd(x) ? least : least + 1;
      };
      const double wide = std::sqrt(std::max(0.0, over_x));
      for (double y = first(ball.center.y() - wide); y <= ball.center.y() + wide; y += 2) {
        const double over_y = over_x - (y - ball.center.y()) * (y - ball.center.y());
        const double tall = std::sqrt(std::max(0.0, over_y));
        for (double z = first(ball.center.z() - tall); z <= ball.center.z() + tall; z += 2) visit(Vec3(x, y, z));
      }
    }
  }

  void add_root(const Vec3& at) {
    Index& number = root_number_.at(at);
    if (number != kNone) return;
    number = static_cast<Index>(at_.size());
    at_.push_back(at);
  }

  Index root(const Vec3& at) { return root_number_.at(at); }

  // Every tetrahedron has two opposite long edges along different axes; it is created from the one along the lower
  // axis.
  void make_roots() {
    const auto count = static_cast<Index>(at_.size());
    first_around_.assign(count, kNone);
    std::vector<int> around(count, 0);
    for (Index p = 0; p < count; ++p) {
      for (int d = 0; d < 3; ++d) {
        const Index q = root(at_[p] + 2 * Vec3::Unit(d));
        if (q != kNone) make_around(p, q, d, around);
      }
    }
    for (const int n : around) lattice_.at_border_.push_back(n < kTetrahedraAround);
  }

  void make_around(Index p, Index q, int d, std::vector<int>& around) {
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    constexpr std::array<std::array<int, 2>, 4> kRound = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    std::array<Index, 4> ring;
    for (int i = 0; i < 4; ++i)
      ring[i] = root(at_[p] + Vec3::Unit(d) + kRound[i][0] * Vec3::Unit(u) + kRound[i][1] * Vec3::Unit(v));
    for (int i = 0; i < 4; ++i) {
      const int other_axis = i % 2 == 0 ? u : v;  // along which ring[i] and the next differ
      const Index a = ring[i], b = ring[(i + 1) % 4];
      if (other_axis < d || a == kNone || b == kNone) continue;
      const bool odd = is_odd(at_[p].x());
      const Tetrahedron corners = odd ? Tetrahedron{p, q, a, b} : Tetrahedron{a, b, p, q};
      for (const Index c : corners) ++around[c];
      add(corners);
    }
  }

  Index add(const Tetrahedron& corners) {
    const auto number = static_cast<Index>(nodes_.size());
    const Edge longest = longest_edge(corners);
    Node node{corners, longest, longest.length2, kNone, {}};
    for (int i = 0; i < 4; ++i) {
      node.next[i] = first_around_[corners[i]];
      first_around_[corners[i]] = 4 * number + i;
    }
    nodes_.push_back(node);
    return number;
  }

  // The first in order where two are equally long: in an unbisected tetrahedron, the one between odd points.
  Edge longest_edge(const Tetrahedron& corners) const {
    Edge longest{0, 1, 0};
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        const double length2 = (at_[corners[a]] - at_[corners[b]]).squaredNorm();
        if (length2 > longest.length2) longest = {a, b, length2};
      }
    }
    return longest;
  }

  // Links the tetrahedra around every root point, before any is bisected.
  void note_roots() {
    roots_around_.resize(at_.size());
    for (Index t = 0; t < nodes_.size(); ++t) {
      for (const Index c : nodes_[t].corners) roots_around_[c].push_back(t);
    }
    last_ball_.assign(nodes_.size(), kNone);
  }

  void refine(Index number) {
    const LatticeBall& ball = balls_[number];
    for_points_near(ball, kLongest, [&](const Vec3& at) {
      const Index p = root(at);
      if (p == kNone) return;
      for (const Index t : roots_around_[p]) {
        if (last_ball_[t] == number) continue;
        last_ball_[t] = number;
        refine(t, ball);
      }
    });
  }

  void refine(Index t, const LatticeBall& ball) {
    if (nodes_[t].coarsest2 <= ball.longest * ball.longest) return;
    const Edge longest = nodes_[t].longest;
    const Vec3 middle = 0.5 * (at_[nodes_[t].corners[longest.a]] + at_[nodes_[t].corners[longest.b]]);
    // The tetrahedron lies within the longest edge's length of that edge's midpoint.
    const double reach = ball.radius + std::sqrt(longest.length2);
    if ((middle - ball.center).squaredNorm() > reach * reach) return;
    if (nodes_[t].child == kNone) bisect(t);
    const Index child = nodes_[t].child;
    refine(child, ball);
    refine(child + 1, ball);
    nodes_[t].coarsest2 = std::max(nodes_[child].coarsest2, nodes_[child + 1].coarsest2);
  }

  // Bisects it together with all others around its longest edge; those with a longer edge are bisected first.
  void bisect(Index t) {
    const Edge edge = nodes_[t].longest;
    const Index a = nodes_[t].corners[edge.a], b = nodes_[t].corners[edge.b];
    const std::size_t begin = around_.size();
    find_around_edge(a, b);
    for (std::size_t i = begin; i < around_.size();) {
      const Edge& other = nodes_[around_[i]].longest;
      const Tetrahedron& corners = nodes_[around_[i]].corners;
      if (key_of_pair(corners[other.a], corners[other.b]) == key_of_pair(a, b)) {
        ++i;
        continue;
      }
      bisect(around_[i]);
      around_.resize(begin);
      find_around_edge(a, b);
      i = begin;
    }
    const std::span<const Index> around = std::span(around_).subspan(begin);
    const auto middle = static_cast<Index>(at_.size());
    at_.push_back(0.5 * (at_[a] + at_[b]));
    lattice_.at_border_.push_back(lattice_.at_border_[a] && lattice_.at_border_[b] && !closes_around(a, b, around));
    first_around_.push_back(kNone);
    for (const Index u : around) {
      for (const Index end : {b, a}) {
        Tetrahedron corners = nodes_[u].corners;
        *std::find(corners.begin(), corners.end(), end) = middle;
        const Index child = add(corners);
        if (nodes_[u].child == kNone) nodes_[u].child = child;
      }
    }
    around_.resize(begin);
  }

  // Whether these tetrahedra close up around the edge: each triangle at the edge has two of them.
  bool closes_around(Index a, Index b, std::span<const Index> around) const {
    const auto count = [&](Index corner) {
      return std::count_if(around.begin(), around.end(), [&](Index t) {
        const Tetrahedron& corners = nodes_[t].corners;
        return std::find(corners.begin(), corners.end(), corner) != corners.end();
      });
    };
    return std::all_of(around.begin(), around.end(), [&](Index t) {
      const Tetrahedron& corners = nodes_[t].corners;
      return std::all_of(corners.begin(), corners.end(), [&](Index c) { return c == a || c == b || count(c) == 2; });
    });
  }

  // Appends the unbisected ones to around_, ascending, and drops bisected ones from the list on the way.
  void find_around_edge(Index a, Index b) {
    const std::size_t begin = around_.size();
    Index* link = &first_around_[a];
    while (*link != kNone) {
      Node& node = nodes_[*link / 4];
      if (node.child != kNone) {
        *link = node.next[*link % 4];
        continue;
      }
      if (std::find(node.corners.begin(), node.corners.end(), b) != node.corners.end()) around_.push_back(*link / 4);
      link = &node.next[*link % 4];
    }
    std::sort(around_.begin() + begin, around_.end());
  }

  void finish() {
    lattice_.longest_.assign(at_.size(), 0);
    lattice_.around_offsets_.assign(at_.size() + 1, 0);
    for (Index t = 0; t < nodes_.size(); ++t) {
      if (nodes_[t].child != kNone) continue;
      const double longest = std::sqrt(nodes_[t].longest.length2);
      for (const Index c : nodes_[t].corners) {
        lattice_.longest_[c] = std::max(lattice_.longest_[c], longest);
        ++lattice_.around_offsets_[c + 1];
      }
      lattice_.tetrahedra_.push_back(nodes_[t].corners);
    }
    for (std::size_t p = 0; p < at_.size(); ++p) lattice_.around_offsets_[p + 1] += lattice_.around_offsets_[p];
    lattice_.around_.resize(4 * lattice_.tetrahedra_.size());
    std::vector<Index> next(lattice_.around_offsets_.begin(), lattice_.around_offsets_.end() - 1);
    for (Index t = 0; t < lattice_.tetrahedra_.size(); ++t) {
      for (const Index c : lattice_.tetrahedra_[t]) lattice_.around_[next[c]++] = t;
    }
  }

  GradedLattice& lattice_;
  std::vector<Vec3>& at_;
  std::vector<LatticeBall> balls_;  // in units, along the frame
  PlaceNumbers root_number_;
  std::vector<Node> nodes_;
  std::vector<Index> first_around_;  // of every point, encoded as Node::next
  std::vector<std::vector<Index>> roots_around_;
  std::vector<Index> last_ball_;  // of every root: the last ball that refined it
  std::vector<Index> around_;     // of the edges being bisected, back to back
};

GradedLattice::GradedLattice(const Vec3& origin, const Eigen::Matrix3d& frame, double spacing,
                             std::span<const LatticeBall> balls)
    : origin_(origin), frame_(frame), unit_(0.5 * spacing) {
  Maker(*this, balls).run();
}

}  // namespace vmesh
