#include "vmesh/io/surface_io.h"

#include <list>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "lengths.h"
#include "named_patches.h"

namespace vmesh {
namespace {

void check(const std::filesystem::path& path, const TriMesh& mesh, const MeshAttributes& attributes) {
  const std::string name = path.string();
  if (mesh.vertices.size() >= 0x80000000 || mesh.faces.size() >= 0x80000000) {
    throw InvalidInput(name + ": the surface has too many vertices or faces for its file format (2^31)");
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      if (v >= mesh.vertices.size()) {
        throw InvalidInput(name + ": face " + std::to_string(f) + ": there is no vertex " + std::to_string(v));
      }
    }
  }
  const auto check_all = [&](const std::vector<MeshAttribute>& list, std::size_t count, const char* kind) {
    for (const auto& a : list) {
      if (a.name.empty()) throw InvalidInput(name + ": a " + kind + " attribute has no name");
      if (a.values.size() != count) {
        throw InvalidInput(name + ": the " + kind + " attribute " + a.name + " has " + std::to_string(a.values.size()) +
                           " values, there should be " + std::to_string(count));
      }
    }
  };
  check_all(attributes.vertex, mesh.vertices.size(), "vertex");
  check_all(attributes.face, mesh.faces.size(), "face");
  try {
    io::check_named_patches(attributes);
  } catch (const InvalidInput& error) {
    throw InvalidInput(name + ": " + error.what());
  }
}

void check(const std::filesystem::path& path, const SurfaceFormat& format, const TriMesh& mesh,
           const SurfaceSkin& skin) {
  constexpr std::size_t kMostJoints = 0xffff;  // numbers of joints have 16 bits
  const std::string name = path.string();
  if (!format.holds_bones)
    throw Unsupported(name + ": bones are written to " +
                      listed(extensions_of(surface_formats(), [](const auto& f) { return f.holds_bones; })) + " only");
  if (skin.joints.size() > kMostJoints)
    throw Unsupported(name + ": " + std::to_string(skin.joints.size()) + " bones are more than the " +
                      std::to_string(kMostJoints) + " that glTF can number; leave out nodes of the centerline");
  bool good = skin.joint_of_vertex.size() == mesh.vertices.size() && skin.weight.size() == mesh.vertices.size();
  for (const auto& joints : skin.joint_of_vertex) {
    for (const Index joint : joints) good = good && joint < skin.joints.size();
  }
  if (!good) throw InvalidInput(name + ": the skin does not fit the surface: joints and weights are one per vertex");
}

void check(const std::filesystem::path& path, const SurfaceFormat& format, SurfaceEncoding encoding) {
  const std::string name = path.string() + ": ";
  if (encoding == SurfaceEncoding::text && !format.has_text_form)
    throw Unsupported(name + format.name + (format.is_text ? " is always text" : " has no text form") +
                      "; there is one beside the binary one of " +
                      listed(extensions_of(surface_formats(), [](const auto& f) { return f.has_text_form; }), "and"));
  if (encoding != SurfaceEncoding::compressed) return;
  if (!format.has_compressed_form)
    throw Unsupported(name + format.name + " has no compressed form; compressed are " +
                      listed(extensions_of(surface_formats(), [](const auto& f) { return f.has_compressed_form; })));
  if (!VMESH_IO_WITH_MESHOPTIMIZER)
    throw Unsupported(name +
                      "to compress it needs meshoptimizer, and this vmesh was built without it (CMake option "
                      "VMESH_WITH_MESHOPTIMIZER); write it uncompressed");
}

// Between LPS and another space; the same in both directions.
void convert(TriMesh& mesh, MeshAttributes& attributes, double scale, Space space) {
  io::move_points(mesh.vertices, scale, space);
  io::scale_lengths(attributes.vertex, scale);
  io::scale_lengths(attributes.face, scale);
}

}  // namespace

const SurfaceFormat* find_surface_format(const std::filesystem::path& path) {
  return find_format(surface_formats(), path);
}

