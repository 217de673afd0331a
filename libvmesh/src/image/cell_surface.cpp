#include "image/cell_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/types.h"
#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

constexpr int kFaces = 6;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kEqualLength = 1e-9;  // squared lengths in cells that are equal but for rounding

// A tube's neck lies around the middle of both loops, drawn towards the two vertices that each of its own is between.
// Drawn further, more of the tubes between a corner and an edge cross themselves.
constexpr double kDrawn = 0.3;

/// Edges whose vertices are joined one after the other; the surface is to the left.
using Loop = std::vector<int>;

/// The ambiguous faces on which the inside is connected: bit n is the n-th ambiguous face of the pattern.
using FaceChoice = unsigned;

/// Corners of face 2 a + side of axis a, counter-clockwise seen from outside of the cell.
std::array<int, 4> corners_of_face(int face) {
  const int axis = face / 2, side = face % 2;
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
  if (side == 1) return {base, base + u, base + u + v, base + v};
  return {base, base + v, base + u + v, base + u};
}

int edge_between(int corner, int other) {
  const int step = corner ^ other, low = corner & other;
  if (step == 1) return low >> 1;
  if (step == 2) return 4 + (low & 1) + (low >> 2) * 2;
  return 8 + low;
}

std::array<int, 2> corners_of_edge(int edge) {
  const int axis = edge / 4, first = edge & 1, second = edge >> 1 & 1;
  const int low = axis == 0 ? 2 * first + 4 * second : axis == 1 ? first + 4 * second : first + 2 * second;
  return {low, low + (1 << axis)};
}

Vec3 middle_of_edge(int edge) {
  const std::array<int, 2> ends = corners_of_edge(edge);
  const auto at = [&](int axis) { return 0.5 * ((ends[0] >> axis & 1) + (ends[1] >> axis & 1)); };
  return {at(0), at(1), at(2)};
}

bool in_one_face(int edge, int other) {
  const Vec3 a = middle_of_edge(edge), b = middle_of_edge(other);
  for (int axis = 0; axis < 3; ++axis)
    if (a[axis] == b[axis] && a[axis] != 0.5) return true;
  return false;
}

bool is_inside(CellPattern pattern, int corner) { return (pattern >> corner & 1) != 0; }

bool is_ambiguous(CellPattern pattern, const std::array<int, 4>& face) {
  const bool first = is_inside(pattern, face[0]);
  return first == is_inside(pattern, face[2]) && first != is_inside(pattern, face[1]) &&
         first != is_inside(pattern, face[3]);
}

std::vector<int> ambiguous_faces(CellPattern pattern) {
  std::vector<int> faces;
  for (int face = 0; face < kFaces; ++face)
    if (is_ambiguous(pattern, corners_of_face(face))) faces.push_back(face);
  return faces;
}

bool connects_inside(CellPattern pattern, FaceChoice choice, int face) {
  const std::vector<int> faces = ambiguous_faces(pattern);
  const auto at = std::find(faces.begin(), faces.end(), face);
  return at != faces.end() && (choice >> (at - faces.begin()) & 1) != 0;
}

struct FaceDecision {
  FaceChoice choice = 0;
  bool tie = false;  ///< on some face
};

/// The asymptotic decider. Products of floats are exact in double, so the two cells of a face decide alike.
FaceDecision decided_by_values(CellPattern pattern, const std::vector<int>& faces, const CellValues& values) {
  FaceDecision decision;
  for (std::size_t n = 0; n < faces.size(); ++n) {
    const std::array<int, 4> face = corners_of_face(faces[n]);
    double inside = values[face[0]] * values[face[2]], outside = values[face[1]] * values[face[3]];
    if (!is_inside(pattern, face[0])) std::swap(inside, outside);
    if (inside > outside) decision.choice |= 1u << n;
    if (inside == outside) decision.tie = true;
  }
  return decision;
}

/// For every edge with a vertex, the next one on its loop: the surface leaves a face at an edge that goes out of the
/// inside (counter-clockwise), and enters it at one that goes in.
std::array<int, kCellEdges> next_edges(CellPattern pattern, FaceChoice choice) {
  std::array<int, kCellEdges> next;
  next.fill(-1);
  for (int face = 0; face < kFaces; ++face) {
    const std::array<int, 4> corners = corners_of_face(face);
    const bool around_outside = connects_inside(pattern, choice, face);
    for (int c = 0; c < 4; ++c) {
      if (is_inside(pattern, corners[c]) || !is_inside(pattern, corners[(c + 1) % 4])) continue;
      // Along the inside, or, where it is connected, around the outside corner, to where the inside is left.
      int out = around_outside ? (c + 3) % 4 : (c + 1) % 4;
      while (is_inside(pattern, corners[(out + 1) % 4])) out = (out + 1) % 4;
      next[edge_between(corners[c], corners[(c + 1) % 4])] = edge_between(corners[out], corners[(out + 1) % 4]);
    }
  }
  return next;
}

