#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/surface/surface_attributes.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// A file a command is going to write.
struct PlannedOutput {
  enum class Kind { surface, volume, centerline, picture, summary, report, plot, page, live_page };
  std::filesystem::path path;
  Kind kind;
};

/// Refuses what could not be written later. Throws Unsupported for an extension this build cannot write, WriteError for
/// a folder that does not exist or cannot be written, UsageError for a file that is also an input or another output,
/// under whatever name. An empty path, and "-" (stdout) for a summary, are always fine.
void check_outputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::filesystem::path>& inputs);

/// Writes `text` to stdout when `path` is "-", else to the file: complete or not at all. Throws WriteError.
void write_text(const std::filesystem::path& path, const std::string& text);

/// write_surface() as requested on the command line. In PLY and GLB, vertices with a `branch` are coloured by it; PLY
/// also gets `quality`, which MeshLab shows by default: the distance or displacement, else the radius.
void write_surface(const std::filesystem::path& path, const TriMesh& mesh, MeshAttributes attributes,
                   SurfaceMetadata metadata, const WritingArguments& writing, const SurfaceSkin* skin = nullptr);

/// Whether write_by_blocks() can write a surface so.
bool can_be_written_by_blocks(const std::filesystem::path& path, const WritingArguments& writing);

/// The same file as by write_surface(), without all attributes in memory.
void write_by_blocks(const std::filesystem::path& path, const TriMesh& mesh, const AttributeBlocks& attributes,
                     const SurfaceMetadata& metadata);

/// write_centerline(); logs how many flat ends are lost if the format has no room for them.
void write_centerline(const std::filesystem::path& path, const Centerline& centerline,
                      const CenterlineMetadata& metadata, const std::vector<EndSection>& sections, Console& console);

/// Adds what write_surface() adds to the attributes of vertices for this extension: colours, and in PLY the quality.
void add_for_viewers(const std::string& extension, std::vector<MeshAttribute>& attributes);

/// Throws UsageError for a unit, frame or encoding that the format does not have.
void check_writing(const std::filesystem::path& path, const WritingArguments& writing);

/// "vmesh 0.1.0", for metadata.
std::string generator_name();

}  // namespace vmesh::tool
