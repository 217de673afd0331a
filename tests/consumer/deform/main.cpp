// A frame of a surgery simulator: a Y-shaped vessel is pulled at one end, and a foreign surface follows.
#include <cmath>
#include <cstdio>

#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"

int main() {
  const vmesh::Centerline vessel({{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.8}, {{-9, 0, 32}, 2.1}, {{8, 3, 33}, 2.3}},
                                 {{0, 1}, {1, 2}, {1, 3}});
  vmesh::CenterlineSimulation simulation(vessel, vmesh::segment_properties(vessel, {}));
  simulation.clamp(0);
  const std::vector<vmesh::Vec3> vertices{{3, 0, 5}, {0, 3, 15}, {-8, 2, 31}}, normals{{1, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  const vmesh::SurfaceBinding binding(vessel, simulation.tree(), vertices, normals,
                                      vmesh::nearest_places(vessel, vertices));
  vmesh::DeformedSurface surface = binding.make_surface();

  simulation.drag(2, {-12, 0, 30});
  simulation.step();
  binding.apply(simulation.pose(), simulation.moved(), surface);

  const vmesh::Vec3 moved = surface.position(binding.lane_of_vertex()[2]) - vertices[2];
  std::printf("the vertex moved by %.3f %.3f %.3f mm\n", moved.x(), moved.y(), moved.z());
  return (moved - vmesh::Vec3(-3, 0, -2)).norm() < 1.5 ? 0 : 1;
}
