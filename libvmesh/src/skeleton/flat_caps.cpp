#include "flat_caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "ring_shape.h"
#include "wall_probe.h"
#include "wall_shells.h"

namespace vmesh::skeleton {
namespace {

constexpr double kFlat = 0.985;  // cosine between normals of a cap's faces: 10 degrees
// Faces at its rim lean less than the crease within the first number of radii from its plane, or in any way within the
// second.
constexpr double kRim = 0.08, kSliver = 0.005;
constexpr double kCrease = 0.766;           // cosine between the cap's normal and the wall's at its edge: 40 degrees
constexpr double kSharp = 0.9;              // of the perimeter has such a crease
constexpr std::size_t kLeastRing = 6;       // vertices
constexpr double kLeastRoundness = 0.3;     // area relative to that of a circle with the perimeter
constexpr double kLargestUnevenness = 0.1;  // radii
// Least share of the turning along the ring that is in corners beyond this angle: 70 degrees. Rims of voxels have no
// other.
constexpr double kCornered = 0.5, kCorner = 1.22;
// Least share of the area that is parallel to a step on contours of masks, besides that in a few planes: other caps may
// be.
constexpr double kParallel = 1 - 1e-6, kStairs = 0.02;
constexpr std::size_t kOtherCaps = 3;
// Behind a cap there is a tube: at these depths, at least these numbers of the directions across meet a wall at these
// distances, all in the cap's radii. The flat top of a ball with half the cap's curvature and more passes, one of a
// bump does not.
constexpr std::size_t kDirections = 12;
constexpr std::array<double, 2> kDepths = {0.5, 1};
constexpr std::array<std::size_t, 2> kLeastMet = {10, 8};
constexpr double kNearest = 0.5, kFarthest = 1.5;

bool is_cornered(const std::vector<Vec3>& ring) {
  double corners = 0, all = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 &a = ring[i], &b = ring[(i + 1) % ring.size()], &c = ring[(i + 2) % ring.size()];
    const double turning = std::atan2((b - a).cross(c - b).norm(), (b - a).dot(c - b));
    all += turning;
    if (turning > kCorner) corners += turning;
  }
  return corners > kCornered * all;
}

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
    grow(patch, seen, [&](Index f) { return !(areas_[f] > 0) || normals_[f].dot(normals_[seed]) > kFlat; });
    return patch;
  }

  /// With small faces at its rim that lean, as rounding and remeshing leave them. `taken`: faces that are out of
  /// question; unchanged.
  std::vector<Index> with_rim(std::vector<Index> patch, std::vector<bool>& taken) const {
    double area = 0;
    Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();
    for (const Index f : patch) {
      area += areas_[f];
      normal += areas_[f] * normals_[f];
      for (const Index v : mesh_.faces[f]) middle += areas_[f] / 3 * mesh_.vertices[v];
    }
    middle /= area;
    normal.normalize();
    const double radius = std::sqrt(area / std::numbers::pi);
    for (const Index f : patch) taken[f] = true;
    grow(patch, taken, [&](Index f) {
      double farthest = 0;
      for (const Index v : mesh_.faces[f])
        farthest = std::max(farthest, std::abs((mesh_.vertices[v] - middle).dot(normal)));
      const bool leans = areas_[f] > 0 && !(normals_[f].dot(normal) > kCrease);
      return farthest <= (leans ? kSliver : kRim) * radius;
    });
    for (const Index f : patch) taken[f] = false;
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
  /// Appends neighbours that fit and are not taken; they become so.
  template <class Fits>
  void grow(std::vector<Index>& patch, std::vector<bool>& taken, Fits&& fits) const {
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (Index side = 3 * patch[i]; side < 3 * patch[i] + 3; ++side) {
        const Index next = mates_[side] == kNone ? kNone : mates_[side] / 3;
        if (next == kNone || taken[next] || !fits(next)) continue;
        taken[next] = true;
        patch.push_back(next);
      }
    }
  }

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

  bool is_step_of_stairs(const RingShape& shape) const {
    std::vector<std::pair<double, double>> parallel;  // heights and areas
    double all = 0;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      all += areas_[f];
      if (in_patch_[f] || !(std::abs(normals_[f].dot(shape.normal)) > kParallel)) continue;
      parallel.push_back({(mesh_.vertices[mesh_.faces[f][0]] - shape.center).dot(shape.normal), areas_[f]});
    }
    std::sort(parallel.begin(), parallel.end());
    std::vector<double> planes;  // their areas
    for (std::size_t i = 0; i < parallel.size(); ++i) {
      if (i == 0 || parallel[i].first - parallel[i - 1].first > kRim * shape.radius) planes.push_back(0);
      planes.back() += parallel[i].second;
    }
    std::sort(planes.begin(), planes.end(), std::greater<>());
    double steps = 0;
    for (std::size_t i = kOtherCaps; i < planes.size(); ++i) steps += planes[i];
    return steps > kStairs * all;
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
        is_cornered(ring) || !is_sharp(border, shape.normal) || !closes_a_tube(shape) || is_step_of_stairs(shape))
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
    seen[f] = shell.part.end_of_face[f] != kNone;
    if (!seen[f] && !shell.part.is_filling[f] && finder.area(f) > 0) order.push_back(f);
  }
  // From large faces: small ones may lean any way.
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return finder.area(a) > finder.area(b); });
  std::vector<bool> taken = seen;
  for (const Index seed : order) {
    if (seen[seed]) continue;
    const std::vector<Index> patch = finder.with_rim(finder.patch_around(seed, seen), taken);
    std::optional<FlatWallEnd> cap = finder.cap_of(patch);
    if (!cap) continue;
    for (const Index f : patch) {
      seen[f] = taken[f] = true;
      shell.part.end_of_face[f] = static_cast<Index>(shell.ends.size());
    }
    shell.ends.push_back(std::move(*cap));
    ++caps;
  }
}

}  // namespace vmesh::skeleton
