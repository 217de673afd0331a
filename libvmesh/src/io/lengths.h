// Units and frames of meshes, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::io {

/// Whether the values of an attribute of this name are lengths.
inline bool is_length(const std::string& attribute) {
  return attribute == "radius" || attribute == "distance" || attribute == "displacement" ||
         attribute == "volume_distance";
}

/// Between LPS and another space; the same in both directions.
inline void move_points(std::vector<Vec3>& points, double scale, Space space) {
  const Vec3 axes = space == Space::ras ? Vec3(-scale, -scale, scale) : Vec3(scale, scale, scale);
  for (Vec3& p : points) p = p.cwiseProduct(axes);
}

/// Those attributes that are lengths.
inline void scale_lengths(std::vector<MeshAttribute>& attributes, double scale) {
  for (MeshAttribute& a : attributes) {
    if (!is_length(a.name)) continue;
    for (double& value : a.values) value *= scale;
  }
}

}  // namespace vmesh::io
