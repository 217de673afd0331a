// Builds a Y-shaped vessel in code, grows a surface around it and writes it as PLY.
#include <cstdio>

#include "vmesh/core/error.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/production/produce.h"

int main(int argc, char** argv) {
  const char* output = argc > 1 ? argv[1] : "y.ply";
  try {
    // Position and radius in mm: a trunk of 20 mm that divides in two.
    const vmesh::Centerline centerline({{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.8}, {{-9, 0, 32}, 2.1}, {{8, 3, 33}, 2.3}},
                                       {{0, 1}, {1, 2}, {1, 3}});

    vmesh::ProductionOptions options;
    options.growth.around = 8;
    const vmesh::GenerateResult result = vmesh::produce(centerline, {}, options).result;
    for (const vmesh::GrowthWarning& warning : result.warnings)
      std::fprintf(stderr, "warning: %s\n", warning.message.c_str());
    for (const vmesh::Defect& defect : result.defects) std::fprintf(stderr, "defect: %s\n", defect.message.c_str());
    if (!result.is_sound()) return 1;

    vmesh::MeshAttributes attributes;
    attributes.vertex.push_back({"radius", result.radius});
    vmesh::write_surface(output, result.mesh, attributes);
    std::printf("%s: %zu vertices, %zu faces\n", output, result.mesh.vertices.size(), result.mesh.faces.size());
  } catch (const vmesh::Error& error) {
    std::fprintf(stderr, "grow_surface: %s\n", error.what());
    return 1;
  }
}
