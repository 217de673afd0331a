// Surfaces in the GLB files that vmesh writes, with what other readers do not keep: attributes, the order of vertices,
// LPS in mm. Other GLB files are scenes.
#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "vmesh/core/input_file.h"
#include "vmesh/core/stored_number.h"

#include "formats.h"
#include "glb_colors.h"
#include "named_patches.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

/// The chunk of that type that begins at `at`, which is moved behind it; nullopt if there is none.
std::optional<std::string_view> take_chunk(std::string_view content, std::size_t& at, std::string_view type) {
  constexpr std::size_t kHead = 8;
  if (content.size() < at || content.size() - at < kHead || content.substr(at + 4, 4) != type) return std::nullopt;
  const std::size_t size = load<std::uint32_t>(content.data() + at);
  if (size > content.size() - at - kHead) return std::nullopt;
  const std::string_view chunk = content.substr(at + kHead, size);
  at += kHead + size;
  return chunk;
}

class GlbReader {
 public:
  GlbReader(const nlohmann::json& document, std::string_view bytes, const std::string& source)
      : document_(document), bytes_(bytes), source_(source), bytes_left_(bytes.size()) {}

  LoadedSurface run() {
    const nlohmann::json& primitive = element(member(element("meshes", 0), "primitives"), 0);
    const nlohmann::json& attributes = member(primitive, "attributes");
    LoadedSurface surface;
    surface.unit = LengthUnit::mm;
    surface.space = Space::lps;
    read_positions(index_in(attributes, "POSITION"), surface.mesh);
    if (attributes.contains("COLOR_0")) add_colors(index_in(attributes, "COLOR_0"), surface.attributes.vertex);
    for (const auto& [accessor, name] : custom_attributes(attributes))
      surface.attributes.vertex.push_back(attribute(name, accessor));
    read_faces(member(element("meshes", 0), "primitives"), index_in(attributes, "POSITION"), surface);
    return surface;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(source_ + ": " + what); }

  const nlohmann::json& member(const nlohmann::json& object, const char* key) const {
    if (!object.is_object()) fail("its description is broken; get the file anew");
    const auto found = object.find(key);
    if (found == object.end()) fail(std::string("its description has no \"") + key + "\"; get the file anew");
    return *found;
  }

  const nlohmann::json& element(const nlohmann::json& list, std::size_t i) const {
    if (!list.is_array() || i >= list.size()) fail("its description names what is not there; get the file anew");
    return list[i];
  }
  const nlohmann::json& element(const char* list, std::size_t i) const { return element(member(document_, list), i); }

  std::size_t index_of(const nlohmann::json& value) const {
    if (!value.is_number_unsigned()) fail("its description has no number where one must be; get the file anew");
    return value.get<std::size_t>();
  }
  std::size_t index_in(const nlohmann::json& object, const char* key) const { return index_of(member(object, key)); }

  /// The numbers of an accessor, `width` for every element. No two may share bytes, or a small file could grow without
  /// bound.
  template <class Number>
  std::vector<double> numbers(std::size_t accessor, std::size_t width, const char* kind) {
    const nlohmann::json& described = element("accessors", accessor);
    const nlohmann::json& view = element("bufferViews", index_in(described, "bufferView"));
    const std::size_t begin = index_in(view, "byteOffset"), size = index_in(view, "byteLength");
    const std::size_t count = index_in(described, "count");
    constexpr std::size_t kType = std::is_same_v<Number, float> ? 5126 : sizeof(Number) == 4 ? 5125 : 5123;
    if (index_in(described, "componentType") != kType || member(described, "type") != kind)
      fail("accessor " + std::to_string(accessor) + ": its numbers are not of the type that vmesh writes");
    if (begin > bytes_.size() || size > bytes_.size() - begin || count > size / (width * sizeof(Number)) ||
        size > bytes_left_)
      fail("accessor " + std::to_string(accessor) + ": its numbers are not there; the file is broken");
    bytes_left_ -= size;
    std::vector<double> values(count * width);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = load<Number>(bytes_.data() + begin + i * sizeof(Number));
    return values;
  }

  void read_positions(std::size_t accessor, TriMesh& mesh) {
    const std::vector<double> x = numbers<float>(accessor, 3, "VEC3");
    const Vec3 origin = translation();
    mesh.vertices.reserve(x.size() / 3);
    for (std::size_t i = 0; i < x.size(); i += 3) {
      const Vec3 p = 1e3 * (origin + Vec3(x[i], x[i + 1], x[i + 2]));
      mesh.vertices.emplace_back(p.x(), -p.z(), p.y());
    }
  }

  /// Of the surface, which has none if it has bones.
  Vec3 translation() const {
    Vec3 origin = Vec3::Zero();
    const nlohmann::json& node = element("nodes", 0);
    if (!node.is_object() || !node.contains("translation")) return origin;
    for (std::size_t a = 0; a < 3; ++a) {
      const nlohmann::json& value = element(node["translation"], a);
      if (!value.is_number()) fail("the translation of its surface is not three numbers; get the file anew");
      origin[static_cast<Eigen::Index>(a)] = value.get<double>();
    }
    return origin;
  }

