// One reader and one writer per format, internal to the module. Readers take the file's content and its name for
// messages; writers write to a stream whose state the caller checks.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"

namespace vmesh::io {

RawCenterline parse_swc(std::string_view content, const std::string& source);
RawCenterline parse_vmv(std::string_view content, const std::string& source);
RawCenterline parse_centerline_json(std::string_view content, const std::string& source,
                                    const CenterlineReadOptions& options);
RawCenterline parse_centerline_csv(std::string_view nodes, std::string_view segments, const std::string& source);
RawCenterline parse_centerline_vtp(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options);
RawCenterline parse_centerline_vtk(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options);
RawCenterline parse_contours(std::string_view content, const std::string& source);
RawCenterline parse_path(std::string_view content, const std::string& source, const CenterlineReadOptions& options);
RawCenterline parse_gxl(std::string_view content, const std::string& source, const CenterlineReadOptions& options);
RawCenterline parse_amira(std::string_view content, const std::string& source, const CenterlineReadOptions& options);
RawCenterline parse_network(std::string_view content, const std::string& source);
/// Throws Unsupported in a build without HDF5.
RawCenterline read_hdf5_network(const std::filesystem::path& path);

void write_swc(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata);
void write_centerline_json(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                           const std::vector<EndSection>& sections);
void write_centerline_csv(std::ostream& nodes, std::ostream& segments, const Centerline& centerline,
                          const CenterlineMetadata& metadata);
void write_centerline_vtp(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                          const std::vector<EndSection>& sections);

LoadedSurface parse_off(std::string_view content, const std::string& source);
LoadedSurface parse_obj(std::string_view content, const std::string& source);
LoadedSurface parse_stl(std::string_view content, const std::string& source);
LoadedSurface parse_ply(std::string_view content, const std::string& source);
LoadedSurface parse_surface_vtp(std::string_view content, const std::string& source);
LoadedSurface parse_surface_vtk(std::string_view content, const std::string& source);
/// From a file, as some refer to others: GLB, glTF, 3MF, COLLADA, X3D, FBX. Throws Unsupported in a build without
/// assimp.
LoadedSurface read_scene(const std::filesystem::path& path);

void write_off(std::ostream& out, const TriMesh& mesh, const SurfaceMetadata& metadata);
void write_obj(std::ostream& out, const TriMesh& mesh, const SurfaceMetadata& metadata);
void write_stl(std::ostream& out, const TriMesh& mesh, const SurfaceMetadata& metadata);
void write_ply(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata);
void write_glb(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata, const SurfaceSkin* skin);
void write_surface_vtp(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                       const SurfaceMetadata& metadata);

}  // namespace vmesh::io
