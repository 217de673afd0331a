#include "wall_voxels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wall_probe.h"

namespace vmesh::skeleton {
namespace {

constexpr double kPerRadius = 3;
constexpr double kMostVoxels = 6e5;
constexpr std::size_t kBalls = 2000;  // places where the radius is measured
constexpr double kNoiseShare = 0.1;   // of the area: the rest is noise
constexpr int kMostShrinks = 12;

/// The radius of the largest ball inside the wall that touches it at `p` (Ma et al. 2012, shrinking balls).
double ball_at(const WallProbe& probe, const Vec3& p, const Vec3& normal, double largest) {
  double radius = largest;
  for (int i = 0; i < kMostShrinks; ++i) {
    const Vec3 center = p - radius * normal;
    const WallProbe::Nearest nearest = probe.nearest(center);
    if (nearest.distance >= 0.99 * radius) break;
    const Vec3 way = p - nearest.point;
    const double along = way.dot(normal);
    if (!(along > 0)) break;
    radius = std::min(radius, way.squaredNorm() / (2 * along));
  }
  return radius;
}

/// Faces at even distances in the sum of the areas.
std::vector<Index> spread_faces(const TriMesh& mesh, std::size_t count) {
  std::vector<double> sums(mesh.faces.size());
  double sum = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) sums[f] = sum += 0.5 * area_normal(mesh, f).norm();
  std::vector<Index> faces;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = sum * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    faces.push_back(static_cast<Index>(std::lower_bound(sums.begin(), sums.end(), at) - sums.begin()));
  }
  return faces;
}

/// A column of voxels along the first axis and where a wall crosses it.
struct ColumnCrossing {
  std::size_t column;
  double at;  ///< in voxels
  int way;    ///< 1: into the wall's inside, -1: out of it
};

/// Twice the signed area of (a, b, p) in the plane of the second and third axis. Exactly opposite for (b, a, p), so
/// that columns at a common edge belong to one of its faces.
double side(const Vec3& a, const Vec3& b, double y, double z) {
  const bool swap = std::pair(a.y(), a.z()) > std::pair(b.y(), b.z());
  const Vec3 &p = swap ? b : a, &q = swap ? a : b;
  const double area = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y());
  return swap ? -area : area;
}

/// Whether a column on the edge itself counts as on its left.
bool owns(const Vec3& a, const Vec3& b) { return a.z() != b.z() ? a.z() < b.z() : a.y() < b.y(); }

class Columns {
 public:
  Columns(const std::array<std::size_t, 3>& size) : size_(size) {}

  /// Adds the crossings with a face whose corners are in voxels.
  void add(const std::array<Vec3, 3>& face) {
    const auto [low_y, high_y] = std::minmax({face[0].y(), face[1].y(), face[2].y()});
    const auto [low_z, high_z] = std::minmax({face[0].z(), face[1].z(), face[2].z()});
    const double area = side(face[0], face[1], face[2].y(), face[2].z());
    if (area == 0) return;
    const bool turned = area < 0;
    const Vec3 &a = face[0], &b = turned ? face[2] : face[1], &c = turned ? face[1] : face[2];
    for (double z = std::max(std::ceil(low_z), 0.0); z <= high_z && z < static_cast<double>(size_[2]); ++z) {
      for (double y = std::max(std::ceil(low_y), 0.0); y <= high_y && y < static_cast<double>(size_[1]); ++y) {
        const double u = side(b, c, y, z), v = side(c, a, y, z), w = side(a, b, y, z);
        if (!is_left(u, b, c) || !is_left(v, c, a) || !is_left(w, a, b)) continue;
        const double sum = u + v + w;
        const double x = (u * a.x() + v * b.x() + w * c.x()) / sum;
        const auto column = static_cast<std::size_t>(z) * size_[1] + static_cast<std::size_t>(y);
        crossings_.push_back({column, x, turned ? 1 : -1});
      }
    }
  }

  VoxelSet voxels() {
    std::sort(crossings_.begin(), crossings_.end(), [](const ColumnCrossing& a, const ColumnCrossing& b) {
      return std::tie(a.column, a.at, a.way) < std::tie(b.column, b.at, b.way);
    });
    VoxelSet voxels(size_);
    int winding = 0;
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      const ColumnCrossing& from = crossings_[i];
      winding = (i > 0 && crossings_[i - 1].column == from.column ? winding : 0) + from.way;
      if (winding <= 0 || i + 1 == crossings_.size() || crossings_[i + 1].column != from.column) continue;
      const auto first = static_cast<int>(std::ceil(std::max(from.at, 0.0)));
      const auto end = static_cast<int>(std::ceil(std::min(crossings_[i + 1].at, static_cast<double>(size_[0]))));
      voxels.insert_row(first, end, static_cast<int>(from.column % size_[1]), static_cast<int>(from.column / size_[1]));
    }
    return voxels;
  }

 private:
  static bool is_left(double area, const Vec3& a, const Vec3& b) { return area > 0 || (area == 0 && owns(a, b)); }

  std::array<std::size_t, 3> size_;
  std::vector<ColumnCrossing> crossings_;
};

}  // namespace

double voxel_size_for(const TriMesh& wall, double volume) {
  double area = 0;
  for (Index f = 0; f < wall.faces.size(); ++f) area += 0.5 * area_normal(wall, f).norm();
  const double mean = 2 * volume / area;  // of a long cylinder
  const WallProbe probe(wall);
  std::vector<double> radii;
  for (const Index f : spread_faces(wall, kBalls)) {
    const Vec3 normal = area_normal(wall, f);
    if (!(normal.norm() > 0)) continue;
    const auto& [a, b, c] = wall.faces[f];
    radii.push_back(
        ball_at(probe, (wall.vertices[a] + wall.vertices[b] + wall.vertices[c]) / 3, normal.normalized(), 2 * mean));
  }
  std::sort(radii.begin(), radii.end());
  const double thinnest =
      radii.empty() ? mean : radii[static_cast<std::size_t>(kNoiseShare * static_cast<double>(radii.size()))];
  return std::max(std::min(thinnest, mean) / kPerRadius, std::cbrt(volume / kMostVoxels));
}

VoxelVolume voxels_inside(const TriMesh& wall, double voxel) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : wall.vertices) box.extend(p);
  // Off the round numbers that corners often have.
  const Vec3 shift = voxel * Vec3(0.5390, 0.5432, 0.5471);
  VoxelVolume result;
  result.frame.steps = voxel * Eigen::Matrix3d::Identity();
  result.frame.origin = box.min() - voxel * Vec3::Ones() + shift;
  std::array<std::size_t, 3> size{};
  for (int a = 0; a < 3; ++a)
    size[static_cast<std::size_t>(a)] =
        static_cast<std::size_t>(std::ceil((box.max()[a] - result.frame.origin[a]) / voxel)) + 2;
  Columns columns(size);
  for (const Triangle& face : wall.faces) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = (wall.vertices[face[i]] - result.frame.origin) / voxel;
    columns.add(corners);
  }
  result.voxels = columns.voxels();
  result.voxels.number_voxels();
  return result;
}

}  // namespace vmesh::skeleton