std::vector<Loop> loops_of(CellPattern pattern, FaceChoice choice) {
  std::array<int, kCellEdges> next = next_edges(pattern, choice);
  std::vector<Loop> loops;
  for (int first = 0; first < kCellEdges; ++first) {
    if (next[first] < 0) continue;
    Loop& loop = loops.emplace_back();
    for (int edge = first; next[edge] >= 0;) {
      loop.push_back(edge);
      edge = std::exchange(next[edge], -1);
    }
  }
  return loops;
}

/// Equiangle skewness, without bound where there is no area.
double badness(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 side = b - a, other = c - a;
  if (side.cross(other).norm() < 1e-9 * side.norm() * other.norm()) return kNever;
  return equiangle_skewness(a, b, c);
}

/// The triangles of the least sum of skewness for a loop without inner vertices, judged with vertices in the middle of
/// edges. Chords within a face are left to what the face itself has. Empty if there are none.
std::vector<std::array<std::uint8_t, 3>> triangulation(const Loop& loop, const Eigen::Matrix3d& steps) {
  const int count = static_cast<int>(loop.size());
  std::array<std::array<double, kCellEdges>, kCellEdges> cost{};
  std::array<std::array<int, kCellEdges>, kCellEdges> third{};
  const auto allowed = [&](int i, int j) {
    return j == i + 1 || (i == 0 && j == count - 1) || !in_one_face(loop[i], loop[j]);
  };
  std::vector<Vec3> middles;
  for (const int edge : loop) middles.emplace_back(steps * middle_of_edge(edge));
  for (int span = 2; span < count; ++span) {
    for (int i = 0; i + span < count; ++i) {
      const int j = i + span;
      cost[i][j] = kNever;
      for (int k = i + 1; allowed(i, j) && k < j; ++k) {
        const double with = cost[i][k] + cost[k][j] + badness(middles[i], middles[k], middles[j]);
        if (with >= cost[i][j] - 1e-9) continue;
        cost[i][j] = with;
        third[i][j] = k;
      }
    }
  }
  std::vector<std::array<std::uint8_t, 3>> triangles;
  if (cost[0][count - 1] == kNever) return triangles;
  std::vector<std::array<int, 2>> open = {{0, count - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j == i + 1) continue;
    const int k = third[i][j];
    triangles.push_back(
        {static_cast<std::uint8_t>(loop[i]), static_cast<std::uint8_t>(loop[k]), static_cast<std::uint8_t>(loop[j])});
    open.push_back({k, j});
    open.push_back({i, k});
  }
  return triangles;
}

void add_triangle(CellSurface& surface, int a, int b, int c) {
  surface.triangles.push_back(
      {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)});
}

/// A new inner vertex.
int add_inner(CellSurface& surface, const std::array<double, kCellEdges>& weights) {
  surface.inner.push_back(weights);
  return kCellEdges + static_cast<int>(surface.inner.size()) - 1;
}

void add_mean(const Loop& loop, double share, std::array<double, kCellEdges>& weights) {
  for (const int edge : loop) weights[edge] += share / static_cast<double>(loop.size());
}

/// A disk within the loop: triangles between its vertices, or around their mean.
void add_disk(CellSurface& surface, const Loop& loop, const Eigen::Matrix3d& steps) {
  const auto triangles = triangulation(loop, steps);
  surface.triangles.insert(surface.triangles.end(), triangles.begin(), triangles.end());
  if (!triangles.empty()) return;
  std::array<double, kCellEdges> mean{};
  add_mean(loop, 1, mean);
  const int middle = add_inner(surface, mean);
  for (std::size_t n = 0; n < loop.size(); ++n) add_triangle(surface, loop[n], loop[(n + 1) % loop.size()], middle);
}

/// The larger loop of a tube, the smaller one, and for every position in the larger one that in the smaller one which
/// lies across.
struct TubeEnds {
  Loop larger, smaller;
  std::vector<int> across;
};

/// Goes around both loops, the smaller one backwards, at an even pace.
TubeEnds opposed(const Loop& larger, const Loop& smaller, int start) {
  const int rows = static_cast<int>(larger.size()), columns = static_cast<int>(smaller.size());
  TubeEnds ends{larger, smaller, {}};
  for (int i = 0; i < rows; ++i) ends.across.push_back((start + columns - i * columns / rows) % columns);
  return ends;
}

