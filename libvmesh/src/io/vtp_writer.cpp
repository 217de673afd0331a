// VTK's XML files of polygonal data (VTK File Formats, "XML File Formats"), written: arrays appended, packed by zlib.
#include <ostream>

#include <zlib.h>

#include "vmesh/core/text.h"

#include "bytes.h"
#include "end_section_arrays.h"
#include "formats.h"
#include "text.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;  // bytes that are packed together

/// One array as it follows the XML: the number of blocks, their size, that of the last if it is smaller, the sizes of
/// the packed blocks (all as 64-bit integers), and these.
class PackedArray {
 public:
  template <class T>
  void add(T value) {
    store(block_, value);
    if (block_.size() == kBlock) pack();
  }

  std::string bytes() {
    const std::size_t rest = block_.size();
    if (rest > 0) pack();
    std::string result;
    store(result, static_cast<std::uint64_t>(sizes_.size()));
    store(result, static_cast<std::uint64_t>(kBlock));
    store(result, static_cast<std::uint64_t>(rest));
    for (const std::uint64_t size : sizes_) store(result, size);
    return result + packed_;
  }

 private:
  void pack() {
    uLongf size = compressBound(static_cast<uLong>(block_.size()));
    const std::size_t before = packed_.size();
    packed_.resize(before + size);
    if (compress2(reinterpret_cast<Bytef*>(packed_.data() + before), &size,
                  reinterpret_cast<const Bytef*>(block_.data()), static_cast<uLong>(block_.size()),
                  Z_DEFAULT_COMPRESSION) != Z_OK)
      throw WriteError("zlib cannot pack the data; is there enough free memory?");
    packed_.resize(before + size);
    sizes_.push_back(size);
    block_.clear();
  }

  std::string block_, packed_;
  std::vector<std::uint64_t> sizes_;
};

std::string escaped(std::string_view text) { return xml_escaped(text, "&<>\""); }

/// The XML, in the order in which it is built, and the arrays that follow it.
class VtpFile {
 public:
  void open(const std::string& tag) {
    xml_ += std::string(2 * tags_.size(), ' ') + "<" + tag + ">\n", tags_.push_back(tag);
  }
  void close() {
    const std::string name = tags_.back().substr(0, tags_.back().find(' '));
    tags_.pop_back();
    xml_ += std::string(2 * tags_.size(), ' ') + "</" + name + ">\n";
  }

  /// `values`: called with a function that takes the numbers, which are of type T.
  template <class T, class Values>
  void add_array(const char* type, const std::string& name, int components, std::size_t tuples, Values&& values) {
    PackedArray array;
    values([&](auto value) { array.add(static_cast<T>(value)); });
    xml_ += std::string(2 * tags_.size(), ' ') + "<DataArray type=\"" + type + "\" Name=\"" + escaped(name) + "\"";
    if (components != 1) xml_ += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    if (tags_.back() == "FieldData") xml_ += " NumberOfTuples=\"" + std::to_string(tuples) + "\"";
    xml_ += " format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += array.bytes();
  }

  void add_numbers(const std::string& name, const std::vector<double>& values, bool integer, int components = 1) {
    const auto all = [&](const auto& take) {
      for (const double value : values) take(value);
    };
    const std::size_t tuples = values.size() / static_cast<std::size_t>(components);
    if (integer) {
      add_array<std::int32_t>("Int32", name, components, tuples, all);
    } else {
      add_array<double>("Float64", name, components, tuples, all);
    }
  }

  /// Codes of the bytes, and a zero.
  void add_text(const char* name, const std::string& text) {
    if (text.empty()) return;
    const std::string indent(2 * tags_.size(), ' ');
    xml_ += indent + "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">\n" + indent;
    for (const char c : one_line(text)) xml_ += std::to_string(static_cast<unsigned char>(c)) + " ";
    xml_ += "0\n" + indent + "</Array>\n";
  }

  /// `element`: Verts, Lines or Polys. `corners`: called with a function that takes the numbers of points,
  /// `to_a_cell` for each cell.
  template <class Corners>
  void add_cells(const char* element, std::size_t cells, std::size_t to_a_cell, Corners&& corners) {
    open(element);
    add_array<std::int64_t>("Int64", "connectivity", 1, cells, corners);
    add_array<std::int64_t>("Int64", "offsets", 1, cells, [&](const auto& take) {
      for (std::size_t c = 1; c <= cells; ++c) take(c * to_a_cell);
    });
    close();
  }

