#include <algorithm>
#include <limits>

#include "vmesh/core/box_tree.h"
#include "vmesh/deform/surface_binding.h"

namespace vmesh {
namespace {

/// The segments, then the isolated nodes as segments of zero length.
struct Axes {
  std::vector<Vec3> from, to;

  explicit Axes(const Centerline& centerline) {
    for (const auto& [a, b] : centerline.segments()) add(centerline.node(a).position, centerline.node(b).position);
    for (Index n = 0; n < centerline.nodes().size(); ++n)
      if (centerline.degree(n) == 0) add(centerline.node(n).position, centerline.node(n).position);
  }

  double nearest_parameter(Index i, const Vec3& p) const {
    const Vec3 along = to[i] - from[i];
    const double squared = along.squaredNorm();
    return squared > 0 ? std::clamp(along.dot(p - from[i]) / squared, 0.0, 1.0) : 0;
  }

 private:
  void add(const Vec3& a, const Vec3& b) {
    from.push_back(a);
    to.push_back(b);
  }
};

BoxTree boxes_of(const Axes& axes) {
  std::vector<Vec3> low, high;
  for (std::size_t i = 0; i < axes.from.size(); ++i) {
    low.push_back(axes.from[i].cwiseMin(axes.to[i]));
    high.push_back(axes.from[i].cwiseMax(axes.to[i]));
  }
  return {low, high};
}

SurfacePlace nearest_place(const Axes& axes, const BoxTree& boxes, const Vec3& p) {
  SurfacePlace place;
  double limit = std::numeric_limits<double>::infinity();
  boxes.visit(p, limit, [&](Index i) {
    const double t = axes.nearest_parameter(i, p);
    const double distance = (p - axes.from[i] - t * (axes.to[i] - axes.from[i])).norm();
    // Ties go to the lower number, whatever the order of the boxes.
    if (distance > limit || (distance == limit && i > place.segment)) return;
    limit = distance;
    place = {i, t};
  });
  return place;
}

}  // namespace

std::vector<SurfacePlace> nearest_places(const Centerline& centerline, std::span<const Vec3> points) {
  const Axes axes(centerline);
  const BoxTree boxes = boxes_of(axes);
  std::vector<SurfacePlace> places;
  places.reserve(points.size());
  for (const Vec3& p : points) places.push_back(nearest_place(axes, boxes, p));
  return places;
}

}  // namespace vmesh
