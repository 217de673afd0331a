#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/centerline/raw_centerline.h"
#include "vmesh/core/file_format.h"

namespace vmesh {

struct CenterlineMetadata;
struct CenterlineReadOptions;

/// A format of centerlines: what it is called, what it can hold, and what reads and writes it.
struct CenterlineFormat {
  std::string name;
  std::vector<std::string> extensions;  ///< lower case, with their dots
  std::vector<std::string> options =
      {};                           ///< of CenterlineReadOptions, those that act on it besides `radius` and `tolerance`
  bool one_branch = false;          ///< a file holds one branch of a tree
  bool trees_only = false;          ///< cannot hold loops
  bool keeps_end_sections = false;  ///< has room for flat ends
  OptionalPart needs = {};          ///< what `read` needs

  /// From the content of a file that `source` names in messages.
  using Parse = RawCenterline(std::string_view content, const std::string& source,
                              const CenterlineReadOptions& options);
  using Write = void(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                     const std::vector<EndSection>& end_sections);
  /// Of extensions whose files mostly are surfaces: whether this one has lines and no faces. Throws InvalidInput.
  bool (*holds_lines)(std::string_view content) = nullptr;
  // The functions of the format, null where it has none. It is read by one of the first three.
  Parse* parse = nullptr;
  RawCenterline (*parse_pair)(std::string_view content, std::string_view second, const std::string& source,
                              const std::string& second_source, const CenterlineReadOptions& options) = nullptr;
  RawCenterline (*read)(const std::filesystem::path& path) = nullptr;
  Write* write = nullptr;
  void (*write_pair)(std::ostream& out, std::ostream& second, const Centerline& centerline,
                     const CenterlineMetadata& metadata) = nullptr;
  /// Of formats of two files: the second one. Throws InvalidInput if `path` is the second.
  std::filesystem::path (*second_file)(const std::filesystem::path& path) = nullptr;
  /// The same as another program names it, for files that are read; empty if it has none for that name.
  std::filesystem::path (*others_second_file)(const std::filesystem::path& path) = nullptr;

