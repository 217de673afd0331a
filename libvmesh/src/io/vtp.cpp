// VTK's XML files of polygonal data and of unstructured grids (VTK File Formats, "XML File Formats"), read.
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>

#include "end_section_arrays.h"
#include "formats.h"
#include "poly_lines.h"
#include "text.h"
#include "triangulation.h"
#include "vtp_arrays.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

/// Numbers of one kind for every point or cell.
struct VtpArray {
  std::string name;
  bool integer = false;
  std::vector<double> values;  ///< empty when there is more than one number each
};

struct VtpArrayList {
  std::vector<VtpArray> arrays;
  std::unordered_map<std::string, std::size_t> index;  ///< by name

  /// The array of this name, or null.
  const VtpArray* find(const std::string& name) const {
    const auto place = index.find(name);
    return place == index.end() ? nullptr : &arrays[place->second];
  }
  /// The array of this name; added if it is new.
  VtpArray& get(const std::string& name, bool integer) {
    const auto [place, is_new] = index.try_emplace(name, arrays.size());
    if (is_new) arrays.push_back({name, integer, {}});
    return arrays[place->second];
  }
};

/// Cells of one kind: cell c has the points ids[offsets[c]] to ids[offsets[c + 1] - 1].
struct VtpCells {
  std::vector<std::size_t> offsets = {0};
  std::vector<Index> ids;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const Index> operator[](std::size_t c) const {
    return {ids.data() + offsets[c], ids.data() + offsets[c + 1]};
  }
  std::vector<std::vector<Index>> lists() const {
    std::vector<std::vector<Index>> result(size());
    for (std::size_t c = 0; c < size(); ++c) result[c].assign((*this)[c].begin(), (*this)[c].end());
    return result;
  }
  void add(std::span<const Index> points) {
    ids.insert(ids.end(), points.begin(), points.end());
    offsets.push_back(ids.size());
  }
};

struct VtpData {
  std::vector<Vec3> points;
  VtpArrayList point_arrays, cell_arrays;  ///< one number per point, or cell; those of vertices come first,
                                           ///< then of lines, polygons, strips
  ScalarArrays field_arrays;               ///< of flat ends
  VtpCells vertices, lines, polygons, strips;
  std::vector<std::string> patch_names;
  LengthUnit unit = LengthUnit::unknown;
  Space space = Space::unknown;

  std::size_t cell_count() const { return vertices.size() + lines.size() + polygons.size() + strips.size(); }
};

enum class VtkXmlKind { poly_data, unstructured_grid };

class VtpReader {
 public:
  VtpReader(std::string_view content, const std::string& source, VtkXmlKind kind = VtkXmlKind::poly_data)
      : source_(source),
        is_grid_(kind == VtkXmlKind::unstructured_grid),
        file_(parse_xml(content, source)),
        arrays_(file_, source) {}

  VtpData run() {
    const pugi::xml_node root = file_.document.child("VTKFile");
    const std::string type = is_grid_ ? "UnstructuredGrid" : "PolyData";
    if (root.attribute("type").value() != type) {
      throw InvalidInput(source_ + ": this is not a " + (is_grid_ ? "VTU" : "VTP") +
                         " file: it is not a <VTKFile type=\"" + type + "\">");
    }
    const pugi::xml_node data = root.child(type.c_str());
    if (!data) throw InvalidInput(source_ + ": it contains no <" + type + ">");
    read_field(data.child("FieldData"));
    for (const pugi::xml_node piece : data.children("Piece")) read_piece(piece);
    if (data_.points.empty()) throw InvalidInput(source_ + ": it contains no point");
    if (is_grid_) sort_cell_arrays();
    return std::move(data_);
  }

 private:
  void read_field(pugi::xml_node field) {
    for (const pugi::xml_node array : field.children()) {
      const std::string name = array.attribute("Name").value();
      if (is_end_section_array(name)) data_.field_arrays[name] = arrays_.numbers(array, VtpArrays::kAll);
      if (name == "PatchNames") data_.patch_names = arrays_.texts(array);
      if (name != "SPACE" && name != "UNIT") continue;
      const std::string text = arrays_.text(array);
      if (name == "SPACE") data_.space = parse_space(text).value_or(data_.space);
      if (name == "UNIT") data_.unit = parse_length_unit(text).value_or(data_.unit);
    }
  }

