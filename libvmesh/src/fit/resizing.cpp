#include "fit/resizing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "vmesh/mesh/triangle_quality.h"

#include "fit/reshaping.h"

namespace vmesh::fitting {
namespace {

constexpr double kLong = 4.0 / 3, kShort = 4.0 / 5;  // of the intended length (Botsch, Kobbelt 2004)
constexpr int kBisections = 16;                      // of an interval of 10^6: to 0.02 %
constexpr double kCollapsedSkewness = 0.45;
constexpr double kBentByCollapse = 0.5;  // least cosine between a triangle's normals before and after a collapse

using Neighbours = std::vector<std::vector<Index>>;

Neighbours all_neighbours(const FitMesh& surface) {
  Neighbours neighbours(surface.vertices().size());
  for (Index v = 0; v < neighbours.size(); ++v) surface.neighbours(v, neighbours[v]);
  return neighbours;
}

// Averages each value with the mean of its neighbours; negative values do not count.
void smooth(const Neighbours& neighbours, std::vector<double>& values) {
  const std::vector<double> old = values;
  for (Index v = 0; v < values.size(); ++v) {
    const std::vector<Index>& near = neighbours[v];
    double sum = 0;
    int count = 0;
    const auto add = [&](double value, int weight) {
      if (value < 0) return;
      sum += weight * value;
      count += weight;
    };
    add(old[v], static_cast<int>(near.size()));
    for (const Index w : near) add(old[w], 1);
    if (count > 0) values[v] = sum / count;
  }
}

double length_of(const FitMesh& surface, Index a, Index b) {
  return (surface.position(a) - surface.position(b)).norm();
}
double size_of(const FitMesh& surface, Index a, Index b) {
  return 0.5 * (surface.vertices()[a].size + surface.vertices()[b].size);
}

// How many triangles of the given sizes cover the surface.
double face_count(const FitMesh& surface, const std::vector<double>& size) {
  double count = 0;
  for (Index f = 0; f < surface.faces().size(); ++f) {
    const auto& [a, b, c] = surface.faces()[f];
    const double h = (size[a] + size[b] + size[c]) / 3;
    count += surface.area_normal(f).norm() / (h * h);
  }
  return count;
}

// Sizes never grow faster than `grading` over distance.
void grade(const FitMesh& surface, const Neighbours& neighbours, std::vector<double>& size, double grading) {
  for (bool changed = true; changed;) {
    changed = false;
    for (Index v = 0; v < size.size(); ++v) {
      for (const Index w : neighbours[v]) {
        const double most = size[w] + grading * length_of(surface, v, w);
        if (size[v] > most * (1 + 1e-9)) {
          size[v] = most;
          changed = true;
        }
      }
    }
  }
}

bool may_collapse_to(const FitMesh& surface, Index a, Index b, const Vec3& p, const StepGuard& guard) {
  double worst_before = 0, worst = 0;
  for (const Index end : {a, b}) {
    for (const Index f : surface.faces_around(end)) {
      const Triangle& face = surface.faces()[f];
      std::array<Vec3, 3> corners = surface.corners(f);
      const bool both =
          std::find(face.begin(), face.end(), a) != face.end() && std::find(face.begin(), face.end(), b) != face.end();
      if (both) continue;
      worst_before = std::max(worst_before, equiangle_skewness(corners[0], corners[1], corners[2]));
      const Vec3 before = surface.unit_normal(f);
      for (int i = 0; i < 3; ++i) {
        if (face[i] == end) corners[i] = p;
      }
      const Vec3 after = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      if (!(after.dot(before) > kBentByCollapse * after.norm())) return false;
      worst = std::max(worst, equiangle_skewness(corners[0], corners[1], corners[2]));
      for (int i = 0; i < 3; ++i) {  // must not create an edge that would be split again
        if (face[i] == end) continue;
        const double h = 0.5 * (surface.vertices()[face[i]].size + size_of(surface, a, b));
        if ((p - surface.position(face[i])).norm() > kLong * h) return false;
      }
    }
  }
  return worst <= std::max({kCollapsedSkewness, guard.max_skewness, worst_before});
}

struct LengthOfEdge {
  double ratio;  // of its length to the intended one
  Index a, b;

