// Scene formats, read through assimp: GLB, glTF, 3MF, COLLADA, X3D and FBX.
#include <array>
#include <map>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <minizip/unzip.h>
#include <pugixml.hpp>

#include "vmesh/core/child_process.h"
#include "vmesh/core/input_file.h"

#include "bytes.h"
#include "formats.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

/// The faces of a scene with its nodes' transformations applied; coincident corners become one vertex.
class SceneFaces {
 public:
  /// `source`: for messages.
  explicit SceneFaces(const std::string& source) : source_(source) {}

  void add(const aiScene& scene) { add_node(scene, *scene.mRootNode, aiMatrix4x4()); }

  /// Counts of vertices, faces and corners; vertices; for every face its number of corners and these.
  std::string bytes() const {
    std::string result;
    for (const std::size_t count : {vertices_.size(), faces_, corners_.size()})
      store(result, static_cast<std::uint64_t>(count));
    for (const auto& vertex : vertices_) {
      for (const float x : vertex) store(result, x);
    }
    for (const std::uint32_t number : corners_) store(result, number);
    return result;
  }

 private:
  void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above) {
    const aiMatrix4x4 transformation = above * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add_mesh(*scene.mMeshes[node.mMeshes[i]], transformation);
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], transformation);
  }

  void add_mesh(const aiMesh& mesh, const aiMatrix4x4& transformation) {
    std::vector<std::uint32_t> number;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = transformation * mesh.mVertices[v];
      const std::array<float, 3> key = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // no -0
      const auto [at, is_new] = number_.emplace(key, static_cast<std::uint32_t>(vertices_.size()));
      if (is_new) vertices_.push_back(key);
      number.push_back(at->second);
    }
    const bool mirrored = transformation.Determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;
      ++faces_;
      corners_.push_back(face.mNumIndices);
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - i : i];
        if (v >= number.size()) {  // assimp checks some formats only
          throw InvalidInput(source_ + ": a face refers to vertex " + std::to_string(v) + " of a mesh with " +
                             std::to_string(number.size()));
        }
        corners_.push_back(number[v]);
      }
    }
  }

  const std::string& source_;
  std::map<std::array<float, 3>, std::uint32_t> number_;
  std::vector<std::array<float, 3>> vertices_;
  std::vector<std::uint32_t> corners_;
  std::size_t faces_ = 0;
};

/// Frame and unit of a format's numbers.
struct SceneFrame {
  bool y_up = false;
  LengthUnit unit = LengthUnit::unknown;
  float scale = 1;  ///< to that unit
};

/// The beginning of the model in a 3MF file, which is a ZIP archive; empty when there is none.
std::string beginning_of_model(const std::filesystem::path& path) {
  constexpr std::size_t kEnough = 1 << 16;  // for everything before the first vertex
  constexpr int kAnyCase = 2;
  const unzFile archive = unzOpen64(path.c_str());
  if (archive == nullptr) return {};
  std::string text;
  if (unzLocateFile(archive, "3D/3dmodel.model", kAnyCase) == UNZ_OK && unzOpenCurrentFile(archive) == UNZ_OK) {
    text.resize(kEnough);
    const int count = unzReadCurrentFile(archive, text.data(), static_cast<unsigned>(text.size()));
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    unzCloseCurrentFile(archive);
  }
  unzClose(archive);
  return text;
}

/// The unit, which assimp does not report; millimetres by default (3MF Core Specification 1.2, 3.4).
SceneFrame frame_of_3mf(const std::filesystem::path& path) {
  const std::string text = beginning_of_model(path);
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size());  // parses as far as possible
  const std::string unit = document.document_element().attribute("unit").as_string("millimeter");
  if (unit == "micron") return {false, LengthUnit::um, 1};
  if (unit == "millimeter") return {false, LengthUnit::mm, 1};
  if (unit == "centimeter") return {false, LengthUnit::cm, 1};
  if (unit == "meter") return {false, LengthUnit::m, 1};
  if (unit == "inch") return {false, LengthUnit::mm, 25.4F};
  if (unit == "foot") return {false, LengthUnit::mm, 304.8F};
  return {};
}

