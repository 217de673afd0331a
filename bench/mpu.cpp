#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>

#include "vmesh/core/box_tree.h"
#include "vmesh/image/contour.h"
#include "vmesh/reference/sampled_field.h"

#include "grid.h"
#include "related_work.h"

namespace vmesh::bench {
namespace {

// The numbers of Ohtake et al.: support of a cell relative to its diagonal, fewest points of a fit, growth of a ball
// that has fewer relative to the support, and the neighbours that tell distances at auxiliary points.
constexpr double kSupport = 0.75;
constexpr std::size_t kFewestPoints = 15;
constexpr double kGrowth = 0.1;
constexpr std::size_t kNeighbours = 6;
constexpr int kDeepest = 12;
constexpr double kRidge = 1e-9;  // relative: fits of few points stay solvable
constexpr double kBand = 2;      // voxels of the mask from its points, within which the fits decide

struct OrientedPoint {
  Vec3 position, normal;
};

bool is_inside(const VoxelImage& mask, std::size_t i, std::size_t j, std::size_t k) { return mask.at(i, j, k) >= 0; }

// Out of the mask around a point between two voxels: where voxels outside are, weighted by a Gaussian.
Vec3 normal_at(const VoxelImage& mask, const Vec3& p, const std::array<std::size_t, 3>& voxel) {
  const double side = mask.steps(0, 0);
  Vec3 normal = Vec3::Zero();
  std::array<std::size_t, 3> low, high;
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = voxel[a] - std::min<std::size_t>(voxel[a], 2);
    high[a] = std::min(mask.size[a] - 1, voxel[a] + 2);
  }
  for (std::size_t k = low[2]; k <= high[2]; ++k) {
    for (std::size_t j = low[1]; j <= high[1]; ++j) {
      for (std::size_t i = low[0]; i <= high[0]; ++i) {
        const Vec3 index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const Vec3 way = (mask.position(index) - p) / side;
        normal += (is_inside(mask, i, j, k) ? -1 : 1) * std::exp(-0.5 * way.squaredNorm()) * way;
      }
    }
  }
  return normal.normalized();
}

std::vector<OrientedPoint> boundary_points(const VoxelImage& mask) {
  std::vector<OrientedPoint> points;
  for (std::size_t k = 0; k < mask.size[2]; ++k) {
    for (std::size_t j = 0; j < mask.size[1]; ++j) {
      for (std::size_t i = 0; i < mask.size[0]; ++i) {
        const std::array<std::size_t, 3> voxel = {i, j, k};
        for (std::size_t a = 0; a < 3; ++a) {
          std::array<std::size_t, 3> next = voxel;
          if (++next[a] == mask.size[a]) continue;
          if (is_inside(mask, i, j, k) == is_inside(mask, next[0], next[1], next[2])) continue;
          Vec3 index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
          index[static_cast<Eigen::Index>(a)] += 0.5;
          const Vec3 p = mask.position(index);
          points.push_back({p, normal_at(mask, p, voxel)});
        }
      }
    }
  }
  return points;
}

// The quadratic B-spline over [-1.5, 1.5].
double spline(double t) {
  if (t < 0.5) return 0.75 - t * t;
  return t < 1.5 ? 0.5 * (1.5 - t) * (1.5 - t) : 0;
}

// A function whose zero set fits some points: x^T A x + b x + c about a centre, positive outside.
struct Quadric {
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0;

  double at(const Vec3& p) const {
    const Vec3 x = p - center;
    return x.dot(a * x) + b.dot(x) + c;
  }
  Vec3 gradient(const Vec3& p) const { return 2 * a * (p - center) + b; }
};

template <int kUnknowns>
class LeastSquares {
 public:
  using Row = Eigen::Matrix<double, kUnknowns, 1>;

  void add(const Row& row, double value, double weight) {
    normal_ += weight * row * row.transpose();
    product_ += weight * value * row;
  }
  Row solution() const {
    auto matrix = normal_;
    matrix.diagonal().array() += kRidge * normal_.trace();
    return matrix.ldlt().solve(product_);
  }

 private:
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal_ = Eigen::Matrix<double, kUnknowns, kUnknowns>::Zero();
  Row product_ = Row::Zero();
};

// A cell of the octree that was not divided.
struct Leaf {
  Vec3 center;
  double support;
  Quadric fit;
};

class Octree {
 public:
  Octree(const std::vector<OrientedPoint>& points, const Box& box, double tolerance)
      : points_(points), tolerance_(tolerance) {
    std::vector<Vec3> positions;
    for (const OrientedPoint& p : points) positions.push_back(p.position);
    tree_ = BoxTree(positions, positions);
    divide(box.center(), 0.5 * box.sizes().maxCoeff(), 0);
  }

