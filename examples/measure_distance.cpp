// Queries how far points are from a vessel's wall, and which segment is closest.
#include <cstdio>

#include "vmesh/volume/vessel_field.h"

int main() {
  // Two vessels that meet at a node, in mm.
  const vmesh::Centerline centerline({{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.5}, {{10, 0, 30}, 2.0}}, {{0, 1}, {1, 2}});
  const vmesh::VesselField field(centerline, /*blend=*/0.5);

  for (const vmesh::Vec3& p : {vmesh::Vec3(0, 0, 10), vmesh::Vec3(5, 0, 10), vmesh::Vec3(8, 0, 31)}) {
    const vmesh::FieldSample sample = field.sample_global(p);
    std::printf("(%g, %g, %g): %.3f mm from the wall of segment %u (%s), radius there %.3f mm\n", p.x(), p.y(), p.z(),
                sample.distance, sample.cone, sample.distance < 0 ? "inside" : "outside",
                field.relations().radius_at(sample.cone, sample.t));
  }
}
