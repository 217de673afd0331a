#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/core/file_format.h"
#include "vmesh/mesh/surface_skin.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

struct LoadedSurface;
struct SurfaceMetadata;
struct SurfaceWriteOptions;

/// A format of surfaces: what it is called, what it can hold, and what reads and writes it.
struct SurfaceFormat {
  std::string name;
  std::vector<std::string> extensions;  ///< lower case, with their dots
  bool has_own_frame = false;           ///< always in metres with y up, whatever SurfaceMetadata says
  bool holds_bones = false;             ///< has room for a SurfaceSkin
  bool is_text = false;                 ///< always
  bool has_text_form = false;           ///< besides its usual, binary one
  bool has_compressed_form = false;     ///< likewise
  OptionalPart needs = {};              ///< what `read` needs

  /// From the content of a file that `source` names in messages.
  using Parse = LoadedSurface(std::string_view content, const std::string& source);
  using Write = void(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                     const SurfaceMetadata& metadata, const SurfaceWriteOptions& options);
  // The functions of the format, null where it has none. It is read by `read`, as it may refer to other files or be a
  // scene, or else by `parse`.
  Parse* parse = nullptr;
  LoadedSurface (*read)(const std::filesystem::path& path) = nullptr;
  Write* write = nullptr;
  /// A file beside the one that `write` makes, its name ending differently, that is part of what is written.
  struct FileBeside {
    std::string extension;
    Write* write;
  };
  std::vector<FileBeside> beside = {};

  bool is_written() const { return write != nullptr; }
};

/// All formats. Adding one: see CONTRIBUTING.md.
const std::vector<SurfaceFormat>& surface_formats();

/// The format by the file's extension, upper or lower case; null if it is not a surface's.
const SurfaceFormat* find_surface_format(const std::filesystem::path& path);

/// The same; otherwise throws Unsupported, listing the supported extensions.
const SurfaceFormat& surface_format(const std::filesystem::path& path);

/// The same for a file to be written: throws Unsupported, listing what can be written, for read-only formats too.
const SurfaceFormat& surface_output_format(const std::filesystem::path& path);

/// All files that write_surface() makes, the given one first.
std::vector<std::filesystem::path> files_of_surface(const std::filesystem::path& path);

/// Where a surface comes from; written as comments or field data where the format has room (all but STL; STL has 80
/// bytes for frame, unit and generator).
struct SurfaceMetadata {
  std::string generator;             ///< program and version
  std::string options;               ///< how it was made, free text
  std::string input_name;            ///< name of the input
  std::string input_sha256;          ///< see sha256_of_file()
  LengthUnit unit = LengthUnit::mm;  ///< of the written positions and lengths
  Space space = Space::lps;          ///< likewise; neither applies to GLB, which is in metres with y up
};

enum class SurfaceEncoding {
  usual,      ///< binary, where the format has the choice
  text,       ///< of formats with a text form
  compressed  ///< of formats with a compressed form, in builds with meshoptimizer
};

/// What some formats can do.
struct SurfaceWriteOptions {
  SurfaceEncoding encoding = SurfaceEncoding::usual;
  const SurfaceSkin* skin = nullptr;  ///< bones; null: none
};

