#include "formats.h"

namespace vmesh {
namespace io {
namespace {

#if VMESH_IO_WITH_ASSIMP
constexpr auto kReadScene = read_scene;
#else
constexpr decltype(&read_scene) kReadScene = nullptr;
#endif

}  // namespace
}  // namespace io

const std::vector<SurfaceFormat>& surface_formats() {
  using namespace io;
  const OptionalPart assimp = {"assimp", ".ply, .obj, .off or .stl"};
  static const std::vector<SurfaceFormat> formats = {
      {.name = "OFF", .extensions = {".off"}, .is_text = true, .parse = parse_off, .write = write_off},
      {.name = "OBJ", .extensions = {".obj"}, .is_text = true, .parse = parse_obj, .write = write_obj},
      {.name = "STL", .extensions = {".stl"}, .has_text_form = true, .parse = parse_stl, .write = write_stl},
      {.name = "PLY", .extensions = {".ply"}, .has_text_form = true, .parse = parse_ply, .write = write_ply},
      {.name = "VTP", .extensions = {".vtp"}, .parse = parse_surface_vtp, .write = write_surface_vtp},
      {.name = "TetGen", .extensions = {".smesh"}, .is_text = true, .write = write_smesh},
      {.name = "SimVascular",
       .extensions = {".mdl"},
       .is_text = true,
       .write = write_model,
       .beside = {{".vtp", write_model_surface}, {".vtp.facenames", write_face_names}}},
      {.name = "legacy VTK", .extensions = {".vtk"}, .parse = parse_surface_vtk},
      {.name = "GLB",
       .extensions = {".glb"},
       .has_own_frame = true,
       .holds_bones = true,
       .has_compressed_form = true,
       .parse = parse_glb,
       .read = read_glb,
       .write = write_glb},
      {.name = "glTF", .extensions = {".gltf"}, .needs = assimp, .read = kReadScene},
      {.name = "3MF", .extensions = {".3mf"}, .needs = assimp, .read = kReadScene, .write = write_3mf},
      {.name = "COLLADA", .extensions = {".dae"}, .needs = assimp, .read = kReadScene},
      {.name = "X3D", .extensions = {".x3d"}, .needs = assimp, .read = kReadScene},
      {.name = "FBX", .extensions = {".fbx"}, .needs = assimp, .read = kReadScene},
  };
  return formats;
}

}  // namespace vmesh
