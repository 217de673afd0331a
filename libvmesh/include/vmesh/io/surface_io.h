#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

enum class SurfaceFormat { off, obj, stl, ply, vtp, vtk };

/// By the file's extension, upper or lower case. Throws Unsupported, with the extensions that are.
SurfaceFormat surface_format(const std::filesystem::path& path);

/// The same for a file to be written; legacy VTK files (.vtk) are read only.
SurfaceFormat surface_output_format(const std::filesystem::path& path);

/// Where a surface comes from; written as comments or field data where the format has room (all but STL; STL has 80
/// bytes for frame, unit and generator).
struct SurfaceMetadata {
  std::string generator;     ///< program and version
  std::string options;       ///< how it was made, free text
  std::string input_name;    ///< what it was made from
  std::string input_sha256;  ///< see sha256_of_file()
};

/// Writes a surface, in mm and LPS and saying so (SPACE=LPS, UNIT=mm), by extension. The bytes depend on the arguments
/// alone, and the file appears complete or not at all.
///   PLY  binary little-endian; positions and normals in double, so that they come back to the bit; every attribute;
///        the face attribute EquiangleSkewness is named "quality", which MeshLab shows
///   VTP  through VTK; every attribute; "radius" is named MaximumInscribedSphereRadius, "distance" Distance,
///        "group" GroupIds, face "quality" Quality; point array Normals
///   OBJ, OFF  positions with the digits they need to come back to the bit; no attributes
///   STL  binary; float; no attributes
/// Throws InvalidInput when an attribute has a wrong length or a face names a vertex that does not exist, Unsupported
/// (extension, or VTP without VTK), WriteError.
void write_surface(const std::filesystem::path& path, const TriMesh& mesh, const MeshAttributes& attributes = {},
                   const SurfaceMetadata& metadata = {});

struct LoadedSurface {
  TriMesh mesh;
  MeshAttributes attributes;              ///< of PLY, VTP and VTK files, under the names write_surface() takes
  LengthUnit unit = LengthUnit::unknown;  ///< as tagged in the file; positions are not converted
  Space space = Space::unknown;           ///< as tagged in the file; positions are not converted
  std::vector<std::string> warnings;      ///< what was left out or changed
};

/// Reads a surface by extension. Polygons are triangulated (triangulate_polygon()), lines and loose points are left
/// out, equal corners of an STL file become one vertex. It takes at most 128 times as much memory as the file is large
/// (packed VTP: as its data are unpacked) and a megabyte, whatever the file says. Throws ReadError (missing, a
/// directory, unreadable), InvalidInput (content; also when there is no face at all), Unsupported.
LoadedSurface read_surface(const std::filesystem::path& path);

/// The same from memory; `source` names it in messages.
LoadedSurface parse_surface(std::string_view content, SurfaceFormat format, const std::string& source);

}  // namespace vmesh