  bool operator<(const LengthOfEdge& other) const {
    return std::tie(ratio, a, b) < std::tie(other.ratio, other.a, other.b);
  }
};

std::vector<LengthOfEdge> edge_lengths(const FitMesh& surface, const std::vector<char>& frozen) {
  std::vector<LengthOfEdge> edges;
  for (const auto& [a, b] : surface.edges()) {
    if (is_frozen(frozen, a) || is_frozen(frozen, b)) continue;
    edges.push_back({length_of(surface, a, b) / size_of(surface, a, b), a, b});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<double> errors_around(const FitMesh& surface, const Matches& matches) {
  std::vector<double> sum(surface.vertices().size(), 0), area(surface.vertices().size(), 0);
  const auto add = [&](const Match& match) {
    if (match.face == kNone) return;
    for (int i = 0; i < 3; ++i) {
      const double weight = match.area * match.weights[i];
      sum[surface.faces()[match.face][i]] += weight * std::abs(match.distance * match.distance * match.distance);
      area[surface.faces()[match.face][i]] += weight;
    }
  };
  for (const Match& match : matches.from_surface) add(match);
  for (const Match& match : matches.from_reference) add(match);
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = area[v] > 0 ? sum[v] / area[v] : -1;
  smooth(all_neighbours(surface), sum);
  for (double& value : sum) value = value < 0 ? value : std::cbrt(value);
  return sum;
}

double set_sizes(FitMesh& surface, const std::vector<double>& errors, std::size_t vertices, double error,
                 const SizeLimits& limits) {
  const std::size_t count = surface.vertices().size();
  std::vector<double> now(count), size(count);
  for (Index v = 0; v < count; ++v) now[v] = surface.mean_edge(v);
  const Neighbours neighbours = all_neighbours(surface);
  smooth(neighbours, now);
  const double faces_per_unit = static_cast<double>(surface.faces().size()) / face_count(surface, now);
  // A number of triangles gives the least sum of squares where errors times sizes are even (squared error e^2 ~ h^4 and
  // count ~ 1 / h^2 per area: the gain by one more triangle is e^2 h^2).
  const auto factor = [&](double target, Index v) {
    if (!(errors[v] > 0)) return 1.0;
    return vertices > 0 ? std::cbrt(target / (errors[v] * now[v])) : std::sqrt(target / errors[v]);
  };
  const auto sizes_for = [&](double target) {
    for (Index v = 0; v < count; ++v) {
      const double base = surface.vertices()[v].base_size;
      double wanted = factor(target, v);
      if (errors[v] > kNotOfSize * now[v]) wanted = std::max(wanted, 1.0);  // refinement would not help
      const double lowest = limits.finest * base, highest = limits.coarsest * base;
      size[v] = std::clamp(now[v] * std::clamp(wanted, 1 / limits.step, limits.step), lowest, highest);
    }
    grade(surface, neighbours, size, limits.grading);
    return faces_per_unit * face_count(surface, size);
  };
  double faces = 0;
  if (vertices > 0) {
    double largest = 0;
    for (Index v = 0; v < count; ++v) largest = std::max(largest, 10 * errors[v] * now[v]);
    faces =
        static_cast<double>(surface.faces().size()) + 2 * (static_cast<double>(vertices) - static_cast<double>(count));
    double low = 1e-6 * largest, high = largest;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = std::sqrt(low * high);
      (sizes_for(middle) > faces ? low : high) = middle;
    }
    // The sizes are limited: the remaining factor is applied everywhere.
    const double scale = std::sqrt(sizes_for(high) / faces);
    for (double& h : size) h *= scale;
  } else {
    faces = sizes_for(error);
  }
  for (Index v = 0; v < count; ++v) surface.edit(v).size = size[v];
  return faces;
}

void split_edges(FitMesh& surface, const std::vector<char>& frozen) {
  const std::vector<LengthOfEdge> edges = edge_lengths(surface, frozen);
  for (auto edge = edges.rbegin(); edge != edges.rend() && edge->ratio > kLong; ++edge) {
    const auto [ratio, a, b] = *edge;
    if (!surface.is_inner(MeshEdge{a, b})) continue;
    const Vec3 middle = 0.5 * (surface.position(a) + surface.position(b));
    surface.take(surface.splitting({a, b}, FitVertex::between(surface.vertex(a), surface.vertex(b), middle)));
  }
}

void collapse_edges(FitMesh& surface, const std::vector<char>& frozen, const StepGuard& guard) {
  for (const auto& [old_ratio, a, b] : edge_lengths(surface, frozen)) {
    if (old_ratio > kShort) break;
    if (!surface.has_vertex(a) || !surface.has_vertex(b) || surface.face_of(a, b) == kNone) continue;
    if (length_of(surface, a, b) > kShort * size_of(surface, a, b) || !surface.may_collapse({a, b})) continue;
    const Vec3 p = 0.5 * (surface.position(a) + surface.position(b));
    if (!may_collapse_to(surface, a, b, p, guard)) continue;
    FitVertex one = surface.vertex(a);
    one.position = p;
    one.size = size_of(surface, a, b);
    surface.take(surface.collapsing(b, a, one));
  }
}

}  // namespace vmesh::fitting
