// What the writer and the reader of our GLB files share. Internal to the module.
#pragma once

#include "vmesh/core/types.h"

namespace vmesh::io {

/// How the files tell their frame; by this they are known as ours.
constexpr const char* kGlbFrame = "metres; x to the left, y superior, z anterior; from LPS in mm: (x, z, -y) / 1000";

/// From LPS to y up (superior) and z towards the viewer (anterior).
inline Vec3 turned_for_glb(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }
inline Vec3 lps_of_glb(const Vec3& metres) { return 1e3 * Vec3(metres.x(), -metres.z(), metres.y()); }

}  // namespace vmesh::io
