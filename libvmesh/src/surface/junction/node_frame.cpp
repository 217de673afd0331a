#include "surface/junction/node_frame.h"

namespace vmesh {
namespace {

constexpr double kStraight = 1e-6;  // derived: sine of an angle far above the rounding of a direction

// The normal of the plane spanned by the line through `node` in direction `along` and the node of the centerline
// farthest from that line; any normal of `along` if the centerline is straight.
Vec3 farthest_off(const Centerline& centerline, Index node, const Vec3& along) {
  Vec3 across = Vec3::Zero();
  double size = 0;
  for (const auto& other : centerline.nodes()) {
    const Vec3 way = other.position - centerline.node(node).position;
    size = std::max(size, way.norm());
    if (along.cross(way).norm() > across.norm()) across = along.cross(way);
  }
  return across.norm() > kStraight * size ? across : along.unitOrthogonal();
}

}  // namespace

Eigen::Matrix3d frame_at(const Centerline& centerline, Index node) {
  Vec3 along = Vec3::UnitZ(), across = Vec3::Zero();
  for (const Index s : centerline.incident_segments(node)) {
    const Vec3 way = centerline.node(centerline.other_node(s, node)).position - centerline.node(node).position;
    if (s == centerline.incident_segments(node)[0]) {
      along = way.normalized();
    } else if (along.cross(way.normalized()).norm() > across.norm()) {
      across = along.cross(way.normalized());
    }
  }
  if (across.norm() <= kStraight) across = farthest_off(centerline, node, along);
  const Vec3 side = across.normalized();
  Eigen::Matrix3d frame;
  frame << side, along.cross(side), along;
  return frame * Eigen::AngleAxisd(0.4, Vec3(2, 3, 6) / 7).toRotationMatrix();
}

}  // namespace vmesh
