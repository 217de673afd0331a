#pragma once

#include <vector>

#include "vmesh/solid/vessel_wall.h"
#include "vmesh/surface/disc.h"

namespace vmesh {

/// A flat end of the wall.
struct Cap {
  Index patch = 0;
  Vec3 normal = Vec3::Zero();  ///< unit length, out of the vessel
  std::vector<Index> rim;      ///< vertices of the wall, counter-clockwise about `normal`
  Disc disc;                   ///< its triangles, within its rim
  double unevenness = 0;       ///< height of its vertices across its plane, mm
};

/// The wall of a surface without its caps. Vertices are numbered without those within caps, else in the same order.
struct WallFrame {
  std::vector<Vec3> position;
  std::vector<double> radius;
  std::vector<Triangle> faces;
  std::vector<std::vector<Index>> fan;  ///< faces at every vertex, ascending
  std::vector<Index> cap_at;            ///< of every vertex: in `caps`, of the cap on whose rim it is, or kNone
  std::vector<Cap> caps;                ///< ascending in the patches
};

/// Throws InvalidInput, see make_volume().
WallFrame frame_of(const VesselWall& wall);

/// Unit normal of every face; of the wall, out of the vessel.
std::vector<Vec3> face_normals(const WallFrame& frame);

}  // namespace vmesh
