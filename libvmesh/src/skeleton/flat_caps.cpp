#include "flat_caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "ring_shape.h"
#include "wall_probe.h"
#include "wall_shells.h"

namespace vmesh::skeleton {
namespace {

constexpr double kFlat = 0.985;             // cosine between normals of a cap's faces: 10 degrees
constexpr double kCrease = 0.766;           // cosine between the cap's normal and the wall's at its edge: 40 degrees
constexpr double kSharp = 0.9;              // of the perimeter has such a crease
constexpr std::size_t kLeastRing = 6;       // vertices
constexpr double kLeastRoundness = 0.3;     // area of that of a circle with the perimeter
constexpr double kLargestUnevenness = 0.1;  // radii
// Behind a cap there is a tube: at these depths, so many of the directions across meet a wall at these distances, all
// in the cap's radii. The flat top of a ball with half the cap's curvature and more passes, one of a bump does not.
constexpr std::size_t kDirections = 12;
constexpr std::array<double, 2> kDepths = {0.5, 1};
constexpr std::array<std::size_t, 2> kLeastMet = {10, 8};
constexpr double kNearest = 0.5, kFarthest = 1.5;

class CapFinder {
 public:
  explicit CapFinder(const TriMesh& mesh) : mesh_(mesh), mates_(mates_of(mesh)), wall_(mesh) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const Vec3 normal = area_normal(mesh, f);
      areas_.push_back(0.5 * normal.norm());
      normals_.push_back(areas_.back() > 0 ? Vec3(normal.normalized()) : Vec3(Vec3::Zero()));
    }
  }

  double area(Index f) const { return areas_[f]; }

  /// The flat patch around a face, in the order in which it was found, of faces that are not `seen`; they become so.
  std::vector<Index> patch_around(Index seed, std::vector<bool>& seen) const {
    std::vector<Index> patch = {seed};
    seen[seed] = true;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (Index side = 3 * patch[i]; side < 3 * patch[i] + 3; ++side) {
        const Index next = mates_[side] == kNone ? kNone : mates_[side] / 3;
        if (next == kNone || seen[next]) continue;
        if (areas_[next] > 0 && !(normals_[next].dot(normals_[seed]) > kFlat)) continue;
        seen[next] = true;
        patch.push_back(next);
      }
    }
    return patch;
  }

  std::optional<FlatWallEnd> cap_of(const std::vector<Index>& patch) {
    in_patch_.resize(mesh_.faces.size(), false);
    for (const Index f : patch) in_patch_[f] = true;
    std::optional<FlatWallEnd> cap = cap_of_marked(patch);
    for (const Index f : patch) in_patch_[f] = false;
    return cap;
  }

 private:
  Index from(Index side) const { return mesh_.faces[side / 3][side % 3]; }
  Index to(Index side) const { return mesh_.faces[side / 3][(side + 1) % 3]; }
  Index opposite(Index side) const { return mesh_.faces[side / 3][(side + 2) % 3]; }

  std::vector<Index> border_of(const std::vector<Index>& patch) const {
    std::vector<Index> border;
    for (const Index f : patch) {
      for (Index side = 3 * f; side < 3 * f + 3; ++side) {
        if (mates_[side] == kNone || !in_patch_[mates_[side] / 3]) border.push_back(side);
      }
    }
    return border;
  }

  /// The border's vertices in order, if it is one loop.
  std::vector<Index> loop_of(const std::vector<Index>& border) const {
    std::vector<std::pair<Index, Index>> ways;
    for (const Index side : border) ways.push_back({from(side), to(side)});
    std::sort(ways.begin(), ways.end());
    std::vector<Index> loop;
    Index v = ways.front().first;
    do {
      const auto way = std::lower_bound(ways.begin(), ways.end(), std::pair(v, Index{0}));
      if (way == ways.end() || way->first != v || (way + 1 != ways.end() && (way + 1)->first == v)) return {};
      loop.push_back(v);
      v = way->second;
    } while (v != loop.front() && loop.size() < ways.size());
    if (v != loop.front() || loop.size() != ways.size()) return {};
    return loop;
  }

  bool is_sharp(const std::vector<Index>& border, const Vec3& normal) const {
    double sharp = 0, all = 0;
    for (const Index side : border) {
      const double length = (mesh_.vertices[to(side)] - mesh_.vertices[from(side)]).norm();
      all += length;
      const Index other = mates_[side];
      if (other == kNone) continue;
      const bool folds_down = (mesh_.vertices[opposite(other)] - mesh_.vertices[from(other)]).dot(normal) < 0;
      if (folds_down && normals_[other / 3].dot(normal) < kCrease) sharp += length;
    }
    return sharp >= kSharp * all;
  }

  bool closes_a_tube(const RingShape& shape) const {
    const Vec3 u = shape.normal.unitOrthogonal(), v = shape.normal.cross(u);
    for (std::size_t d = 0; d < kDepths.size(); ++d) {
      const Vec3 middle = shape.center - kDepths[d] * shape.radius * shape.normal;
      std::size_t met = 0;
      for (std::size_t i = 0; i < kDirections; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kDirections;
        const Vec3 out = shape.radius * (std::cos(angle) * u + std::sin(angle) * v);
        if (wall_.meets(middle + kNearest * out, middle + kFarthest * out)) ++met;
      }
      if (met < kLeastMet[d]) return false;
    }
    return true;
  }

  std::optional<FlatWallEnd> cap_of_marked(const std::vector<Index>& patch) const {
    const std::vector<Index> border = border_of(patch);
    if (border.size() < kLeastRing) return std::nullopt;
    const std::vector<Index> loop = loop_of(border);
    if (loop.empty()) return std::nullopt;
    std::vector<Vec3> ring;
    for (const Index v : loop) ring.push_back(mesh_.vertices[v]);
    const RingShape shape = shape_of(ring);
    const double circle = shape.perimeter * shape.perimeter / (4 * std::numbers::pi);
    if (!(shape.area >= kLeastRoundness * circle) || shape.unevenness > kLargestUnevenness * shape.radius ||
        !is_sharp(border, shape.normal) || !closes_a_tube(shape))
      return std::nullopt;
    return FlatWallEnd{shape.center, shape.normal, shape.area, std::move(ring), false, 0};
  }

  const TriMesh& mesh_;
  Mates mates_;
  WallProbe wall_;
  std::vector<Vec3> normals_;
  std::vector<double> areas_;
  std::vector<bool> in_patch_;
};

}  // namespace

void find_flat_caps(Shell& shell, std::size_t& caps) {
  CapFinder finder(shell.part.mesh);
  std::vector<bool> seen(shell.part.mesh.faces.size(), false);
  std::vector<Index> order;
  for (Index f = 0; f < seen.size(); ++f) {
    seen[f] = shell.part.end_of_face[f] != kNone || shell.part.is_filling[f];
    if (!seen[f] && finder.area(f) > 0) order.push_back(f);
  }
  // From large faces: small ones may lean any way.
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return finder.area(a) > finder.area(b); });
  for (const Index seed : order) {
    if (seen[seed]) continue;
    const std::vector<Index> patch = finder.patch_around(seed, seen);
    std::optional<FlatWallEnd> cap = finder.cap_of(patch);
    if (!cap) continue;
    for (const Index f : patch) shell.part.end_of_face[f] = static_cast<Index>(shell.ends.size());
    shell.ends.push_back(std::move(*cap));
    ++caps;
  }
}

}  // namespace vmesh::skeleton