/// Writes a surface (given in mm and LPS) in the format of the extension, in the unit and frame of `metadata`, which
/// are recorded (SPACE=LPS, UNIT=mm). Attributes named radius, distance, displacement and volume_distance are lengths.
/// The bytes depend on the arguments alone, and the file appears complete or not at all.
/// Patches have names if MeshAttributes says so: good ones (check_patch_names()), one for every ModelFaceID.
///   PLY  binary little-endian, or text; positions and normals in double, so that they come back to the bit; every
///        attribute; the face attribute EquiangleSkewness is named "quality", which MeshLab shows; attributes named
///        red, green and blue are bytes, which all programs take for a colour; names of patches are comments
///   VTP  packed by zlib; every attribute; "radius" is named MaximumInscribedSphereRadius, "distance" Distance,
///        "group" GroupIds, face "quality" Quality; point array Normals; the first attributes are the active ones;
///        names of patches are the field data PatchNames
///   OBJ, OFF  positions with the digits they need to come back to the bit; no attributes; OBJ has normals, and groups
///        by the names of patches; without names by CapID: wall, cap_1, ...; else by ModelFaceID: face_1, ...; without
///        either, surface
///   STL  binary, in float, or text, whose positions come back to the bit, with a solid for each group of OBJ; no
///        attributes
///   .mdl  SimVascular: the faces of the model by their numbers, names and types, cap or wall (is_wall_patch()); beside
///   it
///        the surface as VTP, with ModelFaceID, and for old versions the names as .vtp.facenames. Patches as the groups
///        of OBJ, but for a surface without any, which is the wall
///   .smesh  TetGen: facets with the numbers of the groups of OBJ, from 1, as markers; no other attributes
///   GLB  binary glTF 2.0 in metres, y up (superior), z towards the front (anterior); vertices are shared by faces;
///        attributes of vertices, in capitals behind an underscore (_RADIUS), red, green and blue as its colour; a
///        primitive for each group of OBJ, with a material of its name, if there are several; with a skin, bones,
///        around the origin of the frame. Compressed by EXT_meshopt_compression: positions are rounded
///        to two millionths of their greatest coordinate (from the middle of the surface, or the origin with bones),
///        normals to a 4,000th, attributes that are no integers to 31 millionths; triangles are in another order
/// In text, numbers have the digits they need to come back to the bit.
/// Throws InvalidInput when an attribute or the skin has a wrong length, a ModelFaceID no good name or a face names a
/// vertex that does not exist, Unsupported (extension, an encoding that the format does not have, a skin in another
/// format than GLB or of more than 65,535 joints), WriteError.
void write_surface(const std::filesystem::path& path, const TriMesh& mesh, const MeshAttributes& attributes = {},
                   const SurfaceMetadata& metadata = {}, const SurfaceWriteOptions& options = {});

struct LoadedSurface {
  TriMesh mesh;
  MeshAttributes attributes;              ///< of PLY, VTP, VTK and our GLB files, under the names write_surface() takes
  LengthUnit unit = LengthUnit::unknown;  ///< as tagged in the file; positions are not converted
  Space space = Space::unknown;           ///< as tagged in the file; positions are not converted
  std::vector<std::string> warnings;      ///< what was left out or changed
};

/// Reads a surface by extension. Polygons are triangulated (triangulate_polygon()), lines and loose points are left
/// out, equal corners of an STL file become one vertex. Several groups of an
/// OBJ file or solids of an STL file become patches: ModelFaceID from 1, and their names. Names that are not good
/// (check_patch_names()) are left out with a warning. Needs at most 128 times the size of the file (compressed VTP:
/// of its uncompressed data) plus a megabyte of memory, whatever the file says. A GLB file of write_surface() comes
/// back in mm and LPS, vertex by vertex, with its attributes in lower case, but not its colours. Other GLB files and
/// scenes are read by assimp in a child process, as assimp may crash on damaged files, and without that bound: all
/// meshes of a scene, with their nodes' transformations applied, become one surface without attributes, in which
/// coincident vertices are merged. Scenes with y up are rotated to have z up. Throws ReadError (missing, a directory,
/// unreadable), InvalidInput (content; also when there is no face at all), Unsupported (a scene in a build without
/// assimp).
LoadedSurface read_surface(const std::filesystem::path& path);

/// Converts to millimetres and LPS, including attributes that are lengths. Arguments take precedence over the file; if
/// neither is known, millimetres or LPS are assumed with a warning. `source` names the file in it.
void convert_to_internal(LoadedSurface& surface, const std::string& source, std::optional<LengthUnit> unit,
                         std::optional<Space> space);

/// read_surface() from memory, without scenes; `source` names it in messages.
LoadedSurface parse_surface(std::string_view content, const SurfaceFormat& format, const std::string& source);

}  // namespace vmesh
