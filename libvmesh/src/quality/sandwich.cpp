#include "quality/sandwich.h"

#include <array>
#include <cmath>
#include <numeric>

namespace vmesh {
namespace {

// The first of the vertices that lie at the same place, for every vertex.
std::vector<Index> merge_coincident(const std::vector<Vec3>& points) {
  std::vector<Index> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto before = [&](Index i, Index j) {
    return std::lexicographical_compare(points[i].begin(), points[i].end(), points[j].begin(), points[j].end());
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

bool even_at_every_edge(const std::vector<Triangle>& faces) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * faces.size());
  for (const Triangle& f : faces) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(f[i], f[(i + 1) % 3]);
      if (low != high) edges.push_back(std::uint64_t{low} << 32 | high);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
  }
  return true;
}

// The triangle's frame: z along its normal, the origin in its middle.
struct Slab {
  Vec3 center, x, y, z;
  std::array<Eigen::Vector2d, 3> corners;  // counter-clockwise

  explicit Slab(const std::array<Vec3, 3>& t) : center((t[0] + t[1] + t[2]) / 3) {
    z = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    x = (t[1] - t[0]).normalized();
    y = z.cross(x);
    for (int i = 0; i < 3; ++i) corners[i] = {x.dot(t[i] - center), y.dot(t[i] - center)};
  }
  // Of a thin triangle the normal may be too far off.
  bool flat(const std::array<Vec3, 3>& t, double rounding) const {
    const auto off = [&](const Vec3& p) { return std::abs(z.dot(p - center)); };
    return std::max({off(t[0]), off(t[1]), off(t[2])}) <= rounding;
  }
  Vec3 local(const Vec3& p) const { return {x.dot(p - center), y.dot(p - center), z.dot(p - center)}; }
};

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Whether a line through an edge of the slab's triangle has all of `t` on its outer side.
bool beside(const Slab& slab, const std::array<Vec3, 3>& t, double rounding) {
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d from = slab.corners[i], edge = slab.corners[(i + 1) % 3] - from;
    const double margin = rounding * edge.lpNorm<1>();
    bool outside = true;
    for (const Vec3& p : t) outside = outside && cross(edge, p.head<2>() - from) < -margin;
    if (outside) return true;
  }
  return false;
}

enum class Crossed { no, yes, unclear };

// Whether the z axis passes through `t`.
Crossed crosses_axis(const std::array<Vec3, 3>& t, double rounding) {
  bool positive = false, negative = false, unclear = false;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d p = t[i].head<2>(), q = t[(i + 1) % 3].head<2>();
    const double area = cross(p, q), margin = rounding * (p.lpNorm<1>() + q.lpNorm<1>());
    positive = positive || area > margin;
    negative = negative || area < -margin;
    unclear = unclear || std::abs(area) <= margin;
  }
  if (positive && negative) return Crossed::no;
  return unclear ? Crossed::unclear : Crossed::yes;
}

}  // namespace

bool bounds_a_volume(const TriMesh& mesh) {
  if (even_at_every_edge(mesh.faces)) return true;
  const std::vector<Index> first = merge_coincident(mesh.vertices);
  std::vector<Triangle> faces = mesh.faces;
  for (Triangle& f : faces) {
    for (Index& v : f) v = first[v];
  }
  return even_at_every_edge(faces);
}

Sandwich::Sandwich(const TriMesh& mesh, const TriangleTree& tree)
    : mesh_(mesh),
      tree_(tree),
      rounding_(0x1p-44 * (tree.extent().magnitude() + tree.extent().diagonal())),
      closed_(bounds_a_volume(mesh)) {}

bool Sandwich::within(const std::array<Vec3, 3>& triangle, double s) {
  const Slab slab(triangle);
  if (!slab.flat(triangle, rounding_ / 2)) return false;
  double reach2 = 0;
  for (const auto& corner : slab.corners) reach2 = std::max(reach2, corner.squaredNorm());
  near_.clear();
  tree_.faces_in_ball(slab.center, std::sqrt(reach2 + s * s) * (1 + 0x1p-40), near_);
  int crossings = 0;
  for (const Index f : near_) {
    std::array<Vec3, 3> t;
    for (int i = 0; i < 3; ++i) t[i] = slab.local(mesh_.vertices[mesh_.faces[f][i]]);
    const double low = std::min({t[0].z(), t[1].z(), t[2].z()}), high = std::max({t[0].z(), t[1].z(), t[2].z()});
    const bool between = low > -s + rounding_ && high < s - rounding_;
    const bool apart = low > s + rounding_ || high < -s - rounding_;
    if (!between && !apart && !beside(slab, t, rounding_)) return false;
    if (!between) continue;  // it is beside the axis, or beyond the moved triangles
    const Crossed crossed = crosses_axis(t, rounding_);
    if (crossed == Crossed::unclear) return false;
    crossings += crossed == Crossed::yes;
  }
  return crossings % 2 == 1;
}

}  // namespace vmesh