  /// The accessors and names of those that glTF does not know, in the order in which they were written.
  std::map<std::size_t, std::string> custom_attributes(const nlohmann::json& attributes) const {
    std::map<std::size_t, std::string> found;
    for (const auto& [name, accessor] : attributes.items()) {
      if (name.starts_with("_") && name.size() > 1) found.emplace(index_of(accessor), name);
    }
    return found;
  }

  /// Its accessor tells its own name; `name` has capitals and no blanks.
  MeshAttribute attribute(const std::string& name, std::size_t accessor) {
    const nlohmann::json& described = element("accessors", accessor);
    const std::vector<double> values = numbers<float>(accessor, 1, "SCALAR");
    const auto own = described.find("name");
    return {own != described.end() && own->is_string() ? one_line(own->get<std::string>())
                                                       : lower(one_line(name.substr(1))),
            values, described.contains("extras")};
  }

  void add_colors(std::size_t accessor, std::vector<MeshAttribute>& attributes) {
    const std::size_t channels = member(element("accessors", accessor), "name") == kGlbColorAndAlpha ? 4 : 3;
    const std::vector<double> stored = numbers<std::uint16_t>(accessor, 4, "VEC4");
    for (std::size_t c = 0; c < channels; ++c) {
      MeshAttribute& channel = attributes.emplace_back(MeshAttribute{kGlbColorChannels[c], {}, true});
      channel.values.reserve(stored.size() / 4);
      for (std::size_t i = c; i < stored.size(); i += 4) channel.values.push_back(color_of_glb(stored[i], c));
    }
  }

  /// Of all primitives, which are patches under the names of their materials if there are several.
  void read_faces(const nlohmann::json& primitives, std::size_t positions, LoadedSurface& surface) {
    for (const MeshAttribute& attribute : surface.attributes.vertex) {
      if (attribute.values.size() != surface.mesh.vertices.size())
        fail("the attribute " + cite(attribute.name) + " has not one number for every vertex");
    }
    FaceCollector faces(surface, source_);
    FaceGroups groups;
    std::size_t number = 0;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const nlohmann::json& primitive = element(primitives, p);
      if (index_in(member(primitive, "attributes"), "POSITION") != positions)
        fail("its primitives have not the same vertices; get the file anew");
      if (primitives.size() > 1) groups.begin(name_of_material(primitive));
      const std::vector<double> corners = numbers<std::uint32_t>(index_in(primitive, "indices"), 1, "SCALAR");
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        faces.add({static_cast<std::int64_t>(corners[i]), static_cast<std::int64_t>(corners[i + 1]),
                   static_cast<std::int64_t>(corners[i + 2])},
                  "face " + std::to_string(number++));
        groups.add_face();
      }
    }
    faces.finish();
    groups.finish(surface, faces.face_of_triangle());
  }

  std::string name_of_material(const nlohmann::json& primitive) const {
    const nlohmann::json& name = member(element("materials", index_in(primitive, "material")), "name");
    if (!name.is_string()) fail("the name of a material is none; get the file anew");
    return one_line(name.get<std::string>());
  }

  const nlohmann::json& document_;
  std::string_view bytes_;
  const std::string& source_;
  std::size_t bytes_left_;  ///< that no accessor has taken
};

/// The JSON of a GLB file that vmesh wrote, and its bytes; nullopt for any other, and for compressed ones.
std::optional<std::pair<nlohmann::json, std::string_view>> own_glb(std::string_view content) {
  constexpr std::size_t kHead = 12;
  std::size_t at = kHead;
  if (!content.starts_with("glTF")) return std::nullopt;
  const auto text = take_chunk(content, at, "JSON");
  const auto bytes = take_chunk(content, at, std::string_view("BIN\0", 4));
  if (!text || !bytes) return std::nullopt;
  nlohmann::json document = nlohmann::json::parse(*text, nullptr, false);
  const nlohmann::json* at_key = &document;  // discarded if it is no JSON
  for (const char* key : {"asset", "extras", "frame"}) {
    const auto found = at_key->is_object() ? at_key->find(key) : at_key->end();
    if (!at_key->is_object() || found == at_key->end()) return std::nullopt;
    at_key = &*found;
  }
  if (*at_key != kGlbFrame || document.contains("extensionsRequired")) return std::nullopt;
  return std::pair(std::move(document), *bytes);
}

}  // namespace

LoadedSurface parse_glb(std::string_view content, const std::string& source) {
  const auto own = own_glb(content);
  if (!own) throw Unsupported(source + ": this is a scene by another program, which is read by its name only");
  return GlbReader(own->first, own->second, source).run();
}

LoadedSurface read_glb(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  if (const auto own = own_glb(content)) return GlbReader(own->first, own->second, path.string()).run();
#if VMESH_IO_WITH_ASSIMP
  return read_scene(path);
#else
  refuse_without({"assimp", ".ply, .obj, .off or .stl"}, path);
#endif
}

}  // namespace vmesh::io
