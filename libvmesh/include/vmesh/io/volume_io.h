#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/core/file_format.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

struct LoadedVolume;
struct VolumeMetadata;

/// A format of volume meshes: what it is called, what it can hold, and what reads and writes it.
struct VolumeFormat {
  std::string name;
  std::vector<std::string> extensions =
      {};                   ///< lower case, with their dots; all of them are written, where there are more
  std::string folder = {};  ///< of formats that are a folder: what its name ends with
  bool holds_wedges = true, holds_pyramids = true;

  /// Opens the next file of the mesh: "" for that of the format's only extension; another extension; a path within the
  /// folder.
  using OpenFile = std::function<std::ostream&(const std::string& name)>;
  using Write = void(const OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes& attributes,
                     const VolumeMetadata& metadata);
  /// Of a folder: whether a file in it, by its path within, is one that `write` may have written.
  bool (*is_file)(std::string_view name) = nullptr;
  /// From the content of a file that `source` names in messages.
  using Parse = LoadedVolume(std::string_view content, const std::string& source);
  // The functions of the format, null where it has none.
  Write* write = nullptr;
  Parse* parse = nullptr;

  bool is_written() const { return write != nullptr; }
  bool is_read() const { return parse != nullptr; }
  bool is_folder() const { return !folder.empty(); }
};

/// All formats. Adding one: see CONTRIBUTING.md.
const std::vector<VolumeFormat>& volume_formats();

/// The format by the extension or the name of the folder, upper or lower case; null if it is not a volume mesh's.
const VolumeFormat* find_volume_format(const std::filesystem::path& path);

/// ".vtu, .msh or a folder whose name ends in polyMesh": what is written, or read.
std::string written_volume_files();
std::string read_volume_files();

/// The format of a file to be written: throws Unsupported, listing what can be written, for read-only formats too.
const VolumeFormat& volume_output_format(const std::filesystem::path& path);

/// Where a volume mesh comes from; written as comments or field data where the format has room.
struct VolumeMetadata {
  std::string generator;             ///< program and version
  std::string options;               ///< how it was made, free text
  std::string input_name;            ///< name of the input
  std::string input_sha256;          ///< see sha256_of_file()
  LengthUnit unit = LengthUnit::mm;  ///< of the written positions and lengths
  Space space = Space::lps;          ///< likewise
};

struct VolumeWriteOptions {
  bool split_cells =
      false;  ///< into tetrahedra, see split_cells(); else formats without wedges or pyramids refuse them
};

/// Writes a volume mesh (given in mm and LPS) in the format of the extension, in the unit and frame of `metadata`,
/// which are recorded. Attributes named radius, distance, displacement and volume_distance are lengths. The bytes
/// depend on the arguments alone, and files and folders appear complete or not at all. A folder of that name is
/// replaced if it holds nothing but files of its format. In text, numbers have the digits they need to come back to the
/// bit.
///   .vtu           packed by zlib; the cells, then the faces of the boundary. For both, ModelRegionID is the number of
///                  the region from 1 (of a face, of the cell behind it), ModelFaceID that of the patch from 1, 0 for
///                  cells; RegionNames and PatchNames in the field data are their names. Every attribute; faces have
///                  those of the cell behind them. Wedges in VTK's order, whose base looks outwards
///   .msh           Gmsh 2.2, text; regions and patches are physical groups with their names, patches numbered from 1,
///                  regions after them; no attributes. .msh4: the same in 4.1, with an entity for each
///   .node, .ele, .face  TetGen, all three, from 0; regions are the attribute of tetrahedra, patches the marker of
///                  faces, from 1; tetrahedra alone, no other attributes
///   .inp           Abaqus and CalculiX: C3D4 and C3D6 from 1, no pyramids; for each region an ELSET, for each patch an
///                  NSET and a SURFACE of its name; positions with 13 digits, which is all that is read; no attributes
///   polyMesh       OpenFOAM, text; patches whose names begin with "wall" are of type wall; a cellZone for each region
///                  if there are several; no attributes. OpenFOAM counts in metres: choose that unit
///   mesh-complete  SimVascular: mesh-complete.mesh.vtu, mesh-complete.exterior.vtp, walls_combined.vtp (patches whose
///                  names begin with "wall") and mesh-surfaces/PATCH.vtp, with GlobalNodeID and GlobalElementID from 1,
///                  ModelRegionID and ModelFaceID; tetrahedra alone; attributes in the first two
/// Throws InvalidInput when the mesh or an attribute is not consistent (check_volume_mesh(), sides_of_boundary();
/// polyMesh: inner_faces()), Unsupported (extension; cells that a format does not have), WriteError.
void write_volume(const std::filesystem::path& path, const VolumeMesh& mesh, const VolumeMetadata& metadata = {},
                  const VolumeAttributes& attributes = {}, const VolumeWriteOptions& options = {});

struct LoadedVolume {
  VolumeMesh mesh;
  VolumeAttributes attributes;            ///< under the names that write_volume() takes
  LengthUnit unit = LengthUnit::unknown;  ///< as tagged in the file; positions are not converted
  Space space = Space::unknown;           ///< as tagged in the file; positions are not converted
  std::vector<std::string> warnings;      ///< what was left out or changed
};

/// Reads a volume mesh by extension (.vtu). Cells whose corners are in an order that gives them a negative volume are
/// turned, lines and loose points left out. Where the file has no faces, the outside of the cells is one patch, "wall".
/// Throws ReadError (missing, a directory, unreadable), InvalidInput (content; cells that are neither tetrahedra,
/// wedges nor pyramids), Unsupported (extension).
LoadedVolume read_volume(const std::filesystem::path& path);

/// read_volume() from memory; `source` names it in messages.
LoadedVolume parse_volume(std::string_view content, const VolumeFormat& format, const std::string& source);

}  // namespace vmesh
