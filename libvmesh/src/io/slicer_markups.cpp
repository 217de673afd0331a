#include "slicer_markups.h"

#include "radius_array.h"
#include "text.h"

namespace vmesh::io {
namespace {

using Json = nlohmann::json;

/// A measurement of every control point.
struct PointMeasurement {
  const Json& values;
  RadiusArray array;
  double units = 1;  ///< of the coordinates, in one of the radii
};

/// The member as text, or empty.
std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

class MarkupsReader {
 public:
  MarkupsReader(const std::string& source, const CenterlineReadOptions& options) : options_(options) {
    raw_.source = source;
    raw_.node_word = "control point";
    raw_.segment_word = "curve";
    raw_.loose_branches = true;
  }

  RawCenterline run(const Json& document) {
    const Json& markups = document["markups"];
    if (!markups.is_array()) fail("\"markups\" must be an array");
    std::size_t others = 0;
    for (std::size_t m = 0; m < markups.size(); ++m) {
      const Json& markup = markups[m];
      if (!markup.is_object()) fail(name(m) + ": it must be an object");
      const std::string type = lower(text_of(markup, "type"));
      if (type == "curve" || type == "line") {
        read_curve(markup, m);
      } else {
        ++others;
      }
    }
    if (raw_.segments.empty()) fail("it contains no curve of two control points or more; vessels are curves");
    if (others > 0) warn(std::to_string(others) + " markups are not curves; left out");
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(raw_.source + ": " + what); }
  void warn(const std::string& what) { raw_.warnings.push_back(raw_.source + ": " + what); }
  static std::string name(std::size_t markup) { return "markups[" + std::to_string(markup) + "]"; }

  void read_curve(const Json& curve, std::size_t m) {
    read_frame(curve, m);
    const auto points = curve.find("controlPoints");
    if (points == curve.end() || !points->is_array()) fail(name(m) + ": \"controlPoints\" must be an array");
    const auto radii = radii_of(curve, m, points->size());
    const auto first_segment = static_cast<Index>(raw_.segments.size());
    Index before = kNone;
    for (std::size_t p = 0; p < points->size(); ++p) {
      const Json& point = (*points)[p];
      const std::string place = name(m) + ".controlPoints[" + std::to_string(p) + "]";
      if (!point.is_object()) fail(place + ": it must be an object");
      const std::string status = lower(text_of(point, "positionStatus"));
      if (status == "undefined" || status == "preview") continue;
      raw_.nodes.push_back({position(point, place), radii ? radius(*radii, p, place) : 0});
      raw_.node_numbers.push_back(p);
      const auto node = static_cast<Index>(raw_.nodes.size() - 1);
      if (before != kNone) {
        raw_.segments.push_back({before, node});
        raw_.segment_numbers.push_back(m);
      }
      before = node;
    }
    if (raw_.segments.size() > first_segment) raw_.path_starts.push_back(first_segment);
  }

  /// Frame and unit; all curves must agree.
  void read_frame(const Json& curve, std::size_t m) {
    const std::string written_space = text_of(curve, "coordinateSystem");
    Space space = Space::lps;  // Slicer's default
    if (written_space == "1") space = Space::ras;
    if (!written_space.empty() && written_space != "0" && written_space != "1") {
      const auto known = parse_space(written_space);
      if (!known) fail(name(m) + ": the coordinateSystem " + cite(written_space) + " is not known; use LPS or RAS");
      space = *known;
    }
    std::string written_unit = text_of(curve, "coordinateUnits");
    if (const auto units = curve.find("coordinateUnits"); units != curve.end() && units->is_array() && !units->empty())
      written_unit = units->front().is_string() ? units->front().get<std::string>() : "";
    const LengthUnit unit = written_unit.empty() ? LengthUnit::mm : known_unit(written_unit, name(m));
    if (!raw_.nodes.empty() && (raw_.space != space || raw_.unit != unit))
      fail(name(m) + ": its frame or unit is not that of the curves before; save them in one");
    raw_.space = space;
    raw_.unit = unit;
  }

  LengthUnit known_unit(const std::string& written, const std::string& place) const {
    const auto known = parse_length_unit(written);
    if (!known || *known == LengthUnit::unknown)
      fail(place + ": the unit " + cite(written) + " is not known; use nm, um, mm, cm or m");
    return *known;
  }

  /// The measurement of radii; nullopt when there is none and none is needed.
  std::optional<PointMeasurement> radii_of(const Json& curve, std::size_t m, std::size_t count) {
    const std::string wanted = lower(options_.radius_array.empty() ? "radius" : options_.radius_array);
    const auto measurements = curve.find("measurements");
    if (measurements != curve.end() && measurements->is_array()) {
      for (const Json& measurement : *measurements) {
        if (!measurement.is_object() || lower(text_of(measurement, "name")) != wanted) continue;
        const auto values = measurement.find("controlPointValues");
        if (values == measurement.end() || !values->is_array() || values->size() != count)
          fail(name(m) + ": the measurement " + cite(wanted) + " must have controlPointValues, one for every point");
        PointMeasurement found{*values, RadiusArray(text_of(measurement, "name"))};
        std::string unit = text_of(measurement, "units");
        for (const std::string_view square : {"\xC2\xB2", "2", "^"}) {  // of areas: mm2, mm^2
          if (unit.ends_with(square)) unit.resize(unit.size() - square.size());
        }
        if (!unit.empty())
          found.units =
              millimetres_per(known_unit(unit, name(m) + ", measurement " + cite(wanted))) / millimetres_per(raw_.unit);
        if (raw_.radius_arrays.empty()) found.array.note(raw_);
        return found;
      }
    }
    if (options_.radius) return std::nullopt;
    fail(name(m) + ": there is no measurement " + cite(wanted) +
         " of its control points; give all of them one with --radius, or save the curves of Extract Centerline");
  }

  Vec3 position(const Json& point, const std::string& place) const {
    const auto found = point.find("position");
    if (found == point.end() || !found->is_array() || found->size() != 3)
      fail(place + ": \"position\" must be [x, y, z]");
    Vec3 result;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(*found)[a].is_number()) fail(place + ": \"position\" must be three numbers");
      result[static_cast<Eigen::Index>(a)] = (*found)[a].get<double>();
    }
    return result;
  }

  double radius(const PointMeasurement& radii, std::size_t point, const std::string& place) const {
    const Json& value = radii.values[point];
    if (!value.is_number()) fail(place + ": its radius is not a number");
    return radii.units * radii.array.radius(value.get<double>());
  }

  const CenterlineReadOptions& options_;
  RawCenterline raw_;
};

}  // namespace

RawCenterline read_markups(const Json& document, const std::string& source, const CenterlineReadOptions& options) {
  return MarkupsReader(source, options).run(document);
}

}  // namespace vmesh::io
