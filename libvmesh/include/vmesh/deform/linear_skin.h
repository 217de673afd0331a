#pragma once

#include <span>
#include <vector>

#include "vmesh/deform/surface_binding.h"
#include "vmesh/mesh/surface_skin.h"

namespace vmesh {

/// The binding of Eq. 10 as linear blend skinning, which animation programs support: with the frames of the segment and
/// of its parent, both at both ends of the segment, as joints, a vertex at parameter t has the weights (1 - t) / 2 at
/// the start and t / 2 at the end, and goes exactly where SurfaceBinding puts it as long as profiles are not scaled. A
/// root has one joint, every other slot three, in the order of slots:
///   "node N"           frame of the segment that ends in node N, there
///   "segment S start"  the same where the segment starts
///   "segment S parent" frame of the parent's segment where segment S ends
/// Throws InvalidInput for places that do not exist.
SurfaceSkin make_linear_skin(const Centerline& centerline, const RodTree& tree, std::span<const SurfacePlace> places);

/// Position of a joint of that skin, and its rotation from rest.
struct JointPose {
  Mat3 rotation = Mat3::Identity();
  Vec3 position = Vec3::Zero();  ///< mm
};

/// One per joint.
std::vector<JointPose> joint_poses(const RodTree& tree, const Pose& pose);

}  // namespace vmesh