  void read_piece(pugi::xml_node piece) {
    const std::size_t first_point = data_.points.size();
    const std::uint64_t count = count_of(piece, "NumberOfPoints");
    if (count >= kNone - first_point) throw InvalidInput(source_ + ": too many points: " + std::to_string(count));
    read_points(piece, count);
    if (is_grid_) read_grid_cells(piece, first_point);
    read_cells(piece, "Verts", count_of(piece, "NumberOfVerts"), first_point, data_.vertices);
    read_cells(piece, "Lines", count_of(piece, "NumberOfLines"), first_point, data_.lines);
    read_cells(piece, "Polys", count_of(piece, "NumberOfPolys"), first_point, data_.polygons);
    read_cells(piece, "Strips", count_of(piece, "NumberOfStrips"), first_point, data_.strips);
    read_arrays(piece, "PointData", first_point, data_.points.size() - first_point, data_.point_arrays);
    // With several pieces, cells of one kind are not contiguous in the file: their data are left out.
    if (first_point == 0) read_arrays(piece, "CellData", 0, data_.cell_count(), data_.cell_arrays);
  }

  std::uint64_t count_of(pugi::xml_node piece, const char* key) const {
    const std::string_view text = piece.attribute(key).value();
    if (text.empty()) return 0;
    const auto count = parse_integer(text);
    if (count && *count >= 0) return static_cast<std::uint64_t>(*count);
    throw InvalidInput(source_ + ": " + key + "=" + cite(text) + " is not a count");
  }

  void read_points(pugi::xml_node piece, std::uint64_t count) {
    if (count == 0) return;
    const pugi::xml_node array = piece.child("Points").child("DataArray");
    if (!array) throw InvalidInput(source_ + ": there are no coordinates for its " + std::to_string(count) + " points");
    if (array.attribute("NumberOfComponents").value() != std::string_view("3")) {
      throw InvalidInput(source_ + ": points need three coordinates");
    }
    const std::vector<double> x = arrays_.numbers(array, 3 * count);
    for (std::size_t i = 0; i < x.size(); i += 3) data_.points.emplace_back(x[i], x[i + 1], x[i + 2]);
  }

  void read_cells(pugi::xml_node piece, const char* kind, std::uint64_t count, std::size_t first_point,
                  VtpCells& cells) {
    if (count == 0) return;
    const pugi::xml_node parent = piece.child(kind);
    const pugi::xml_node offsets = parent.find_child_by_attribute("Name", "offsets");
    const pugi::xml_node ids = parent.find_child_by_attribute("Name", "connectivity");
    if (!offsets || !ids) {
      throw InvalidInput(source_ + ": <" + kind + "> needs arrays \"connectivity\" and \"offsets\" for its " +
                         std::to_string(count) + " cells");
    }
    const std::vector<double> ends = arrays_.numbers(offsets, count);
    const std::vector<double> points = arrays_.numbers(ids, VtpArrays::kAll);
    const std::size_t first_id = cells.ids.size();
    double before = 0;
    for (std::size_t c = 0; c < ends.size(); ++c) {
      const double end = ends[c];
      if (!(end >= before && end <= static_cast<double>(points.size())) || end != std::floor(end)) {
        throw InvalidInput(source_ + ": cell " + std::to_string(c) + " of <" + kind + ">: its offset is out of range");
      }
      cells.offsets.push_back(first_id + static_cast<std::size_t>(end));
      before = end;
    }
    const std::size_t point_count = data_.points.size() - first_point;
    for (std::size_t i = 0; i < static_cast<std::size_t>(before); ++i) {
      if (!(points[i] >= 0 && points[i] < static_cast<double>(point_count))) fail_point(points[i], kind, point_count);
      cells.ids.push_back(static_cast<Index>(first_point + static_cast<std::size_t>(points[i])));
    }
  }

