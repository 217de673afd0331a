#include "poly_lines.h"

#include <algorithm>

#include "vmesh/core/error.h"

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
      throw InvalidInput(raw_.source + ": there is no line in it; a centerline is made of lines or polylines");
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

}  // namespace

RawCenterline to_raw_centerline(const PolyLines& data, const std::string& source) {
  return Converter(data, source).run();
}

std::vector<std::string> radius_names(const std::string& wanted) {
  if (!wanted.empty()) return {wanted};
  return {"MaximumInscribedSphereRadius", "Radius", "radius"};
}

void fail_without_radius(const std::string& source, const std::string& wanted,
                         const std::vector<std::string>& present) {
  constexpr std::size_t kMostNamed = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(present.size(), kMostNamed); ++i) {
    names += (names.empty() ? "" : ", ") + one_line(present[i].substr(0, 40));
  }
  if (present.size() > kMostNamed) names += " and " + std::to_string(present.size() - kMostNamed) + " more";
  throw InvalidInput(source + ": there is no point array " +
                     (wanted.empty() ? "MaximumInscribedSphereRadius, Radius or radius" : wanted) + "; it has " +
                     (names.empty() ? "none" : names) + "; name the one that holds the radius");
}

}  // namespace vmesh::io
