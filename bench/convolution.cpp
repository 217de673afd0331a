#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "vmesh/image/contour.h"

#include "grid.h"
#include "related_work.h"

namespace vmesh::bench {
namespace {

// Contributions below this share of the level are left out.
constexpr double kNegligible = 1e-4;

// Distance in radii, or excess of the way along a segment, beyond which contributions are negligible.
double reach_in_radii(double width) { return std::sqrt(1 - std::log(kNegligible) / width); }

void add_segment(VoxelImage& field, const CenterlineNode& from, const CenterlineNode& to, double width) {
  const Vec3 axis = to.position - from.position;
  const double length = axis.norm();
  if (length == 0) return;
  const Vec3 direction = axis / length;
  const double reach = reach_in_radii(width) * std::max(from.radius, to.radius);
  Box box(from.position.cwiseMin(to.position), from.position.cwiseMax(to.position));
  box = Box(box.min().array() - reach, box.max().array() + reach);
  for_voxels_in(field, box, [&](const Vec3& p, std::size_t voxel) {
    const double x = direction.dot(p - from.position);
    const double foot = std::clamp(x / length, 0.0, 1.0);
    const double radius = from.radius + foot * (to.radius - from.radius);
    const double distance2 = (p - from.position - x * direction).squaredNorm();
    const double sharpness = std::sqrt(width) / radius;
    const double along = 0.5 * (std::erf(sharpness * x) - std::erf(sharpness * (x - length)));
    field.values[voxel] += static_cast<float>(std::exp(-width * distance2 / (radius * radius)) * along);
  });
}

// From the field to minus the distance in radii at which a straight vessel has that value: the same surface, but nearly
// linear between voxels, as marching cubes would have it.
void make_linear(VoxelImage& field, double width) {
  const auto least = static_cast<float>(kNegligible * std::exp(-width));
  for (float& value : field.values)
    value = -std::sqrt(std::max(0.0f, -std::log(std::max(value, least)) / static_cast<float>(width)));
}

}  // namespace

TriMesh plain_cylinders(const Centerline& centerline, int sides) {
  TriMesh mesh;
  const auto count = static_cast<Index>(sides);
  for (const CenterlineSegment& segment : centerline.segments()) {
    const CenterlineNode &a = centerline.node(segment.a), &b = centerline.node(segment.b);
    const Vec3 direction = (b.position - a.position).normalized();
    const double radius = 0.5 * (a.radius + b.radius);
    const Vec3 u = direction.unitOrthogonal(), v = direction.cross(u);
    const auto first = static_cast<Index>(mesh.vertices.size()), second = first + count, ends = second + count;
    for (const Vec3& center : {a.position, b.position}) {
      for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        mesh.vertices.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
      }
    }
    mesh.vertices.push_back(a.position);
    mesh.vertices.push_back(b.position);
    for (Index i = 0; i < count; ++i) {
      const Index next = (i + 1) % count;
      mesh.faces.push_back({first + i, first + next, second + next});
      mesh.faces.push_back({first + i, second + next, second + i});
      mesh.faces.push_back({first + next, first + i, ends});
      mesh.faces.push_back({second + i, second + next, ends + 1});
    }
  }
  return mesh;
}

TriMesh convolution_surface(const Centerline& centerline, double width, double step) {
  Box box;
  for (const CenterlineNode& node : centerline.nodes()) {
    const double reach = reach_in_radii(width) * node.radius + step;
    box.extend(Box(node.position.array() - reach, node.position.array() + reach));
  }
  VoxelImage field = grid_over(box, step, 0);
  for (const CenterlineSegment& segment : centerline.segments())
    add_segment(field, centerline.node(segment.a), centerline.node(segment.b), width);
  make_linear(field, width);
  return contour(field, -1);
}

}  // namespace vmesh::bench
