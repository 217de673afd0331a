// Binary glTF 2.0 (Khronos, "glTF 2.0 Specification").
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>

#include <nlohmann/json.hpp>

#include "vmesh/mesh/find_attribute.h"

#include "boundaries.h"
#include "bytes.h"
#include "formats.h"
#include "glb_colors.h"
#include "glb_packing.h"
#include "text.h"

namespace vmesh::io {
namespace {

using OrderedJson = nlohmann::ordered_json;

enum ComponentType { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
enum Target { kVertices = 34962, kIndices = 34963, kNoTarget = 0 };

/// From LPS to y up (superior) and z towards the viewer (anterior).
Vec3 turned(const Vec3& p) { return {p.x(), p.z(), -p.y()}; }
Vec3 metres(const Vec3& p) { return 1e-3 * turned(p); }

/// Red, green, blue and, where there is one, alpha; empty if one of the three is missing.
std::vector<const MeshAttribute*> colors_of(const MeshAttributes& attributes) {
  std::vector<const MeshAttribute*> channels;
  for (const char* name : kGlbColorChannels) {
    if (const MeshAttribute* channel = find_attribute(attributes.vertex, name))
      channels.push_back(channel);
    else if (channels.size() < 3)
      return {};
  }
  return channels;
}

/// "volume distance" -> "_VOLUME_DISTANCE", as the specification requires for custom names.
std::string custom_name(const std::string& name) {
  std::string result = "_";
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    result += letter ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : '_';
  }
  return result;
}

/// A custom name that no other attribute has: "a b" and "a_b" become "_A_B" and "_A_B_2".
std::string unique_name(const std::string& name, const OrderedJson& taken) {
  const std::string custom = custom_name(name);
  std::string result = custom;
  for (int i = 2; taken.contains(result); ++i) result = custom + "_" + std::to_string(i);
  return result;
}

class GlbWriter {
 public:
  GlbWriter(const TriMesh& mesh, const MeshAttributes& attributes, const SurfaceMetadata& metadata,
            const SurfaceWriteOptions& options)
      : mesh_(mesh),
        attributes_(attributes),
        skin_(options.skin),
        packs_(options.encoding == SurfaceEncoding::compressed) {
    json_["asset"] = {{"version", "2.0"}, {"generator", one_line(metadata.generator)}};
    OrderedJson extras = OrderedJson::object();
    for (const auto& [key, value] : {std::pair{"options", &metadata.options},
                                     {"input", &metadata.input_name},
                                     {"inputSHA256", &metadata.input_sha256}}) {
      if (!value->empty()) extras[key] = one_line(*value);
    }
    extras["frame"] = kGlbFrame;
    json_["asset"]["extras"] = std::move(extras);
    if (skin_) return;  // the node of a surface with bones must not be moved
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& p : mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    origin_ = (low + high) / 2;
  }

  void run(std::ostream& out) {
    OrderedJson attributes = OrderedJson::object();
    attributes["POSITION"] = positions();
    attributes["NORMAL"] = normals();
    const std::vector<const MeshAttribute*> channels = colors_of(attributes_);
    if (!channels.empty()) attributes["COLOR_0"] = colors(channels);
    for (const MeshAttribute& a : attributes_.vertex) {
      if (std::ranges::find(channels, &a) == channels.end()) attributes[unique_name(a.name, attributes)] = scalars(a);
    }
    if (skin_) add_weights(attributes);
    add_mesh(attributes);
    add_nodes();
    json_["buffers"].push_back({{"byteLength", 0}});
    if (packs_) pack();
    write(out);
  }

 private:
  std::size_t view(Target target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    OrderedJson& view = json_["bufferViews"].emplace_back();
    view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", 0}};
    if (target != kNoTarget) view["target"] = static_cast<int>(target);
    return json_["bufferViews"].size() - 1;
  }

  /// Adds an accessor for all bytes since the last view(); returns its number. `bits`: to which numbers may be rounded
  /// by compression, see with_exponents(); 0: not at all.
  std::size_t accessor(std::size_t view, ComponentType type, const char* kind, std::size_t count, int bits = 0) {
    OrderedJson& described = json_["bufferViews"][view];
    described["byteLength"] = bytes_.size() - described["byteOffset"].get<std::size_t>();
    contents_.push_back({count, bits, type == kUnsignedInt});
    json_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", static_cast<int>(type)}, {"count", count}, {"type", kind}});
    return json_["accessors"].size() - 1;
  }

  void store_vector(const Vec3& v) {
    for (const double x : v) store(bytes_, static_cast<float>(x));
  }

  std::size_t positions() {
    const std::size_t at = view(kVertices);
    for (const Vec3& vertex : mesh_.vertices) store_vector(metres(vertex - origin_));
    const std::size_t number = accessor(at, kFloat, "VEC3", mesh_.vertices.size(), kPositionBits);
    set_range(json_["accessors"][number], content_of(at));
    return number;
  }