  const std::vector<Leaf>& leaves() const { return leaves_; }

 private:
  void divide(const Vec3& center, double half, int depth) {
    double support = kSupport * 2 * std::sqrt(3.0) * half;
    const double growth = kGrowth * support;
    std::vector<Index> near = within(center, support);
    const bool is_dense = near.size() >= kFewestPoints;
    // No use in growing ball by ball where there is nothing far and wide: such cells fit their nearest points.
    for (double step = growth; near.size() < std::min(kFewestPoints, points_.size()); step *= 1.5) {
      support += step;
      near = within(center, support);
    }
    const std::optional<Quadric> fit = fitted(center, half, support, near);
    const bool is_good = fit && (!is_dense || error(*fit, center, support, near) <= tolerance_);
    if (fit && (is_good || depth == kDeepest)) {
      leaves_.push_back({center, support, *fit});
      return;
    }
    if (depth == kDeepest) {
      leaves_.push_back({center, support, height_field(center, support, near, mean_normal(center, support, near))});
      return;
    }
    for (int child = 0; child < 8; ++child) {
      const Vec3 way((child & 1) ? 1 : -1, (child & 2) ? 1 : -1, (child & 4) ? 1 : -1);
      divide(center + 0.5 * half * way, 0.5 * half, depth + 1);
    }
  }

  std::vector<Index> within(const Vec3& center, double radius) const {
    std::vector<Index> near;
    const Vec3 around = Vec3::Constant(radius);
    tree_.visit_overlapping(center - around, center + around, [&](Index i) {
      if ((points_[i].position - center).squaredNorm() < radius * radius) near.push_back(i);
    });
    std::sort(near.begin(), near.end());
    return near;
  }

  double weight(const Vec3& center, double support, Index i) const {
    return spline(1.5 * (points_[i].position - center).norm() / support);
  }

  Vec3 mean_normal(const Vec3& center, double support, const std::vector<Index>& near) const {
    Vec3 normal = Vec3::Zero();
    for (const Index i : near) normal += weight(center, support, i) * points_[i].normal;
    return normal.normalized();
  }

  // A height over a plane where normals agree, else a general quadric; nothing if distances around are not known.
  std::optional<Quadric> fitted(const Vec3& center, double half, double support, const std::vector<Index>& near) const {
    const Vec3 normal = mean_normal(center, support, near);
    if (std::all_of(near.begin(), near.end(), [&](Index i) { return points_[i].normal.dot(normal) > 0; }))
      return height_field(center, support, near, normal);
    return general_quadric(center, half, support, near);
  }

  // Sec. 4.2: w = f(u, v), quadratic.
  Quadric height_field(const Vec3& center, double support, const std::vector<Index>& near, const Vec3& normal) const {
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    LeastSquares<6> system;
    for (const Index i : near) {
      const Vec3 way = (points_[i].position - center) / support;
      const double x = u.dot(way), y = v.dot(way);
      system.add({x * x, x * y, y * y, x, y, 1}, normal.dot(way), weight(center, support, i));
    }
    const auto k = system.solution();
    Quadric q;
    q.center = center;
    q.a =
        -(k[0] * u * u.transpose() + 0.5 * k[1] * (u * v.transpose() + v * u.transpose()) + k[2] * v * v.transpose()) /
        support;
    q.b = normal - k[3] * u - k[4] * v;
    q.c = -k[5] * support;
    return q;
  }