double squared_length(const TubeEnds& ends) {
  double sum = 0;
  for (std::size_t i = 0; i < ends.larger.size(); ++i)
    sum += (middle_of_edge(ends.larger[i]) - middle_of_edge(ends.smaller[ends.across[i]])).squaredNorm();
  return sum;
}

/// The shortest tube, judged with vertices in the middle of edges; the last of equally short ones.
TubeEnds shortest_tube(Loop larger, Loop smaller) {
  if (larger.size() < smaller.size()) std::swap(larger, smaller);
  TubeEnds best = opposed(larger, smaller, 0);
  for (std::size_t turn = 0; turn < larger.size(); ++turn) {
    for (int start = 0; start < static_cast<int>(smaller.size()); ++start) {
      TubeEnds tried = opposed(larger, smaller, start);
      if (squared_length(tried) < squared_length(best) + kEqualLength) best = std::move(tried);
    }
    std::rotate(larger.begin(), larger.begin() + 1, larger.end());
  }
  return best;
}

/// Triangles between a closed line with the positions of the tube's larger loop and its smaller loop.
void add_band(CellSurface& surface, const std::vector<int>& line, const TubeEnds& ends) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t next = (i + 1) % line.size();
    const int here = ends.smaller[ends.across[i]], there = ends.smaller[ends.across[next]];
    add_triangle(surface, line[i], line[next], here);
    if (here != there) add_triangle(surface, there, here, line[next]);
  }
}

/// Whether some edge of the band between the loops themselves would lie in a face.
bool band_touches_face(const TubeEnds& ends) {
  const std::size_t count = ends.larger.size();
  for (std::size_t i = 0; i < count; ++i)
    for (const std::size_t at : {i, (i + 1) % count})
      if (in_one_face(ends.larger[at], ends.smaller[ends.across[i]])) return true;
  return false;
}

/// A tube between two loops. Where some edge of it would lie in a face, it gets a neck of inner vertices.
void add_tube(CellSurface& surface, const TubeEnds& ends) {
  const auto& [larger, smaller, across] = ends;
  if (!band_touches_face(ends)) {
    add_band(surface, larger, ends);
    return;
  }
  std::vector<int> neck;
  for (std::size_t i = 0; i < larger.size(); ++i) {
    std::array<double, kCellEdges> weights{};
    weights[larger[i]] += kDrawn / 2;
    weights[smaller[across[i]]] += kDrawn / 2;
    add_mean(larger, (1 - kDrawn) / 2, weights);
    add_mean(smaller, (1 - kDrawn) / 2, weights);
    neck.push_back(add_inner(surface, weights));
  }
  for (std::size_t i = 0; i < larger.size(); ++i) {
    const std::size_t next = (i + 1) % larger.size();
    add_triangle(surface, larger[i], larger[next], neck[next]);
    add_triangle(surface, larger[i], neck[next], neck[i]);
  }
  add_band(surface, neck, ends);
}

/// The corners of a cell, in sets of which each is connected.
using CornerSets = DisjointSets;

/// Connected on the boundary of the cell.
CornerSets connected_by_faces(CellPattern pattern, FaceChoice choice) {
  CornerSets sets(kCellCorners);
  for (int edge = 0; edge < kCellEdges; ++edge) {
    const auto [a, b] = corners_of_edge(edge);
    if (is_inside(pattern, a) == is_inside(pattern, b)) sets.join(a, b);
  }
  for (const int face : ambiguous_faces(pattern)) {
    const std::array<int, 4> corners = corners_of_face(face);
    const int at = is_inside(pattern, corners[0]) == connects_inside(pattern, choice, face) ? 0 : 1;
    sets.join(corners[at], corners[at + 2]);
  }
  return sets;
}

/// Least and greatest value of the polynomial p[0] + p[1] t + p[2] t^2 for t from `low` to `high`.
std::array<double, 2> range_of(const std::array<double, 3>& p, double low, double high) {
  const auto at = [&](double t) { return p[0] + t * (p[1] + t * p[2]); };
  std::array<double, 2> range = {std::min(at(low), at(high)), std::max(at(low), at(high))};
  const double turn = p[2] != 0 ? -p[1] / (2 * p[2]) : low;
  if (turn > low && turn < high) range = {std::min(range[0], at(turn)), std::max(range[1], at(turn))};
  return range;
}

