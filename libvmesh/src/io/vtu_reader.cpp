// VTK's XML files of unstructured grids (VTK File Formats, "XML File Formats"), read as volume meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "vmesh/mesh/volume_faces.h"

#include "formats.h"
#include "text.h"
#include "vtp_arrays.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

/// What is read of vtkCellType.h.
constexpr double kVertex = 1, kPolyVertex = 2, kLine = 3, kPolyLine = 4, kTriangle = 5, kQuad = 9, kTetra = 10,
                 kWedge = 13, kPyramid = 14;

double volume_of(const std::vector<Vec3>& points, const Tetrahedron& t) {
  const Vec3& a = points[t[0]];
  return (points[t[1]] - a).cross(points[t[2]] - a).dot(points[t[3]] - a);
}

/// Its sign is that of a wedge whose base looks to the other triangle.
double volume_of(const std::vector<Vec3>& points, const Wedge& w) {
  const auto [a, b, c, d, e, f] = w;
  return volume_of(points, Tetrahedron{a, b, c, d}) + volume_of(points, Tetrahedron{b, c, d, e}) +
         volume_of(points, Tetrahedron{c, d, e, f});
}

double volume_of(const std::vector<Vec3>& points, const Pyramid& p) {
  const auto [a, b, c, d, e] = p;
  return volume_of(points, Tetrahedron{a, b, c, e}) + volume_of(points, Tetrahedron{a, c, d, e});
}

class VtuReader {
 public:
  VtuReader(std::string_view content, const std::string& source)
      : source_(source), file_(parse_xml(content, source)), arrays_(file_, source) {}