  /// The bytes of a view.
  std::string_view content_of(std::size_t view) const {
    const OrderedJson& described = json_["bufferViews"][view];
    return std::string_view(bytes_).substr(described["byteOffset"], described["byteLength"]);
  }

  /// Least and greatest of the vectors.
  static void set_range(OrderedJson& accessor, std::string_view vectors) {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    std::array<float, 3> low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar};
    for (std::size_t i = 0; i < vectors.size() / sizeof(float); ++i) {
      const float x = load<float>(vectors.data() + i * sizeof(float));
      low[i % 3] = std::min(low[i % 3], x);
      high[i % 3] = std::max(high[i % 3], x);
    }
    accessor["min"] = low;
    accessor["max"] = high;
  }

  std::size_t normals() {
    const std::size_t at = view(kVertices);
    for (const Vec3& n : vertex_normals(mesh_)) store_vector(n.squaredNorm() > 0 ? turned(n) : Vec3(Vec3::UnitY()));
    return accessor(at, kFloat, "VEC3", mesh_.vertices.size(), kNormalBits);
  }

  /// In 16 bits: eight would not tell dark colours apart, as they are linear here.
  std::size_t colors(const std::vector<const MeshAttribute*>& channels) {
    const std::size_t at = view(kVertices);
    std::array<std::uint16_t, 4> color = {0, 0, 0, kGlbColorWhite};
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      for (std::size_t c = 0; c < channels.size(); ++c) color[c] = glb_color(channels[c]->values[v], c);
      for (const std::uint16_t value : color) store(bytes_, value);
    }
    const std::size_t number = accessor(at, kUnsignedShort, "VEC4", mesh_.vertices.size());
    json_["accessors"][number]["normalized"] = true;
    json_["accessors"][number]["name"] = channels.size() == 4 ? kGlbColorAndAlpha : kGlbColor;
    return number;
  }

  std::size_t scalars(const MeshAttribute& attribute) {
    const std::size_t at = view(kVertices);
    for (const double value : attribute.values) store(bytes_, static_cast<float>(std::isfinite(value) ? value : 0));
    const std::size_t number =
        accessor(at, kFloat, "SCALAR", attribute.values.size(), attribute.integer ? 0 : kScalarBits);
    json_["accessors"][number]["name"] = one_line(attribute.name);
    if (attribute.integer) json_["accessors"][number]["extras"] = {{"integer", true}};
    return number;
  }

  std::size_t indices(const std::vector<Index>& faces) {
    const std::size_t at = view(kIndices);
    for (const Index f : faces) {
      for (const Index v : mesh_.faces[f]) store(bytes_, v);
    }
    return accessor(at, kUnsignedInt, "SCALAR", 3 * faces.size());
  }