  bool is_written() const { return write != nullptr || write_pair != nullptr; }
};

/// All formats. Adding one: see CONTRIBUTING.md.
const std::vector<CenterlineFormat>& centerline_formats();

/// The format by the file's extension, upper or lower case; null if it is not a centerline's.
const CenterlineFormat* find_centerline_format(const std::filesystem::path& path);

/// The same; otherwise throws Unsupported, listing the supported extensions.
const CenterlineFormat& centerline_format(const std::filesystem::path& path);

/// The same for a file to be written: throws Unsupported, listing what can be written, for read-only formats too.
const CenterlineFormat& centerline_output_format(const std::filesystem::path& path);

/// The second file of a CSV pair: tree.csv or tree.nodes.csv (header `id,x,y,z,radius`) goes with
/// tree.segments.csv (header `a,b`, the ids of the nodes it joins).
std::filesystem::path csv_segments_path(const std::filesystem::path& nodes_path);

/// Of a format of two files, the second one of those to be read: another program's if it is there and ours is not.
std::filesystem::path second_file_to_read(const CenterlineFormat& format, const std::filesystem::path& path);

struct CenterlineReadOptions {
  /// Name of the array, column, property or measurement with the radius, or with the diameter if the name contains
  /// "diam", or with the area of the cross-section if it contains "area". Empty: MaximumInscribedSphereRadius, Radius
  /// or radius, or the only area; for Amira also thickness.
  std::string radius_array;
  /// Radius (mm, > 0) of all nodes if the file has none. Files without radii are refused otherwise.
  std::optional<double> radius;
  /// Ends of branches, of one file or of several, that are nearer to each other than this are joined when the
  /// centerline is cleaned, also where that closes a loop.
  std::optional<EndTolerance> tolerance;
  /// GXL: sides of a voxel, in the unit of the radii; such files are refused without it. SWC: positions and radii are
  /// in voxels of these sides, which must be equal.
  std::optional<Vec3> voxel_size;
};

/// The options given that act on none of the files, by their names on the command line: "voxel-size".
std::vector<std::string> options_without_effect(const CenterlineReadOptions& options,
                                                const std::vector<std::filesystem::path>& paths);

/// Reads a centerline as it is in the file; clean() makes it a Centerline. Needs at most 128 times the size of the file
/// (compressed VTP: of its uncompressed data) plus a megabyte of memory, whatever the file says. Throws ReadError
/// (missing, a directory, unreadable), InvalidInput (content; names the line or element; options without effect),
/// Unsupported (format, or VTP compressed by anything but zlib).
RawCenterline read_centerline(const std::filesystem::path& path, const CenterlineReadOptions& options = {});

/// Reads several files that make up one centerline (one vessel each, say): see merge(). A single file is read as it is.
RawCenterline read_centerline(const std::vector<std::filesystem::path>& paths,
                              const CenterlineReadOptions& options = {});

/// The same from memory; `source` names it in messages. `csv_segments` is the second file of a CSV pair.
RawCenterline parse_centerline(std::string_view content, const CenterlineFormat& format, const std::string& source,
                               const CenterlineReadOptions& options = {}, std::string_view csv_segments = {});

/// The same from a stream.
RawCenterline read_centerline(std::istream& in, const CenterlineFormat& format, const std::string& source,
                              const CenterlineReadOptions& options = {});

/// convert_to_internal() after reading; nodes without a radius get the one in `options`, if any. Warns if radii are
/// implausible for the unit that was assumed or read.
RawCenterline convert_read(RawCenterline raw, const CenterlineReadOptions& options, std::optional<LengthUnit> unit,
                           std::optional<Space> space, std::vector<std::string>& warnings);

/// A copy without nodes and segments that still names them in messages.
RawCenterline names_of(RawCenterline raw);

/// From file to valid centerline in one call: read_centerline, convert_read, clean.
struct CenterlineLoadOptions {
  CenterlineReadOptions read;
  std::optional<LengthUnit> unit;  ///< overrides the file's
  std::optional<Space> space;      ///< overrides the file's
  CleaningOptions cleaning;
};
struct LoadedCenterline {
  CleanedCenterline cleaned;
  std::vector<std::string> warnings;  ///< of reader and conversion; what cleaning did is in cleaned.report
  RawCenterline file;                 ///< names the origins of `cleaned` (place_of_node); without nodes and segments
};
LoadedCenterline load_centerline(const std::filesystem::path& path, const CenterlineLoadOptions& options = {});
LoadedCenterline load_centerline(const std::vector<std::filesystem::path>& paths,
                                 const CenterlineLoadOptions& options = {});

struct CenterlineMetadata {
  std::string generator;             ///< program and version
  std::string options;               ///< how it was made, free text
  std::string input_name;            ///< name of the input
  std::string input_sha256;          ///< see sha256_of_file()
  LengthUnit unit = LengthUnit::mm;  ///< of the written numbers
  Space space = Space::lps;          ///< likewise
  /// The label of the segmentation that every segment comes from; empty: none. Written to JSON and VTP.
  std::vector<double> segment_labels = {};
};

/// Writes a centerline (given in mm and LPS) in the format of the extension, in the unit and frame of `metadata`, which
/// are recorded: JSON, SWC, VTP, CSV pair. Numbers round-trip exactly, the bytes depend on the arguments alone, and the
/// file appears complete or not at all. Node order is kept. Flat ends are written to JSON and VTP; other formats cannot
/// hold them. Throws InvalidInput for a flat end that is wrong or at no end; Unsupported for a
/// centerline with loops in SWC (a tree format), see centerline_output_format(); WriteError when the file cannot be
/// written.
void write_centerline(const std::filesystem::path& path, const Centerline& centerline,
                      const CenterlineMetadata& metadata = {}, const std::vector<EndSection>& end_sections = {});

}  // namespace vmesh