  LoadedVolume run() {
    const pugi::xml_node root = file_.document.child("VTKFile");
    const pugi::xml_node grid = root.child("UnstructuredGrid");
    if (root.attribute("type").value() != std::string_view("UnstructuredGrid") || !grid)
      fail("this is not a VTU file: it has no <UnstructuredGrid>");
    read_field(grid.child("FieldData"));
    const pugi::xml_node piece = grid.child("Piece");
    if (!piece) fail("it contains no <Piece>");
    if (piece.next_sibling("Piece")) fail("it has several pieces; save it as one");
    read_points(piece);
    read_cells(piece);
    turn_cells();
    read_attributes(piece.child("PointData"), volume_.mesh.points.size(), volume_.attributes.point);
    read_cell_data(piece.child("CellData"));
    if (volume_.mesh.boundary.empty()) volume_.mesh.boundary = outside();
    try {
      check_volume_mesh(volume_.mesh);
      sides_of_boundary(volume_.mesh);
    } catch (const InvalidInput& error) {
      fail(error.what());
    }
    return std::move(volume_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(source_ + ": " + what); }

  void read_field(pugi::xml_node field) {
    for (const pugi::xml_node array : field.children()) {
      const std::string_view name = array.attribute("Name").value();
      if (name == "RegionNames") volume_.mesh.region_names = arrays_.texts(array);
      if (name == "PatchNames") volume_.mesh.patch_names = arrays_.texts(array);
      if (name == "SPACE") volume_.space = parse_space(arrays_.text(array)).value_or(Space::unknown);
      if (name == "UNIT") volume_.unit = parse_length_unit(arrays_.text(array)).value_or(LengthUnit::unknown);
    }
  }

  std::uint64_t count_of(pugi::xml_node piece, const char* key) const {
    const auto count = parse_integer(piece.attribute(key).value());
    if (!count || *count < 0 || *count >= kNone)
      fail(std::string(key) + "=" + cite(piece.attribute(key).value()) + " is not a count");
    return static_cast<std::uint64_t>(*count);
  }

  void read_points(pugi::xml_node piece) {
    const std::uint64_t count = count_of(piece, "NumberOfPoints");
    const pugi::xml_node array = piece.child("Points").child("DataArray");
    if (!array || array.attribute("NumberOfComponents").value() != std::string_view("3"))
      fail("points need three coordinates");
    const std::vector<double> x = arrays_.numbers(array, 3 * count);
    for (std::size_t i = 0; i < x.size(); i += 3) volume_.mesh.points.emplace_back(x[i], x[i + 1], x[i + 2]);
    for (std::size_t i = 0; i < volume_.mesh.points.size(); ++i) {
      if (!volume_.mesh.points[i].allFinite()) fail("point " + std::to_string(i) + " is not finite (NaN or infinity)");
    }
  }

  std::vector<double> cell_numbers(pugi::xml_node cells, const char* name, std::uint64_t count) {
    const pugi::xml_node array = cells.find_child_by_attribute("Name", name);
    if (!array) fail(std::string("<Cells> needs an array \"") + name + "\"");
    return arrays_.numbers(array, count);
  }

  void read_cells(pugi::xml_node piece) {
    const std::uint64_t count = count_of(piece, "NumberOfCells");
    const pugi::xml_node cells = piece.child("Cells");
    const std::vector<double> ends = cell_numbers(cells, "offsets", count), types = cell_numbers(cells, "types", count);
    const std::vector<double> ids = cell_numbers(cells, "connectivity", VtpArrays::kAll);
    double begin = 0;
    for (std::size_t c = 0; c < count; ++c) {
      if (!(ends[c] >= begin && ends[c] <= static_cast<double>(ids.size())) || ends[c] != std::floor(ends[c]))
        fail("cell " + std::to_string(c) + ": its offset is out of range");
      read_cell(c, types[c], {ids.data() + static_cast<std::size_t>(begin), static_cast<std::size_t>(ends[c] - begin)});
      begin = ends[c];
    }
    if (volume_.mesh.cell_count() == 0)
      fail("there are no tetrahedra, wedges or pyramids; a surface is read from VTP, PLY, STL or OBJ");
    if (left_out_ > 0)
      volume_.warnings.push_back(source_ + ": " + std::to_string(left_out_) + " lines and loose points are left out");
  }

  template <std::size_t N>
  std::array<Index, N> corners(std::size_t cell, std::span<const double> ids) const {
    if (ids.size() != N)
      fail("cell " + std::to_string(cell) + " has " + std::to_string(ids.size()) + " corners, there should be " +
           std::to_string(N));
    std::array<Index, N> result;
    for (std::size_t i = 0; i < N; ++i) {
      if (!(ids[i] >= 0 && ids[i] < static_cast<double>(volume_.mesh.points.size())) || ids[i] != std::floor(ids[i]))
        fail("cell " + std::to_string(cell) + ": there is no such point; the points are 0 to " +
             std::to_string(static_cast<std::ptrdiff_t>(volume_.mesh.points.size()) - 1));
      result[i] = static_cast<Index>(ids[i]);
    }
    return result;
  }

  void read_cell(std::size_t cell, double type, std::span<const double> ids) {
    VolumeMesh& mesh = volume_.mesh;
    if (type == kTetra) {
      mesh.tetrahedra.push_back(corners<4>(cell, ids));
      tetrahedra_.push_back(cell);
    } else if (type == kWedge) {
      const auto [a, c, b, d, f, e] = corners<6>(cell, ids);  // VTK's base looks outwards
      mesh.wedges.push_back({a, b, c, d, e, f});
      wedges_.push_back(cell);
    } else if (type == kPyramid) {
      mesh.pyramids.push_back(corners<5>(cell, ids));
      pyramids_.push_back(cell);
    } else if (type == kTriangle) {
      const auto [a, b, c] = corners<3>(cell, ids);
      mesh.boundary.push_back({{a, b, c, kNone}, 0});
      faces_.push_back(cell);
    } else if (type == kQuad) {
      mesh.boundary.push_back({corners<4>(cell, ids), 0});
      faces_.push_back(cell);
    } else if (type == kVertex || type == kPolyVertex || type == kLine || type == kPolyLine) {
      ++left_out_;
    } else {
      std::string text;
      append(text, type);
      fail("cell " + std::to_string(cell) + " is of VTK's type " + text +
           "; volume meshes are of tetrahedra (10), wedges (13) and pyramids (14), with triangles and quads outside");
    }
  }

  /// Other programs order the corners of wedges in the other way.
  void turn_cells() {
    std::size_t turned = 0;
    const auto turn = [&](auto& cells, const auto& swap) {
      for (auto& cell : cells) {
        if (volume_of(volume_.mesh.points, cell) >= 0) continue;
        swap(cell);
        ++turned;
      }
    };
    turn(volume_.mesh.tetrahedra, [](Tetrahedron& t) { std::swap(t[0], t[1]); });
    turn(volume_.mesh.wedges, [](Wedge& w) { std::swap(w[1], w[2]), std::swap(w[4], w[5]); });
    turn(volume_.mesh.pyramids, [](Pyramid& p) { std::swap(p[1], p[3]); });
    if (turned > 0)
      volume_.warnings.push_back(source_ + ": " + std::to_string(turned) +
                                 " cells had corners in an order that gives a negative volume; turned");
  }

  void read_attributes(pugi::xml_node data, std::size_t count, std::vector<MeshAttribute>& attributes) {
    for (const pugi::xml_node array : data.children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      const std::string_view type = array.attribute("type").value();
      const std::string_view components = array.attribute("NumberOfComponents").value();
      if (name.empty() || type == "String" || (!components.empty() && components != "1")) continue;
      attributes.push_back({from_vtk(kPointNames, name), arrays_.numbers(array, count), !type.starts_with("Float")});
    }
  }

  void read_cell_data(pugi::xml_node data) {
    std::vector<MeshAttribute> all;
    read_attributes(data, volume_.mesh.cell_count() + faces_.size() + left_out_, all);
    std::vector<std::size_t> cells = tetrahedra_;
    cells.insert(cells.end(), wedges_.begin(), wedges_.end());
    cells.insert(cells.end(), pyramids_.begin(), pyramids_.end());
    std::vector<double> region(cells.size(), 1), patch(faces_.size(), 1);
    for (MeshAttribute& attribute : all) {
      const auto of = [&](const std::vector<std::size_t>& places) {
        std::vector<double> values;
        for (const std::size_t c : places) values.push_back(attribute.values[c]);
        return values;
      };
      if (attribute.name == "ModelRegionID") {
        region = of(cells);
      } else if (attribute.name == "ModelFaceID") {
        patch = of(faces_);
      } else {
        volume_.attributes.cell.push_back({attribute.name, of(cells), attribute.integer});
      }
    }
    volume_.mesh.cell_region = numbered(region, "ModelRegionID", "region_", volume_.mesh.region_names);
    const std::vector<Index> patches = numbered(patch, "ModelFaceID", "patch_", volume_.mesh.patch_names);
    for (std::size_t f = 0; f < faces_.size(); ++f) volume_.mesh.boundary[f].patch = patches[f];
  }

  /// Numbers from 0, of labels that are numbers of `names` from 1, or else any integers, which are then named by them.
  std::vector<Index> numbered(const std::vector<double>& labels, const char* array, const char* word,
                              std::vector<std::string>& names) const {
    std::map<double, Index> number;
    if (names.empty()) {
      for (const double label : labels) number[label] = 0;
      for (auto& [label, i] : number) {
        i = static_cast<Index>(names.size());
        std::string name = word;
        append(name, label);
        names.push_back(name);
      }
    } else {
      for (std::size_t i = 0; i < names.size(); ++i) number[static_cast<double>(i + 1)] = static_cast<Index>(i);
    }
    std::vector<Index> result;
    for (const double label : labels) {
      const auto found = number.find(label);
      std::string text;
      append(text, label);
      if (found == number.end())
        fail(std::string(array) + " " + text + " has no name; there are " + std::to_string(names.size()));
      result.push_back(found->second);
    }
    return result;
  }

  /// Faces of one cell alone, as one patch.
  std::vector<BoundaryFace> outside() {
    std::vector<BoundaryFace> faces;
    for (const CellFace& face : outer_faces(volume_.mesh)) faces.push_back({face, 0});
    volume_.mesh.patch_names = {"wall"};
    return faces;
  }

  const std::string& source_;
  XmlFile file_;
  VtpArrays arrays_;
  LoadedVolume volume_;
  std::vector<std::size_t> tetrahedra_, wedges_, pyramids_, faces_;  ///< their numbers in the file
  std::size_t left_out_ = 0;
};

}  // namespace

LoadedVolume parse_volume_vtu(std::string_view content, const std::string& source) {
  return VtuReader(content, source).run();
}

}  // namespace vmesh::io
