#include "formats.h"

namespace vmesh {
namespace io {
namespace {

#if VMESH_IO_WITH_HDF5
constexpr auto kReadHdf5 = read_hdf5_network;
#else
constexpr decltype(&read_hdf5_network) kReadHdf5 = nullptr;
#endif

}  // namespace
}  // namespace io

const std::vector<CenterlineFormat>& centerline_formats() {
  using namespace io;
  static const std::vector<CenterlineFormat> formats = {
      {.name = "SWC",
       .extensions = {".swc"},
       .options = {"voxel-size"},
       .trees_only = true,
       .parse = parse_swc,
       .write = write_swc},
      {.name = "VTP",
       .extensions = {".vtp"},
       .options = {"radius-array"},
       .keeps_end_sections = true,
       .parse = parse_centerline_vtp,
       .write = write_centerline_vtp},
      {.name = "VTU", .extensions = {".vtu"}, .options = {"radius-array"}, .parse = parse_centerline_vtu},
      {.name = "JSON",
       .extensions = {".json"},
       .options = {"radius-array"},  // of Markups and graphs
       .keeps_end_sections = true,
       .parse = parse_centerline_json,
       .write = write_centerline_json},
      {.name = "CSV pair",
       .extensions = {".csv"},
       .options = {"radius-array"},
       .parse_pair = parse_centerline_csv,
       .write_pair = write_centerline_csv,
       .second_file = second_csv_file,
       .others_second_file = voreens_second_file},
      {.name = "VessMorphoVis", .extensions = {".vmv"}, .parse = parse_vmv},
      {.name = "legacy VTK", .extensions = {".vtk"}, .options = {"radius-array"}, .parse = parse_centerline_vtk},
      {.name = "3D Slicer Markups",
       .extensions = {".mrk.json"},
       .options = {"radius-array"},
       .one_branch = true,
       .parse = parse_centerline_json},
      {.name = "SimVascular contours", .extensions = {".ctgr"}, .one_branch = true, .parse = parse_contours},
      {.name = "SimVascular path", .extensions = {".pth"}, .one_branch = true, .parse = parse_path},
      {.name = "VascuSynth", .extensions = {".gxl", ".xml"}, .options = {"voxel-size"}, .parse = parse_gxl},
      {.name = "Amira", .extensions = {".am"}, .options = {"radius-array"}, .parse = parse_amira},
      {.name = "OBJ of lines", .extensions = {".obj"}, .holds_lines = holds_obj_lines, .parse = parse_centerline_obj},
      {.name = "PLY of edges",
       .extensions = {".ply"},
       .options = {"radius-array"},
       .holds_lines = holds_ply_edges,
       .parse = parse_centerline_ply},
      {.name = "GraphML", .extensions = {".graphml"}, .options = {"radius-array"}, .parse = parse_graphml},
      {.name = "GEXF", .extensions = {".gexf"}, .options = {"radius-array"}, .parse = parse_gexf},
      {.name = "ITK-TubeTK", .extensions = {".tre"}, .parse = parse_tube_scene},
      {.name = "Secomb network", .extensions = {".dat"}, .parse = parse_network},
      {.name = "MorphIO network", .extensions = {".h5"}, .needs = {"HDF5", ".vmv or .vtp"}, .read = kReadHdf5},
  };
  return formats;
}

}  // namespace vmesh
