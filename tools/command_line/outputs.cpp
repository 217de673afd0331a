#include "command_line/outputs.h"

#include <algorithm>
#include <iostream>
#include <span>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/version.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/ply_stream.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/render/render.h"

#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

namespace fs = std::filesystem;

using Kind = PlannedOutput::Kind;

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::surface:
      return "surface";
    case Kind::volume:
      return "volume mesh";
    case Kind::centerline:
      return "centerline";
    case Kind::picture:
      return "picture";
    case Kind::summary:
      return "summary";
    case Kind::report:
      return "report";
    case Kind::plot:
      return "plot";
    case Kind::page:
    case Kind::live_page:
      return "page";
  }
  return "";
}

bool needs_no_check(const PlannedOutput& output) {
  return output.path.empty() || (output.kind == Kind::summary && output.path == "-");
}

/// Whether both names lead to the same file, through links and relative paths; even if it does not exist yet.
bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path full_a = fs::weakly_canonical(a, error), full_b = fs::weakly_canonical(b, error);
  return !full_a.empty() && full_a == full_b;
}

void check_format(const PlannedOutput& output) {
  if (output.kind == Kind::summary) return;
  if (output.kind == Kind::surface) surface_output_format(output.path);
  if (output.kind == Kind::volume) volume_output_format(output.path);
  if (output.kind == Kind::centerline) centerline_output_format(output.path);
  const std::string extension = extension_of(output.path);
  if (output.kind == Kind::report && extension != ".txt" && extension != ".md" && extension != ".csv" &&
      extension != ".json")
    throw Unsupported(output.path.string() + ": reports are written as .txt, .md, .csv or .json");
  if (output.kind == Kind::plot && extension != ".svg")
    throw Unsupported(output.path.string() + ": plots are written as .svg only");
  if (output.kind == Kind::page || output.kind == Kind::live_page) {
    if (extension != ".html" && extension != ".htm")
      throw Unsupported(output.path.string() + ": pages are written as .html or .htm");
    if (output.kind == Kind::live_page && !VMESH_TOOL_WITH_LIVE)
      throw Unsupported(
          "--live: this vmesh was built without pages that move; build it after scripts/install-dependencies "
          "--with-wasm, with -DVMESH_WITH_HTML=ON -DVMESH_WITH_LIVE=ON");
    if (!VMESH_TOOL_WITH_HTML)
      throw Unsupported(
          "--html: this vmesh was built without pages; build it after scripts/install-dependencies, with "
          "-DVMESH_WITH_HTML=ON");
  }
  if (output.kind == Kind::picture && extension != ".png")
    throw Unsupported(output.path.string() + ": pictures are written as .png only");
}

/// That are written under its name.
std::vector<fs::path> files_of(const PlannedOutput& output) {
  if (output.kind == Kind::surface) return files_of_surface(output.path);
  return {output.path};
}

/// An existing one, which is replaced if it holds nothing else.
bool is_folder_of_volume(const PlannedOutput& output) {
  return output.kind == Kind::volume && volume_output_format(output.path).is_folder() && fs::is_directory(output.path);
}

}  // namespace

void check_outputs(const std::vector<PlannedOutput>& outputs, const std::vector<fs::path>& inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (needs_no_check(*output)) continue;
    const std::string name = output->path.string();
    check_format(*output);
    for (const fs::path& file : files_of(*output)) {
      const std::string beside = file == output->path ? "" : ": would be written with " + name;
      for (const fs::path& input : inputs)
        if (same_file(file, input))
          throw UsageError(file.string() + beside + (beside.empty() ? ": is an input" : ", and is an input") +
                           "; choose another name for the " + name_of(output->kind));
      for (auto other = outputs.begin(); other != output; ++other) {
        if (needs_no_check(*other)) continue;
        for (const fs::path& other_file : files_of(*other))
          if (same_file(file, other_file))
            throw UsageError(file.string() + ": given both for the " + name_of(other->kind) + " and for the " +
                             name_of(output->kind));
      }
      if (!is_folder_of_volume(*output)) check_can_be_written(file);
    }
  }
}

