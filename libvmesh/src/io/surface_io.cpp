#include "vmesh/io/surface_io.h"

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/core/input_file.h"

#include "formats.h"
#include "text.h"

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
}

void check(const std::filesystem::path& path, SurfaceFormat format, const TriMesh& mesh, const SurfaceSkin& skin) {
  constexpr std::size_t kMostJoints = 0xffff;  // numbers of joints have 16 bits
  const std::string name = path.string();
  if (format != SurfaceFormat::glb) throw Unsupported(name + ": bones are written to .glb only");
  if (skin.joints.size() > kMostJoints)
    throw Unsupported(name + ": " + std::to_string(skin.joints.size()) + " bones are more than the " +
                      std::to_string(kMostJoints) + " that glTF can number; leave out nodes of the centerline");
  bool good = skin.joint_of_vertex.size() == mesh.vertices.size() && skin.weight.size() == mesh.vertices.size();
  for (const auto& joints : skin.joint_of_vertex) {
    for (const Index joint : joints) good = good && joint < skin.joints.size();
  }
  if (!good) throw InvalidInput(name + ": the skin does not fit the surface: joints and weights are one per vertex");
}

bool is_length(const std::string& attribute) {
  return attribute == "radius" || attribute == "distance" || attribute == "displacement" ||
         attribute == "volume_distance";
}

// Between LPS and another space; the same in both directions.
void convert(TriMesh& mesh, MeshAttributes& attributes, double scale, Space space) {
  const Vec3 axes = space == Space::ras ? Vec3(-scale, -scale, scale) : Vec3(scale, scale, scale);
  for (Vec3& p : mesh.vertices) p = p.cwiseProduct(axes);
  for (auto* list : {&attributes.vertex, &attributes.face}) {
    for (MeshAttribute& a : *list) {
      if (!is_length(a.name)) continue;
      for (double& value : a.values) value *= scale;
    }
  }
}

}  // namespace

SurfaceFormat surface_format(const std::filesystem::path& path) {
  const std::string extension = io::lower(path.extension().string());
  if (extension == ".off") return SurfaceFormat::off;
  if (extension == ".obj") return SurfaceFormat::obj;
  if (extension == ".stl") return SurfaceFormat::stl;
  if (extension == ".ply") return SurfaceFormat::ply;
  if (extension == ".vtp") return SurfaceFormat::vtp;
  if (extension == ".vtk") return SurfaceFormat::vtk;
  if (extension == ".glb") return SurfaceFormat::glb;
  for (const char* scene : {".gltf", ".3mf", ".dae", ".x3d", ".fbx"}) {
    if (extension == scene) return SurfaceFormat::scene;
  }
  throw Unsupported(path.string() +
                    ": surfaces are .off, .obj, .stl, .ply, .vtp, .vtk, .glb, .gltf, .3mf, .dae, .x3d or .fbx; \"" +
                    extension + "\" is not supported");
}

SurfaceFormat surface_output_format(const std::filesystem::path& path) {
  const SurfaceFormat format = surface_format(path);
  if (format == SurfaceFormat::vtk)
    throw Unsupported(path.string() + ": legacy VTK files are read, not written; write a .vtp file");
  if (format == SurfaceFormat::scene)
    throw Unsupported(path.string() + ": scenes of this kind are read, not written; write a .glb file");
  return format;
}

void write_surface(const std::filesystem::path& path, const TriMesh& given, const MeshAttributes& given_attributes,
                   const SurfaceMetadata& metadata, const SurfaceSkin* skin) {
  const SurfaceFormat format = surface_output_format(path);
  check(path, given, given_attributes);
  if (skin) check(path, format, given, *skin);
  TriMesh converted;
  MeshAttributes converted_attributes;
  const bool converts =
      format != SurfaceFormat::glb && (metadata.unit != LengthUnit::mm || metadata.space != Space::lps);
  if (converts) {
    converted = given;
    converted_attributes = given_attributes;
    convert(converted, converted_attributes, 1 / millimetres_per(metadata.unit), metadata.space);
  }
  const TriMesh& mesh = converts ? converted : given;
  const MeshAttributes& attributes = converts ? converted_attributes : given_attributes;
  AtomicFile file(path);
  switch (format) {
    case SurfaceFormat::off:
      io::write_off(file.stream(), mesh, metadata);
      break;
    case SurfaceFormat::obj:
      io::write_obj(file.stream(), mesh, metadata);
      break;
    case SurfaceFormat::stl:
      io::write_stl(file.stream(), mesh, metadata);
      break;
    case SurfaceFormat::ply:
      io::write_ply(file.stream(), mesh, attributes, metadata);
      break;
    case SurfaceFormat::vtp:
      io::write_surface_vtp(file.stream(), mesh, attributes, metadata);
      break;
    case SurfaceFormat::glb:
      io::write_glb(file.stream(), mesh, attributes, metadata, skin);
      break;
    case SurfaceFormat::vtk:
    case SurfaceFormat::scene:
      break;  // refused above
  }
  file.commit();
}

LoadedSurface parse_surface(std::string_view content, SurfaceFormat format, const std::string& source) {
  switch (format) {
    case SurfaceFormat::off:
      return io::parse_off(content, source);
    case SurfaceFormat::obj:
      return io::parse_obj(content, source);
    case SurfaceFormat::stl:
      return io::parse_stl(content, source);
    case SurfaceFormat::ply:
      return io::parse_ply(content, source);
    case SurfaceFormat::vtp:
      return io::parse_surface_vtp(content, source);
    case SurfaceFormat::vtk:
      return io::parse_surface_vtk(content, source);
    case SurfaceFormat::glb:
    case SurfaceFormat::scene:
      throw Unsupported(source + ": scenes are read from files only");
  }
  throw Unsupported(source + ": unknown surface format");
}

LoadedSurface read_surface(const std::filesystem::path& path) {
  const SurfaceFormat format = surface_format(path);
  if (format == SurfaceFormat::glb || format == SurfaceFormat::scene) return io::read_scene(path);
  return parse_surface(read_file(path), format, path.string());
}

void convert_to_internal(LoadedSurface& surface, const std::string& source, std::optional<LengthUnit> unit,
                         std::optional<Space> space) {
  if (unit) surface.unit = *unit;
  if (space) surface.space = *space;
  if (surface.unit == LengthUnit::unknown) {
    surface.warnings.push_back(source +
                               ": the file does not say its unit; taken as mm (set it with --unit um, mm, cm or m)");
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