/// Joins what the interpolant connects in the cell besides. It is bilinear in a slice of the cell at z = t. There,
/// every part of the inside or outside reaches an edge of the cell along z and so a corner of the cell. Only in slices
/// whose four values alternate are opposite edges connected: the two inside where the product of their values is the
/// greater, the two outside where it is the lesser. These products are quadratic in t.
void join_through_slices(const CellValues& values, CornerSets& sets) {
  std::array<double, 6> stops = {0, 1, 1, 1, 1, 1};
  for (int n = 0; n < 4; ++n)
    if ((values[n] > 0) != (values[n + 4] > 0)) stops[n + 1] = values[n] / (values[n] - values[n + 4]);
  std::sort(stops.begin(), stops.end());
  for (int s = 0; s < 5; ++s) {
    const double low = stops[s], high = stops[s + 1], middle = 0.5 * (low + high);
    if (!(low < high)) continue;
    std::array<bool, 4> inside;
    std::array<int, 4> corner;
    for (int n = 0; n < 4; ++n) {
      inside[n] = values[n] + middle * (values[n + 4] - values[n]) > 0;
      corner[n] = inside[n] == (values[n] > 0) ? n : n + 4;
    }
    if (inside[0] != inside[3] || inside[1] != inside[2] || inside[0] == inside[1]) continue;
    const auto product = [&](int m, int n) -> std::array<double, 3> {
      const double rise = values[m + 4] - values[m], other = values[n + 4] - values[n];
      return {values[m] * values[n], values[m] * other + values[n] * rise, rise * other};
    };
    const std::array<double, 3> p = product(0, 3), q = product(1, 2);
    const auto [least, greatest] = range_of({p[0] - q[0], p[1] - q[1], p[2] - q[2]}, low, high);
    if (greatest > 0) sets.join(corner[0], corner[3]);
    if (least < 0) sets.join(corner[1], corner[2]);
  }
}

/// The two loops that a tube joins: those between which, on the cell's boundary, there is one part of the inside or the
/// outside, and beyond which there are parts that are connected within the cell. {0, 0} if there are none.
std::array<std::size_t, 2> loops_of_tube(const std::vector<Loop>& loops, CellPattern pattern, CornerSets on_boundary,
                                         const CellValues& values) {
  CornerSets within = on_boundary;
  join_through_slices(values, within);
  const auto side = [&](const Loop& loop, bool inside) {
    const auto [a, b] = corners_of_edge(loop[0]);
    return static_cast<Index>(is_inside(pattern, a) == inside ? a : b);
  };
  for (std::size_t m = 1; m < loops.size(); ++m) {
    for (std::size_t n = 0; n < m; ++n) {
      for (const bool inside : {true, false}) {
        const Index between_m = side(loops[m], !inside), between_n = side(loops[n], !inside);
        const Index beyond_m = side(loops[m], inside), beyond_n = side(loops[n], inside);
        if (on_boundary.find(between_m) == on_boundary.find(between_n) &&
            on_boundary.find(beyond_m) != on_boundary.find(beyond_n) && within.find(beyond_m) == within.find(beyond_n))
          return {n, m};
      }
    }
  }
  return {0, 0};
}

CellSurface disks(const std::vector<Loop>& loops, const Eigen::Matrix3d& steps) {
  CellSurface surface;
  for (const Loop& loop : loops) add_disk(surface, loop, steps);
  return surface;
}

}  // namespace

CellSurfaces::CellSurfaces(const Eigen::Matrix3d& steps) : steps_(steps / steps.colwise().norm().maxCoeff()) {
  for (unsigned number = 0; number < 256; ++number) {
    const auto pattern = static_cast<CellPattern>(number);
    Possibilities& possible = possible_[number];
    possible.ambiguous_faces = ambiguous_faces(pattern);
    const FaceChoice choices = 1u << possible.ambiguous_faces.size();
    for (FaceChoice choice = 0; choice < choices; ++choice) {
      possible.loops.push_back(loops_of(pattern, choice));
      possible.disks.push_back(disks(possible.loops.back(), steps_));
    }
    if (choices == 1 && possible.loops[0].size() < 2) only_[number] = &possible.disks[0];
  }
}

const CellSurface& CellSurfaces::with_values(CellPattern pattern, const CellValues& values, CellSurface& room) const {
  const Possibilities& possible = possible_[pattern];
  const auto [choice, tie] = decided_by_values(pattern, possible.ambiguous_faces, values);
  const std::vector<Loop>& loops = possible.loops[choice];
  if (tie || loops.size() < 2) return possible.disks[choice];
  const auto [first, second] = loops_of_tube(loops, pattern, connected_by_faces(pattern, choice), values);
  if (first == second) return possible.disks[choice];
  room = {};
  for (std::size_t n = 0; n < loops.size(); ++n)
    if (n != first && n != second) add_disk(room, loops[n], steps_);
  add_tube(room, shortest_tube(loops[first], loops[second]));
  return room;
}

}  // namespace vmesh
