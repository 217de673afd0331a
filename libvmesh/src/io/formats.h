// The readers and writers of the formats, for their tables: centerline_formats(), surface_formats() and
// volume_formats(). Internal to the module. Writers write to a stream whose state the caller checks.
#pragma once

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"

namespace vmesh::io {

CenterlineFormat::Parse parse_swc, parse_vmv, parse_centerline_json, parse_centerline_vtp, parse_centerline_vtu,
    parse_centerline_vtk, parse_contours, parse_path, parse_gxl, parse_amira, parse_centerline_obj,
    parse_centerline_ply, parse_network, parse_graphml, parse_gexf, parse_tube_scene;
bool holds_obj_lines(std::string_view content);
bool holds_ply_edges(std::string_view content);
RawCenterline parse_centerline_csv(std::string_view nodes, std::string_view segments, const std::string& source,
                                   const std::string& second_source, const CenterlineReadOptions& options);
RawCenterline read_hdf5_network(const std::filesystem::path& path);

CenterlineFormat::Write write_swc, write_centerline_json, write_centerline_vtp;
void write_centerline_csv(std::ostream& nodes, std::ostream& segments, const Centerline& centerline,
                          const CenterlineMetadata& metadata);
/// csv_segments_path(); throws InvalidInput if `path` names a segments file.
std::filesystem::path second_csv_file(const std::filesystem::path& path);
/// Of Voreen: "edges" instead of "nodes" in the name; empty if that is not in it.
std::filesystem::path voreens_second_file(const std::filesystem::path& path);

/// How our GLB files tell their frame; by this they are known.
constexpr const char* kGlbFrame = "metres; x to the left, y superior, z anterior; from LPS in mm: (x, z, -y) / 1000";

SurfaceFormat::Parse parse_off, parse_obj, parse_stl, parse_ply, parse_surface_vtp, parse_surface_vtk, parse_glb;
/// Through assimp.
LoadedSurface read_scene(const std::filesystem::path& path);
/// Ours by ourselves, others as a scene.
LoadedSurface read_glb(const std::filesystem::path& path);

SurfaceFormat::Write write_off, write_obj, write_stl, write_ply, write_glb, write_surface_vtp, write_smesh, write_3mf,
    write_model, write_model_surface, write_face_names;

VolumeFormat::Write write_volume_vtu, write_gmsh_2, write_gmsh_4, write_tetgen, write_abaqus, write_openfoam,
    write_mesh_complete;
VolumeFormat::Parse parse_volume_vtu;
bool is_openfoam_file(std::string_view name);
bool is_mesh_complete_file(std::string_view name);

}  // namespace vmesh::io
