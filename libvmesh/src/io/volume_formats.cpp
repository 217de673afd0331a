#include "formats.h"

namespace vmesh {

const std::vector<VolumeFormat>& volume_formats() {
  using namespace io;
  static const std::vector<VolumeFormat> formats = {
      {.name = "VTU", .extensions = {".vtu"}, .write = write_volume_vtu, .parse = parse_volume_vtu},
      {.name = "Gmsh 2.2", .extensions = {".msh"}, .write = write_gmsh_2},
      {.name = "Gmsh 4.1", .extensions = {".msh4"}, .write = write_gmsh_4},
      {.name = "TetGen",
       .extensions = {".node", ".ele", ".face"},
       .holds_wedges = false,
       .holds_pyramids = false,
       .write = write_tetgen},
      {.name = "Abaqus", .extensions = {".inp"}, .holds_pyramids = false, .write = write_abaqus},
      {.name = "OpenFOAM", .folder = "polyMesh", .is_file = is_openfoam_file, .write = write_openfoam},
      {.name = "SimVascular",
       .folder = "mesh-complete",
       .holds_wedges = false,
       .holds_pyramids = false,
       .is_file = is_mesh_complete_file,
       .write = write_mesh_complete},
  };
  return formats;
}

}  // namespace vmesh