  /// Cells of all kinds, in any order.
  void read_grid_cells(pugi::xml_node piece, std::size_t first_point) {
    const std::uint64_t count = count_of(piece, "NumberOfCells");
    if (count == 0) return;
    VtpCells cells;
    read_cells(piece, "Cells", count, first_point, cells);
    const pugi::xml_node array = piece.child("Cells").find_child_by_attribute("Name", "types");
    if (!array) throw InvalidInput(source_ + ": <Cells> needs an array \"types\" for its cells");
    const std::vector<double> types = arrays_.numbers(array, count);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::size_t group = group_of(types[c]);
      cells_of_group_[group].push_back(grid_cells_++);
      VtpCells* const groups[] = {&data_.vertices, &data_.lines, &data_.polygons};
      groups[group]->add(cells[c]);
    }
  }

  /// Of VTK's types of cells: 0 for vertices, 1 for lines, 2 for the rest.
  static std::size_t group_of(double type) {
    if (type == 1 || type == 2) return 0;
    return type == 3 || type == 4 ? 1 : 2;
  }

  /// Puts the numbers of cells in the order of VtpData.
  void sort_cell_arrays() {
    for (VtpArray& array : data_.cell_arrays.arrays) {
      if (array.values.size() != grid_cells_) continue;
      std::vector<double> sorted;
      sorted.reserve(grid_cells_);
      for (const auto& group : cells_of_group_) {
        for (const std::size_t c : group) sorted.push_back(array.values[c]);
      }
      array.values = std::move(sorted);
    }
  }

  [[noreturn]] void fail_point(double id, const char* kind, std::size_t count) const {
    std::string text;
    append(text, id);
    throw InvalidInput(source_ + ": <" + kind + ">: there is no point " + text + "; the points are 0 to " +
                       std::to_string(static_cast<std::ptrdiff_t>(count) - 1));
  }

  /// Appends the piece's numbers, `count` each, to those of the points or cells `before` it. If an earlier piece lacked
  /// the array, it stays too short.
  void read_arrays(pugi::xml_node piece, const char* kind, std::size_t before, std::size_t count,
                   VtpArrayList& arrays) {
    for (const pugi::xml_node array : piece.child(kind).children("DataArray")) {
      const std::string name = array.attribute("Name").value();
      const std::string_view type = array.attribute("type").value();
      const std::string_view components = array.attribute("NumberOfComponents").value();
      if (name.empty() || type == "String") continue;
      VtpArray& target = arrays.get(name, !type.starts_with("Float"));
      if (target.values.size() != before || (!components.empty() && components != "1")) continue;
      const std::vector<double> values = arrays_.numbers(array, count);
      target.values.insert(target.values.end(), values.begin(), values.end());
    }
  }

  const std::string& source_;
  bool is_grid_;
  XmlFile file_;
  VtpArrays arrays_;
  VtpData data_;
  std::size_t grid_cells_ = 0;
  std::array<std::vector<std::size_t>, 3> cells_of_group_;  ///< of a grid, by their numbers in the file
};

/// Arrays with another number of elements are empty.
ScalarArrays scalars(VtpArrayList& list, std::size_t count) {
  ScalarArrays arrays;
  for (VtpArray& array : list.arrays)
    arrays[array.name] = array.values.size() == count ? std::move(array.values) : std::vector<double>();
  return arrays;
}

/// The numbers of the elements `kept` from arrays of one number per element.
template <class Names>
std::vector<MeshAttribute> attributes_of(const VtpArrayList& list, const Names& names, std::size_t count,
                                         const std::vector<std::size_t>& kept) {
  std::vector<MeshAttribute> result;
  for (const VtpArray& array : list.arrays) {
    if (array.values.size() != count) continue;
    MeshAttribute attribute{from_vtk(names, array.name), {}, array.integer};
    attribute.values.reserve(kept.size());
    for (const std::size_t i : kept) attribute.values.push_back(array.values[i]);
    result.push_back(std::move(attribute));
  }
  return result;
}

RawCenterline centerline_of(VtpData data, const std::string& source, const CenterlineReadOptions& options) {
  PolyLines poly_lines;
  for (const Vec3& point : data.points) poly_lines.points.push_back({point, 0});
  poly_lines.lines = data.lines.lists();
  poly_lines.vertices = data.vertices.lists();
  const std::size_t cells = data.cell_count();
  const ScalarArrays of_points = scalars(data.point_arrays, data.points.size());
  const ScalarArrays of_cells = scalars(data.cell_arrays, cells);
  RawCenterline raw = to_raw_centerline(std::move(poly_lines), source, {of_points, of_cells}, options);
  read_end_sections(data.field_arrays, raw);
  raw.unit = data.unit;
  raw.space = data.space;
  return raw;
}

}  // namespace

RawCenterline parse_centerline_vtp(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options) {
  return centerline_of(VtpReader(content, source).run(), source, options);
}

RawCenterline parse_centerline_vtu(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options) {
  VtpData data = VtpReader(content, source, VtkXmlKind::unstructured_grid).run();
  const std::size_t others = data.polygons.size();
  RawCenterline raw = centerline_of(std::move(data), source, options);
  if (others > 0)
    raw.warnings.push_back(source + ": " + std::to_string(others) + " cells are neither lines nor points; left out");
  return raw;
}

LoadedSurface parse_surface_vtp(std::string_view content, const std::string& source) {
  VtpData data = VtpReader(content, source).run();
  LoadedSurface surface;
  surface.unit = data.unit;
  surface.space = data.space;
  surface.attributes.patch_names = std::move(data.patch_names);
  surface.mesh.vertices = std::move(data.points);
  FaceCollector faces(surface, source);
  const std::vector<std::size_t> cell_of_face =
      faces.add_cells(data.polygons, data.strips, data.vertices.size() + data.lines.size());
  faces.finish();
  std::vector<std::size_t> kept(surface.mesh.vertices.size());
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i;
  surface.attributes.vertex = attributes_of(data.point_arrays, kPointNames, kept.size(), kept);
  kept.clear();
  for (const Index f : faces.face_of_triangle()) kept.push_back(cell_of_face[f]);
  surface.attributes.face = attributes_of(data.cell_arrays, kCellNames, data.cell_count(), kept);
  return surface;
}

}  // namespace vmesh::io