void write_text(const fs::path& path, const std::string& text) {
  if (path == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw WriteError("cannot write to stdout");
    return;
  }
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

namespace {

void add_colors(std::vector<MeshAttribute>& attributes) {
  const MeshAttribute* branch = find_attribute(attributes, "branch");
  if (!branch || find_attribute(attributes, "red")) return;
  std::vector<MeshAttribute> color = {{"red", {}, true}, {"green", {}, true}, {"blue", {}, true}};
  for (const double label : branch->values) {
    const Color of_label = label_color(label);
    for (std::size_t i = 0; i < 3; ++i) color[i].values.push_back(of_label[i]);
  }
  attributes.insert(attributes.end(), color.begin(), color.end());
}

void add_quality(std::vector<MeshAttribute>& attributes) {
  for (const char* name : {"displacement", "volume_distance", "distance", "radius"}) {
    const MeshAttribute* source = find_attribute(attributes, name);
    if (!source) continue;
    MeshAttribute quality{"quality", source->values};
    std::erase_if(attributes, [](const MeshAttribute& a) { return a.name == "quality"; });
    attributes.push_back(std::move(quality));
    return;
  }
}

}  // namespace

void add_for_viewers(const std::string& extension, std::vector<MeshAttribute>& attributes) {
  if (extension == ".ply" || extension == ".glb") add_colors(attributes);
  if (extension == ".ply") add_quality(attributes);
}

void write_surface(const fs::path& path, const TriMesh& mesh, MeshAttributes attributes, SurfaceMetadata metadata,
                   const WritingArguments& writing, const SurfaceSkin* skin) {
  const std::string extension = extension_of(path);
  if (writing.attributes != "all") attributes.face.clear();
  if (writing.attributes == "none") attributes.vertex.clear();
  add_for_viewers(extension, attributes.vertex);
  metadata.unit = writing.unit;
  metadata.space = writing.space;
  vmesh::write_surface(path, mesh, attributes, metadata, {writing.encoding, skin});
}

bool can_be_written_by_blocks(const fs::path& path, const WritingArguments& writing) {
  return extension_of(path) == ".ply" && writing == WritingArguments{};
}

void write_by_blocks(const fs::path& path, const TriMesh& mesh, const AttributeBlocks& attributes,
                     const SurfaceMetadata& metadata) {
  constexpr std::size_t kBlock = 1 << 15;
  const auto of_vertices = [&](std::size_t begin, std::size_t end) {
    std::vector<MeshAttribute> block = attributes.of_vertices(begin, end);
    add_for_viewers(".ply", block);
    return block;
  };
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.faces.size();
  PlyStream stream(path, vertices, faces, {of_vertices(0, 0), attributes.of_faces(0, 0), {}}, metadata);
  const std::vector<Vec3> normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < vertices; v += kBlock) {
    const std::size_t count = std::min(kBlock, vertices - v);
    stream.add_vertices(std::span(mesh.vertices).subspan(v, count), std::span(normals).subspan(v, count),
                        of_vertices(v, v + count));
  }
  for (std::size_t f = 0; f < faces; f += kBlock) {
    const std::size_t count = std::min(kBlock, faces - f);
    stream.add_faces(std::span(mesh.faces).subspan(f, count), attributes.of_faces(f, f + count));
  }
  stream.commit();
}

void write_centerline(const fs::path& path, const Centerline& centerline, const CenterlineMetadata& metadata,
                      const std::vector<EndSection>& sections, Console& console) {
  vmesh::write_centerline(path, centerline, metadata, sections);
  if (sections.empty() || centerline_format(path).keeps_end_sections) return;
  const auto keeping =
      extensions_of(centerline_formats(), [](const auto& f) { return f.keeps_end_sections && f.is_written(); });
  console.log(path.string() + ": " + std::to_string(sections.size()) +
              (sections.size() == 1 ? " flat end is" : " flat ends are") + " lost, being kept only in " +
              listed(keeping, "and"));
}

namespace {

/// `format`: null if it is no surface's.
void check_is_text(const fs::path& path, const SurfaceFormat* format) {
  if (format != nullptr && format->has_text_form) return;
  const std::string name = path.string() + ": ";
  if (format != nullptr && format->is_text)
    throw UsageError(name + format->name + " is always text; leave out --ascii");
  throw UsageError(name + "--ascii is for surfaces in " +
                   listed(extensions_of(surface_formats(), [](const auto& f) { return f.has_text_form; }), "and"));
}

}  // namespace

void check_writing(const fs::path& path, const WritingArguments& writing) {
  const SurfaceFormat* format = find_surface_format(path);
  if (writing.encoding == SurfaceEncoding::text) check_is_text(path, format);
  if (writing.encoding == SurfaceEncoding::compressed && (format == nullptr || !format->has_compressed_form))
    throw UsageError(path.string() + ": --compress is for " +
                     listed(extensions_of(surface_formats(), [](const auto& f) { return f.has_compressed_form; })) +
                     " only");
  if (format != nullptr && !format->beside.empty() && writing.attributes != "all")
    throw UsageError(path.string() + ": " + format->name + " needs the attributes of faces; leave out --attributes");
  if (format == nullptr && writing.attributes != "all")
    throw UsageError(path.string() + ": --attributes is for surfaces; this is a centerline's");
  if (format != nullptr && format->has_own_frame && (writing.unit != LengthUnit::mm || writing.space != Space::lps))
    throw UsageError(path.string() + ": " + format->name +
                     " is always in metres with y up; --output-unit and --output-space do not apply");
}

std::string generator_name() { return "vmesh " + std::string(version()); }

}  // namespace vmesh::tool