  template <class Position>
  void add_points(std::size_t count, const Position& position) {
    open("Points");
    add_array<double>("Float64", "Points", 3, count, [&](const auto& take) {
      for (std::size_t i = 0; i < count; ++i)
        for (const double x : position(i)) take(x);
    });
    close();
  }

  void write(std::ostream& out) const {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
        << xml_ << "<AppendedData encoding=\"raw\">\n_" << appended_ << "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::vector<std::string> tags_;  // open
  std::string xml_, appended_;
};

template <class Metadata>
void add_metadata(VtpFile& file, const Metadata& metadata) {
  file.add_text("SPACE", std::string(to_string(metadata.space)));
  file.add_text("UNIT", std::string(to_string(metadata.unit)));
  file.add_text("Generator", metadata.generator);
  file.add_text("Options", metadata.options);
  file.add_text("Input", metadata.input_name);
  file.add_text("InputSHA256", metadata.input_sha256);
}

std::string piece(std::size_t points, std::size_t verts, std::size_t lines, std::size_t polys) {
  return "Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" + std::to_string(verts) +
         "\" NumberOfLines=\"" + std::to_string(lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(polys) + "\"";
}

/// The attribute by which a viewer colours initially.
std::string scalars(const std::vector<MeshAttribute>& attributes, const auto& names) {
  return attributes.empty() ? "" : " Scalars=\"" + escaped(to_vtk(names, attributes.front().name)) + "\"";
}

}  // namespace

void write_centerline_vtp(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                          const std::vector<EndSection>& sections) {
  const auto& nodes = centerline.nodes();
  std::vector<Index> isolated;
  for (Index n = 0; n < nodes.size(); ++n)
    if (centerline.degree(n) == 0) isolated.push_back(n);
  VtpFile file;
  file.open("PolyData");
  file.open("FieldData");
  for (const FieldArray& array : end_section_arrays(sections))
    file.add_numbers(array.name, array.values, array.integer, array.components);
  add_metadata(file, metadata);
  file.close();
  file.open(piece(nodes.size(), isolated.size(), centerline.segments().size(), 0));
  file.open("PointData");
  std::vector<double> radius;
  for (const CenterlineNode& node : nodes) radius.push_back(node.radius);
  file.add_numbers("MaximumInscribedSphereRadius", radius, false);
  file.close();
  file.open("CellData");
  if (!metadata.segment_labels.empty()) {
    std::vector<double> labels(isolated.size(), -1);  // cells before the lines
    labels.insert(labels.end(), metadata.segment_labels.begin(), metadata.segment_labels.end());
    file.add_numbers("Label", labels, false);
  }
  file.close();
  file.add_points(nodes.size(), [&](std::size_t i) -> const Vec3& { return nodes[i].position; });
  file.add_cells("Verts", isolated.size(), 1, [&](const auto& take) {
    for (const Index n : isolated) take(n);
  });
  file.add_cells("Lines", centerline.segments().size(), 2, [&](const auto& take) {
    for (const auto& [a, b] : centerline.segments()) take(a), take(b);
  });
  file.close();
  file.close();
  file.write(out);
}

void write_surface_vtp(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                       const SurfaceMetadata& metadata, const SurfaceWriteOptions&) {
  VtpFile file;
  file.open("PolyData");
  file.open("FieldData");
  add_metadata(file, metadata);
  file.close();
  file.open(piece(mesh.vertices.size(), 0, 0, mesh.faces.size()));
  file.open("PointData" + scalars(attributes.vertex, kPointNames) + " Normals=\"Normals\"");
  file.add_array<float>("Float32", "Normals", 3, mesh.vertices.size(), [&](const auto& take) {
    for (const Vec3& normal : vertex_normals(mesh))
      for (const double x : normal) take(x);
  });
  for (const MeshAttribute& a : attributes.vertex) file.add_numbers(to_vtk(kPointNames, a.name), a.values, a.integer);
  file.close();
  file.open("CellData" + scalars(attributes.face, kCellNames));
  for (const MeshAttribute& a : attributes.face) file.add_numbers(to_vtk(kCellNames, a.name), a.values, a.integer);
  file.close();
  file.add_points(mesh.vertices.size(), [&](std::size_t i) -> const Vec3& { return mesh.vertices[i]; });
  file.add_cells("Polys", mesh.faces.size(), 3, [&](const auto& take) {
    for (const Triangle& face : mesh.faces)
      for (const Index v : face) take(v);
  });
  file.close();
  file.close();
  file.write(out);
}

}  // namespace vmesh::io
