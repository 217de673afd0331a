#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/core/file_format.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

struct VolumeMetadata;
struct VolumeWriteOptions;

/// A format of volume meshes: what it is called and what writes it.
struct VolumeFormat {
  std::string name;
  std::vector<std::string> extensions;  ///< lower case, with their dots

  using Write = void(std::ostream& out, const VolumeMesh& mesh, const VolumeAttributes& attributes,
                     const VolumeMetadata& metadata, const VolumeWriteOptions& options);
  Write* write = nullptr;

  bool is_written() const { return write != nullptr; }
};

/// All formats. Adding one: see CONTRIBUTING.md.
const std::vector<VolumeFormat>& volume_formats();

/// The format by the file's extension, upper or lower case; null if it is not a volume mesh's.
const VolumeFormat* find_volume_format(const std::filesystem::path& path);

/// The same for a file to be written: throws Unsupported, listing what can be written.
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

/// What some formats can do.
struct VolumeWriteOptions {};

/// Writes a volume mesh (given in mm and LPS) in the format of the extension, in the unit and frame of `metadata`,
/// which are recorded. Attributes named radius, distance, displacement and volume_distance are lengths. The bytes
/// depend on the arguments alone, and the file appears complete or not at all.
///   VTU  packed by zlib; the cells, then the faces of the boundary. For both, ModelRegionID is the number of the
///   region
///        from 1 (of a face, of the cell behind it), ModelFaceID that of the patch from 1, 0 for cells; RegionNames and
///        PatchNames in the field data are their names. Every attribute; faces have those of the cell behind them.
///        Corners of wedges are in the order of VTK's documentation, whose base looks outwards
/// Throws InvalidInput when the mesh or an attribute is not consistent (check_volume_mesh(), cells_behind_boundary()),
/// Unsupported (extension), WriteError.
void write_volume(const std::filesystem::path& path, const VolumeMesh& mesh, const VolumeMetadata& metadata = {},
                  const VolumeAttributes& attributes = {}, const VolumeWriteOptions& options = {});

}  // namespace vmesh