SceneFrame frame_of(const std::filesystem::path& path, const std::string& extension, const aiScene& scene) {
  if (extension == ".3mf") return frame_of_3mf(path);
  if (extension != ".fbx") return {true, LengthUnit::m, 1};  // glTF and X3D say so, assimp converts COLLADA
  double factor = 1;                                         // centimetres
  int up = 1;
  if (scene.mMetaData) {
    float single = 0;
    if (scene.mMetaData->Get("UnitScaleFactor", single))
      factor = single;
    else
      scene.mMetaData->Get("UnitScaleFactor", factor);
    scene.mMetaData->Get("UpAxis", up);
  }
  return {up == 1, LengthUnit::cm, static_cast<float>(factor)};
}

/// Whether a glTF file's JSON, or what contains it, says that nothing can be made of the file without the extension.
bool requires_extension(std::string_view content, std::string_view name) {
  const std::size_t list = content.find("\"extensionsRequired\"");
  if (list == std::string_view::npos) return false;
  const std::string_view names = content.substr(list, content.substr(list).find(']'));
  return names.find(name) != std::string_view::npos;
}

std::string imported(const std::filesystem::path& path, const std::string& content, const std::string& extension) {
  const std::string source = path.string();
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  // A .gltf refers to other files beside it.
  const aiScene* scene = extension == ".gltf"
                             ? importer.ReadFile(path.string(), 0)
                             : importer.ReadFileFromMemory(content.data(), content.size(), 0, extension.c_str() + 1);
  if (!scene || !scene->mRootNode)
    throw InvalidInput(source + ": " + one_line(std::string_view(importer.GetErrorString()).substr(0, 300)));
  SceneFaces faces(source);
  faces.add(*scene);
  const SceneFrame frame = frame_of(path, extension, *scene);
  std::string answer;
  store(answer, static_cast<std::uint8_t>(frame.y_up));
  store(answer, static_cast<std::uint8_t>(frame.unit));
  store(answer, frame.scale);
  return answer + faces.bytes();
}

/// Reads numbers from the child process's answer.
class Answer {
 public:
  explicit Answer(const std::string& bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    if (bytes_.size() - at_ < sizeof(T)) throw InvalidInput("the answer of the library is cut off");
    at_ += sizeof(T);
    return load<T>(bytes_.data() + at_ - sizeof(T));
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

LoadedSurface read_scene(const std::filesystem::path& path) {
  const std::string source = path.string(), extension = extension_of(path);
  const std::string content = read_file(path);
  constexpr const char* kCompression = "EXT_meshopt_compression";
  if ((extension == ".glb" || extension == ".gltf") && requires_extension(content, kCompression))
    throw Unsupported(source + ": it is compressed by " + kCompression +
                      ", which is not read; give the file from which it was made, or write it uncompressed");
  const std::string bytes =
      in_child_process(source, content.size(), [&] { return imported(path, content, extension); });
  Answer answer(bytes);
  LoadedSurface surface;
  const bool y_up = answer.take<std::uint8_t>() != 0;
  surface.unit = static_cast<LengthUnit>(answer.take<std::uint8_t>());
  const double scale = answer.take<float>();
  const auto vertices = answer.take<std::uint64_t>(), faces = answer.take<std::uint64_t>();
  answer.take<std::uint64_t>();
  for (std::uint64_t v = 0; v < vertices; ++v) {
    Vec3 p;
    for (double& x : p) x = scale * answer.take<float>();
    surface.mesh.vertices.push_back(y_up ? Vec3(p.x(), -p.z(), p.y()) : p);
  }
  FaceCollector collector(surface, source);
  std::vector<std::int64_t> corners;
  for (std::uint64_t f = 0; f < faces; ++f) {
    corners.resize(answer.take<std::uint32_t>());
    for (std::int64_t& corner : corners) corner = answer.take<std::uint32_t>();
    collector.add(corners, "face " + std::to_string(f));
  }
  collector.finish();
  return surface;
}

}  // namespace vmesh::io