  // Sec. 4.1: zero at the points, and the distance at those corners and the centre of the cell where it is known.
  std::optional<Quadric> general_quadric(const Vec3& center, double half, double support,
                                         const std::vector<Index>& near) const {
    using Row = LeastSquares<10>::Row;
    const auto row = [&](const Vec3& p) {
      const Vec3 x = (p - center) / support;
      Row r;
      r << x.x() * x.x(), x.y() * x.y(), x.z() * x.z(), x.x() * x.y(), x.y() * x.z(), x.z() * x.x(), x.x(), x.y(),
          x.z(), 1;
      return r;
    };
    double total = 0;
    for (const Index i : near) total += weight(center, support, i);
    LeastSquares<10> system;
    for (const Index i : near) system.add(row(points_[i].position), 0, weight(center, support, i) / total);
    std::vector<std::pair<Vec3, double>> known;
    for (int corner = -1; corner < 8; ++corner) {
      const Vec3 way((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
      const Vec3 p = corner < 0 ? center : Vec3(center + half * way);
      if (const std::optional<double> distance = known_distance(p, near)) known.emplace_back(p, *distance);
    }
    if (known.empty()) return std::nullopt;
    for (const auto& [p, distance] : known)
      system.add(row(p), distance / support, 1 / static_cast<double>(known.size()));
    const Row k = system.solution();
    Quadric q;
    q.center = center;
    q.a << k[0], k[3] / 2, k[5] / 2, k[3] / 2, k[1], k[4] / 2, k[5] / 2, k[4] / 2, k[2];
    q.a /= support;
    q.b = k.segment<3>(6);
    q.c = k[9] * support;
    return q;
  }

  // The mean signed distance from the planes of the nearest points, if these agree on the side.
  std::optional<double> known_distance(const Vec3& p, std::vector<Index> near) const {
    const std::size_t count = std::min(kNeighbours, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                      [&](Index i, Index j) {
                        const double a = (points_[i].position - p).squaredNorm();
                        const double b = (points_[j].position - p).squaredNorm();
                        return a != b ? a < b : i < j;
                      });
    double sum = 0;
    std::size_t outside = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const double distance = points_[near[n]].normal.dot(p - points_[near[n]].position);
      sum += distance;
      outside += distance > 0;
    }
    if (outside != 0 && outside != count) return std::nullopt;
    return sum / static_cast<double>(count);
  }

  // Taubin's distance of the points in the ball.
  double error(const Quadric& q, const Vec3& center, double support, const std::vector<Index>& near) const {
    double largest = 0;
    for (const Index i : near) {
      const Vec3& p = points_[i].position;
      if ((p - center).norm() >= support) continue;
      const double slope = q.gradient(p).norm();
      largest = std::max(largest, slope > 0 ? std::abs(q.at(p)) / slope : std::numeric_limits<double>::infinity());
    }
    return largest;
  }

  const std::vector<OrientedPoint>& points_;
  double tolerance_;
  BoxTree tree_;
  std::vector<Leaf> leaves_;
};

// Where the voxels of a grid are within a distance of points.
std::vector<char> near_points(const VoxelImage& grid, const std::vector<OrientedPoint>& points, double distance) {
  std::vector<char> near(grid.values.size(), 0);
  for (const OrientedPoint& point : points) {
    const Box box(point.position.array() - distance, point.position.array() + distance);
    for_voxels_in(grid, box, [&](const Vec3&, std::size_t voxel) { near[voxel] = 1; });
  }
  return near;
}

// Whether the mask's voxel nearest to a point is inside.
bool is_inside(const VoxelImage& mask, const Vec3& p) {
  std::array<std::size_t, 3> voxel;
  for (int a = 0; a < 3; ++a) {
    const double index = std::round((p[a] - mask.origin[a]) / mask.steps(a, a));
    if (!(index >= 0 && index < static_cast<double>(mask.size[a]))) return false;
    voxel[a] = static_cast<std::size_t>(index);
  }
  return is_inside(mask, voxel[0], voxel[1], voxel[2]);
}

}  // namespace

TriMesh mpu_surface(const Centerline& centerline, const MpuOptions& options) {
  const VoxelImage mask = sample_field(centerline, options.voxel);
  const std::vector<OrientedPoint> points = boundary_points(mask);
  const double band = kBand * options.voxel;
  Box box;
  for (const OrientedPoint& p : points) box.extend(p.position);
  box = Box(box.min().array() - band - options.step, box.max().array() + band + options.step);
  const Octree octree(points, box, options.tolerance);
  VoxelImage field = grid_over(box, options.step, 0);
  const std::vector<char> near = near_points(field, points, band);
  std::vector<float> weights(field.values.size(), 0);
  for (const Leaf& leaf : octree.leaves()) {
    const Box ball(leaf.center.array() - leaf.support, leaf.center.array() + leaf.support);
    for_voxels_in(field, ball, [&](const Vec3& p, std::size_t voxel) {
      if (!near[voxel]) return;
      const double weight = spline(1.5 * (p - leaf.center).norm() / leaf.support);
      weights[voxel] += static_cast<float>(weight);
      field.values[voxel] += static_cast<float>(weight * leaf.fit.at(p));
    });
  }
  const Box all(box.min().array() - options.step, box.max().array() + 2 * options.step);
  for_voxels_in(field, all, [&](const Vec3& p, std::size_t voxel) {
    float& value = field.values[voxel];
    if (near[voxel] && weights[voxel] > 0) {
      value = -value / weights[voxel];
    } else {
      value = static_cast<float>(is_inside(mask, p) ? band : -band);
    }
  });
  return contour(field, 0);
}

}  // namespace vmesh::bench
