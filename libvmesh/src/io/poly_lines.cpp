#include "poly_lines.h"

#include <algorithm>

#include "vmesh/core/error.h"

#include "edge_radii.h"
#include "radius_array.h"
#include "text.h"

namespace vmesh::io {
namespace {

class Converter {
 public:
  Converter(const PolyLines& data, const std::string& source) : data_(data), node_of_(data.points.size(), kNone) {
    raw_.source = source;
    raw_.node_word = "point";
    raw_.segment_word = "line cell";
    raw_.loose_branches = true;
  }

  RawCenterline run() {
    std::size_t empty = 0;
    for (std::size_t c = 0; c < data_.lines.size(); ++c) {
      if (data_.lines[c].size() < 2) ++empty;
      // Cells of a vtkPolyData are numbered vertices first, then lines.
      add_line(data_.lines[c], data_.vertices.size() + c);
    }
    for (const auto& cell : data_.vertices) {
      for (const Index point : cell) node(point);
    }
    if (raw_.nodes.empty()) {
      throw InvalidInput(raw_.source + ": it contains no line; a centerline is made of lines or polylines");
    }
    warn(empty, "lines have fewer than two points");
    warn(data_.points.size() - raw_.nodes.size(), "points belong to no line or vertex");
    return std::move(raw_);
  }

 private:
  void warn(std::size_t count, const char* what) {
    if (count > 0) raw_.warnings.push_back(raw_.source + ": " + std::to_string(count) + " " + what + "; left out");
  }

  void add_line(const std::vector<Index>& points, std::uint64_t number) {
    if (points.size() < 2) return;
    raw_.path_starts.push_back(static_cast<Index>(raw_.segments.size()));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const Index a = node(points[i]);
      raw_.segments.push_back({a, node(points[i + 1])});
      raw_.segment_numbers.push_back(number);
    }
  }

  Index node(Index point) {
    if (node_of_[point] == kNone) {
      node_of_[point] = static_cast<Index>(raw_.nodes.size());
      raw_.nodes.push_back(data_.points[point]);
      raw_.node_numbers.push_back(point);
    }
    return node_of_[point];
  }

  const PolyLines& data_;
  RawCenterline raw_;
  std::vector<Index> node_of_;
};

/// The names under which the radius is looked for.
std::vector<std::string> radius_names(const Attributes& attributes, const CenterlineReadOptions& options,
                                      std::vector<std::string> usual) {
  if (!options.radius_array.empty()) return {options.radius_array};
  if (options.radius) return usual;
  std::vector<std::string> present;
  for (const ScalarArrays* arrays : {&attributes.point, &attributes.cell}) {
    for (const auto& [name, values] : *arrays) {
      if (!values.empty()) present.push_back(name);
    }
  }
  if (const auto area = only_area(present)) usual.push_back(*area);
  return usual;
}

void name_arrays(const ScalarArrays& arrays, std::string& names) {
  constexpr std::size_t kMostNamed = 8;
  std::size_t named = 0;
  for (const auto& [name, values] : arrays) {
    if (named++ < kMostNamed) names += (names.empty() ? "" : ", ") + one_line(name.substr(0, 40));
  }
  if (named > kMostNamed) names += " and " + std::to_string(named - kMostNamed) + " more";
}

[[noreturn]] void fail_without_radius(const std::string& source, const std::string& wanted,
                                      const std::vector<std::string>& usual, const Attributes& attributes) {
  std::string of_points, of_cells;
  name_arrays(attributes.point, of_points);
  name_arrays(attributes.cell, of_cells);
  throw InvalidInput(source + ": there is no array " + (wanted.empty() ? listed(usual) : one_line(wanted)) +
                     " of points or lines; it has " + (of_points.empty() ? "none" : of_points) + " of points and " +
                     (of_cells.empty() ? "none" : of_cells) +
                     " of lines; name the one that holds the radius with --radius-array, or give one radius for all "
                     "with --radius");
}

/// The radius array with its name; null if there is none.
const std::pair<const std::string, std::vector<double>>* find_radius(const ScalarArrays& arrays,
                                                                     const std::vector<std::string>& names,
                                                                     std::size_t count, const std::string& source,
                                                                     const char* element) {
  for (const std::string& name : names) {
    const auto found = arrays.find(name);
    if (found == arrays.end()) continue;
    if (found->second.size() == count) return &*found;
    throw InvalidInput(source + ": the " + element + " array " + cite(name) + " must hold one number for every " +
                       element);
  }
  return nullptr;
}

/// Radii of segments from those of their lines.
std::vector<double> radii_of_segments(const RawCenterline& raw, const std::vector<double>& of_cells,
                                      const RadiusArray& array) {
  std::vector<double> radii;
  for (const std::uint64_t cell : raw.segment_numbers) radii.push_back(array.radius(of_cells[cell]));
  return radii;
}

}  // namespace

const std::vector<std::string>& usual_radii() {
  static const std::vector<std::string> names = {"MaximumInscribedSphereRadius", "Radius", "radius"};
  return names;
}

RawCenterline to_raw_centerline(PolyLines data, const std::string& source, const Attributes& attributes,
                                const CenterlineReadOptions& options, const std::vector<std::string>& usual) {
  const std::vector<std::string> names = radius_names(attributes, options, usual);
  if (const auto* radius = find_radius(attributes.point, names, data.points.size(), source, "point")) {
    const RadiusArray array(radius->first);
    for (std::size_t i = 0; i < data.points.size(); ++i) data.points[i].radius = array.radius(radius->second[i]);
    RawCenterline raw = Converter(data, source).run();
    array.note(raw);
    return raw;
  }
  std::size_t cells = 0;
  for (const auto& [name, values] : attributes.cell) cells = std::max(cells, values.size());
  const std::size_t least = data.vertices.size() + data.lines.size();
  if (const auto* radius = find_radius(attributes.cell, names, std::max(cells, least), source, "cell")) {
    const RadiusArray array(radius->first);
    // A vertex is a sphere of its own, a line a vessel of one radius.
    for (std::size_t c = 0; c < data.vertices.size(); ++c) {
      for (const Index point : data.vertices[c]) data.points[point].radius = array.radius(radius->second[c]);
    }
    RawCenterline raw = Converter(data, source).run();
    const std::vector<CenterlineNode> before = raw.nodes;
    set_radii_of_segments(raw, radii_of_segments(raw, radius->second, array));
    for (std::size_t n = 0; n < before.size(); ++n) {
      if (raw.nodes[n].radius == 0) raw.nodes[n].radius = before[n].radius;
    }
    array.note(raw);
    return raw;
  }
  if (!options.radius || !options.radius_array.empty())
    fail_without_radius(source, options.radius_array, usual, attributes);
  return Converter(data, source).run();
}

RawCenterline to_raw_centerline(LoadedSurface points, std::vector<std::vector<Index>> lines, const std::string& source,
                                const CenterlineReadOptions& options) {
  PolyLines data;
  for (const Vec3& p : points.mesh.vertices) data.points.push_back({p, 0});
  data.lines = std::move(lines);
  ScalarArrays of_points;
  for (MeshAttribute& attribute : points.attributes.vertex) of_points[attribute.name] = std::move(attribute.values);
  RawCenterline raw = to_raw_centerline(std::move(data), source, {of_points, {}}, options);
  raw.unit = points.unit;
  raw.space = points.space;
  return raw;
}

}  // namespace vmesh::io
