#include "ring_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace vmesh::skeleton {
namespace {

void measure_area(std::span<const Vec3> ring, RingShape& shape) {
  Vec3 middle = Vec3::Zero(), sum = Vec3::Zero();
  for (const Vec3& p : ring) middle += p / static_cast<double>(ring.size());
  const auto piece = [&](std::size_t i) -> Vec3 {
    return 0.5 * (ring[i] - middle).cross(ring[(i + 1) % ring.size()] - middle);
  };
  for (std::size_t i = 0; i < ring.size(); ++i) sum += piece(i);
  shape.center = middle;
  shape.area = sum.norm();
  if (!(shape.area > 0)) return;
  shape.normal = sum / shape.area;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i)
    moment += piece(i).dot(shape.normal) * (ring[i] - middle + ring[(i + 1) % ring.size()] - middle) / 3;
  shape.center = middle + moment / shape.area;
  shape.radius = std::sqrt(shape.area / std::numbers::pi);
}

// Of the ring's edges, in its plane: those of a circle of radius r are r^2 / 2.
void measure_moments(std::span<const Vec3> ring, RingShape& shape) {
  const Vec3 u = shape.normal.unitOrthogonal(), v = shape.normal.cross(u);
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  const auto flat = [&](const Vec3& p) { return Eigen::Vector2d(u.dot(p - shape.center), v.dot(p - shape.center)); };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = flat(ring[i]), b = flat(ring[(i + 1) % ring.size()]), m = 0.5 * (a + b);
    const double share = (b - a).norm() / shape.perimeter;
    mean += share * m;
    moments += share * (m * m.transpose() + (b - a) * (b - a).transpose() / 12);
  }
  moments -= mean * mean.transpose();
  const Eigen::Vector2d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moments).eigenvalues().cwiseMax(0);
  if (!(values[0] > 0)) return;
  shape.aspect = std::sqrt(values[1] / values[0]);
  shape.compactness = shape.area / (2 * std::numbers::pi * std::sqrt(values[0] * values[1]));
}

}  // namespace

RingShape shape_of(std::span<const Vec3> ring) {
  RingShape shape;
  measure_area(ring, shape);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    shape.perimeter += (ring[(i + 1) % ring.size()] - ring[i]).norm();
    shape.unevenness = std::max(shape.unevenness, std::abs((ring[i] - shape.center).dot(shape.normal)));
  }
  if (shape.area > 0) measure_moments(ring, shape);
  return shape;
}

double area_of_arcs(std::span<const Vec3> ring, const Vec3& normal) {
  const std::size_t n = ring.size();
  const auto edge = [&](std::size_t i) -> Vec3 { return ring[(i + 1) % n] - ring[i % n]; };
  const auto turn = [&](std::size_t i) {  // from the edge before to edge i
    const Vec3 before = edge(i + n - 1), after = edge(i);
    return std::atan2(before.cross(after).dot(normal), before.dot(after));
  };
  double area = 0;
  for (std::size_t i = 0; i < n; ++i) area += edge(i).squaredNorm() * 0.5 * (turn(i) + turn(i + 1)) / 12;
  return area;
}

}  // namespace vmesh::skeleton
