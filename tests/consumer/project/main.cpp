// An external program that uses the library: a Y-shaped vessel, a query, and a surface.
#include <cmath>
#include <cstdio>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/version.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

int main() {
  const vmesh::Centerline centerline({{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.8}, {{-9, 0, 32}, 2.1}, {{8, 3, 33}, 2.3}},
                                     {{0, 1}, {1, 2}, {1, 3}});
  const vmesh::VesselField field(centerline);
  const double distance = field.sample_global({5, 0, 10}).distance;
  std::printf("vmesh %s: distance %.6f mm\n", std::string(vmesh::version()).c_str(), distance);
  if (std::abs(distance - 2.1) > 0.01) return 1;
  const vmesh::GenerateResult result = vmesh::generate_surface(centerline);
  const vmesh::Topology topology = vmesh::measure_topology(result.mesh);
  const std::size_t intersections = vmesh::self_intersections(result.mesh).size();
  vmesh::write_surface("consumer.ply", result.mesh);
  std::printf("%zu faces, genus %d, %zu self-intersections\n", result.mesh.faces.size(),
              static_cast<int>(topology.genus), intersections);
  if (!topology.closed || !topology.manifold || topology.genus != 0 || intersections != 0) return 1;
  return 0;
}
