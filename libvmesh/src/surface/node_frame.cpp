#include "surface/node_frame.h"

namespace vmesh {

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
  const Vec3 side = across.norm() > 1e-6 ? Vec3(across.normalized()) : Vec3(along.unitOrthogonal());
  Eigen::Matrix3d frame;
  frame << side, along.cross(side), along;
  return frame * Eigen::AngleAxisd(0.4, Vec3(2, 3, 6) / 7).toRotationMatrix();
}

}  // namespace vmesh