  /// A primitive and a material for every patch, whose name both have; one of each if there is one patch. All
  /// primitives have all vertices.
  void add_mesh(const OrderedJson& attributes) {
    std::vector<Boundary> boundaries = boundaries_of(mesh_, attributes_);
    if (boundaries.size() == 1) boundaries[0].name = "vessel";
    OrderedJson primitives = OrderedJson::array(), materials = OrderedJson::array();
    for (const Boundary& boundary : boundaries) {
      primitives.push_back(
          {{"attributes", attributes}, {"indices", indices(boundary.faces)}, {"material", materials.size()}});
      if (boundaries.size() > 1) primitives.back()["extras"] = {{"name", boundary.name}};
      materials.push_back({{"name", boundary.name},
                           {"doubleSided", true},
                           {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.6}}}});
    }
    json_["meshes"].push_back({{"name", "surface"}, {"primitives", std::move(primitives)}});
    json_["materials"] = std::move(materials);
  }

  void add_weights(OrderedJson& attributes) {
    const std::size_t joints = view(kVertices);
    for (const auto& of_vertex : skin_->joint_of_vertex) {
      for (const Index joint : of_vertex) store(bytes_, static_cast<std::uint16_t>(joint));
    }
    attributes["JOINTS_0"] = accessor(joints, kUnsignedShort, "VEC4", mesh_.vertices.size());
    const std::size_t weights = view(kVertices);
    for (const auto& of_vertex : skin_->weight) {
      for (const float weight : of_vertex) store(bytes_, weight);
    }
    attributes["WEIGHTS_0"] = accessor(weights, kFloat, "VEC4", mesh_.vertices.size());
  }

  /// Adds the mesh at the root of the scene, and its bones side by side under one node, each with the axes of the scene
  /// at rest.
  void add_nodes() {
    const Vec3 origin = metres(origin_);
    json_["nodes"].push_back({{"name", "surface"}, {"mesh", 0}});
    if (!skin_) {
      json_["nodes"][0]["translation"] = OrderedJson::array({origin.x(), origin.y(), origin.z()});
      json_["scenes"].push_back({{"nodes", OrderedJson::array({0})}});
    } else {
      add_joints();
      json_["scenes"].push_back({{"nodes", OrderedJson::array({0, 1})}});
    }
    json_["scene"] = 0;
  }

  void add_joints() {
    OrderedJson numbers = OrderedJson::array();
    const std::size_t at = view(kNoTarget);
    json_["nodes"][0]["skin"] = 0;
    json_["nodes"].push_back({{"name", "bones"}});
    for (const SurfaceSkin::Joint& joint : skin_->joints) {
      const Vec3 p = metres(joint.position);
      numbers.push_back(json_["nodes"].size());
      json_["nodes"].push_back({{"name", joint.name}, {"translation", OrderedJson::array({p.x(), p.y(), p.z()})}});
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row)
          store(bytes_, static_cast<float>(row == column ? 1 : column == 3 ? -p[row] : 0));
      }
    }
    json_["nodes"][1]["children"] = numbers;
    json_["skins"].push_back({{"inverseBindMatrices", accessor(at, kFloat, "MAT4", skin_->joints.size())},
                              {"skeleton", 1},
                              {"joints", std::move(numbers)}});
  }

  /// Compresses all views. They then are parts of a second buffer, which is not in the file: programs unpack them
  /// there.
  void pack() {
#if VMESH_IO_WITH_MESHOPTIMIZER
    constexpr const char* kName = "EXT_meshopt_compression";
    std::string packed;
    for (std::size_t v = 0; v < contents_.size(); ++v) {
      const auto [count, bits, is_indices] = contents_[v];
      const std::string_view content = content_of(v);
      const std::size_t stride = content.size() / count;
      std::string bytes;
      if (is_indices) {
        bytes = packed_triangles(content, mesh_.vertices.size());
      } else if (bits > 0) {
        const std::string rounded = with_exponents(content, stride, bits);
        if (json_["accessors"][v].contains("min")) set_range(json_["accessors"][v], without_exponents(rounded, stride));
        bytes = packed_values(rounded, stride);
      } else {
        bytes = packed_values(content, stride);
      }
      packed.resize((packed.size() + 3) / 4 * 4, '\0');
      OrderedJson extension = {{"buffer", 0},
                               {"byteOffset", packed.size()},
                               {"byteLength", bytes.size()},
                               {"byteStride", stride},
                               {"count", count},
                               {"mode", is_indices ? "TRIANGLES" : "ATTRIBUTES"}};
      if (bits > 0) extension["filter"] = "EXPONENTIAL";
      json_["bufferViews"][v]["buffer"] = 1;
      json_["bufferViews"][v]["extensions"][kName] = std::move(extension);
      packed += bytes;
    }
    json_["buffers"].push_back({{"byteLength", bytes_.size()}, {"extensions", {{kName, {{"fallback", true}}}}}});
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) json_[list].push_back(kName);
    bytes_ = std::move(packed);
#endif
  }

  void write(std::ostream& out) {
    constexpr std::size_t kLargest = std::numeric_limits<std::uint32_t>::max();
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    json_["buffers"][0]["byteLength"] = bytes_.size();
    std::string text = json_.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t size = 12 + 8 + text.size() + 8 + bytes_.size();
    if (size > kLargest) throw Unsupported("the surface is too large for a GLB file (4 GB); write it as .ply");
    std::string head = "glTF";
    for (const std::size_t word : {std::size_t{2}, size, text.size()}) store(head, static_cast<std::uint32_t>(word));
    out << head << "JSON" << text;
    head.clear();
    store(head, static_cast<std::uint32_t>(bytes_.size()));
    head.append("BIN\0", 4);
    out << head;
    out.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
  }

  const TriMesh& mesh_;
  const MeshAttributes& attributes_;
  // Two millionths of a position's greatest coordinate, a 4,000th of a normal, 31 millionths of an attribute.
  static constexpr int kPositionBits = 20, kNormalBits = 12, kScalarBits = 16;

  /// What is in a view, for pack(). Accessors have the numbers of their views.
  struct Content {
    std::size_t count;
    int bits;
    bool is_indices;
  };

  const SurfaceSkin* skin_;
  bool packs_;
  Vec3 origin_ = Vec3::Zero();  ///< at the centre, for precision
  std::vector<Content> contents_;
  OrderedJson json_;
  std::string bytes_;
};

}  // namespace

void write_glb(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata, const SurfaceWriteOptions& options) {
  if (mesh.vertices.empty() || mesh.faces.empty())
    throw InvalidInput("a surface without faces cannot be written as GLB");
  GlbWriter(mesh, attributes, metadata, options).run(out);
}

}  // namespace vmesh::io