const SurfaceFormat& surface_format(const std::filesystem::path& path) {
  if (const SurfaceFormat* format = find_surface_format(path)) return *format;
  throw Unsupported(path.string() + ": surfaces are " +
                    listed(extensions_of(surface_formats(), [](const auto&) { return true; })) + "; \"" +
                    extension_of(path) + "\" is not supported");
}

const SurfaceFormat& surface_output_format(const std::filesystem::path& path) {
  const SurfaceFormat* format = find_surface_format(path);
  if (format != nullptr && format->is_written()) return *format;
  const std::string what = format != nullptr ? "files of this kind are read, not written; write the surface as "
                                             : "\"" + extension_of(path) + "\" is not supported; write the surface as ";
  throw Unsupported(path.string() + ": " + what +
                    listed(extensions_of(surface_formats(), [](const auto& f) { return f.is_written(); })));
}

std::vector<std::filesystem::path> files_of_surface(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files = {path};
  if (const SurfaceFormat* format = find_surface_format(path)) {
    for (const SurfaceFormat::FileBeside& beside : format->beside) {
      files.push_back(path);
      files.back().replace_extension(beside.extension);
    }
  }
  return files;
}

void write_surface(const std::filesystem::path& path, const TriMesh& given, const MeshAttributes& given_attributes,
                   const SurfaceMetadata& metadata, const SurfaceWriteOptions& options) {
  const SurfaceFormat& format = surface_output_format(path);
  check(path, given, given_attributes);
  check(path, format, options.encoding);
  if (options.skin) check(path, format, given, *options.skin);
  TriMesh converted;
  MeshAttributes converted_attributes;
  const bool converts = !format.has_own_frame && (metadata.unit != LengthUnit::mm || metadata.space != Space::lps);
  if (converts) {
    converted = given;
    converted_attributes = given_attributes;
    convert(converted, converted_attributes, 1 / millimetres_per(metadata.unit), metadata.space);
  }
  const TriMesh& mesh = converts ? converted : given;
  const MeshAttributes& attributes = converts ? converted_attributes : given_attributes;
  std::list<AtomicFile> files;
  const std::vector<std::filesystem::path> paths = files_of_surface(path);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    SurfaceFormat::Write* const write = i == 0 ? format.write : format.beside[i - 1].write;
    write(files.emplace_back(paths[i]).stream(), mesh, attributes, metadata, options);
  }
  // That which the others belong to comes last.
  for (auto file = files.rbegin(); file != files.rend(); ++file) file->commit();
}

LoadedSurface parse_surface(std::string_view content, const SurfaceFormat& format, const std::string& source) {
  if (!format.parse) throw Unsupported(source + ": files of this kind are read by their names only");
  LoadedSurface surface = format.parse(content, source);
  io::settle_patch_names(surface, source);
  return surface;
}

LoadedSurface read_surface(const std::filesystem::path& path) {
  const SurfaceFormat& format = surface_format(path);
  if (format.read) {
    LoadedSurface surface = format.read(path);
    io::settle_patch_names(surface, path.string());
    return surface;
  }
  if (!format.parse) refuse_without(format.needs, path);
  return parse_surface(read_file(path), format, path.string());
}

void convert_to_internal(LoadedSurface& surface, const std::string& source, std::optional<LengthUnit> unit,
                         std::optional<Space> space) {
  if (unit) surface.unit = *unit;
  if (space) surface.space = *space;
  if (surface.unit == LengthUnit::unknown) {
    surface.warnings.push_back(
        source + ": the file does not say its unit; taken as mm (set it with --unit nm, um, mm, cm or m)");
    surface.unit = LengthUnit::mm;
  }
  if (surface.space == Space::unknown) {
    surface.warnings.push_back(source +
                               ": the file does not say its frame; taken as LPS (set it with --space LPS or RAS)");
    surface.space = Space::lps;
  }
  if (surface.unit != LengthUnit::mm || surface.space != Space::lps)
    convert(surface.mesh, surface.attributes, millimetres_per(surface.unit), surface.space);
  surface.unit = LengthUnit::mm;
  surface.space = Space::lps;
}

}  // namespace vmesh
