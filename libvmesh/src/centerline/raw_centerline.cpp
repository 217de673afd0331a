#include "vmesh/centerline/raw_centerline.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"

namespace vmesh {
namespace {

std::string place(const std::string& word, const std::vector<std::uint64_t>& numbers, Index i) {
  const std::uint64_t number = i < numbers.size() ? numbers[i] : i;
  return word + " " + std::to_string(number);
}

template <class Value>
Value choose(Value in_file, std::optional<Value> override_value, Value fallback, const std::string& source,
             const std::string& what, const std::string& option, std::vector<std::string>& warnings) {
  const std::string prefix = source.empty() ? "" : source + ": ";
  if (override_value && *override_value != Value::unknown) {
    if (in_file != Value::unknown && in_file != *override_value) {
      warnings.push_back(prefix + "the file says its " + what + " is " + std::string(to_string(in_file)) +
                         "; taken as " + std::string(to_string(*override_value)) + " as requested");
    }
    return *override_value;
  }
  if (in_file != Value::unknown) return in_file;
  warnings.push_back(prefix + "the file does not say its " + what + "; taken as " + std::string(to_string(fallback)) +
                     " (set it with " + option + ")");
  return fallback;
}

std::string separator(const std::string& source) { return source.empty() ? "" : ": "; }

/// The part that contains element `i`.
const RawCenterline::Part& part_of(const std::vector<RawCenterline::Part>& parts, Index RawCenterline::Part::*first,
                                   Index i) {
  const auto after = std::upper_bound(parts.begin(), parts.end(), i,
                                      [first](Index wanted, const auto& part) { return wanted < part.*first; });
  return after == parts.begin() ? parts.front() : *std::prev(after);
}

template <class Value>
void check_agreement(const std::string& what, const std::string& first, Value firsts, const std::string& other,
                     Value others) {
  if (firsts == others) return;
  throw InvalidInput(other + ": its " + what + " is " + std::string(to_string(others)) + ", that of " + first + " is " +
                     std::string(to_string(firsts)) + "; convert one of them first");
}

void append_numbers(const std::vector<std::uint64_t>& numbers, std::size_t count, std::vector<std::uint64_t>& all) {
  for (std::size_t i = 0; i < count; ++i) all.push_back(i < numbers.size() ? numbers[i] : i);
}

void append(const RawCenterline& file, bool has_paths, RawCenterline& all) {
  const auto first_node = static_cast<Index>(all.nodes.size());
  const auto first_segment = static_cast<Index>(all.segments.size());
  all.parts.push_back({first_node, first_segment, file.source, file.node_word, file.segment_word});
  all.nodes.insert(all.nodes.end(), file.nodes.begin(), file.nodes.end());
  append_numbers(file.node_numbers, file.nodes.size(), all.node_numbers);
  append_numbers(file.segment_numbers, file.segments.size(), all.segment_numbers);
  for (Index s = 0; s < file.segments.size(); ++s) {
    all.segments.push_back({file.segments[s].a + first_node, file.segments[s].b + first_node});
    if (has_paths && file.path_starts.empty()) all.path_starts.push_back(first_segment + s);
  }
  for (const Index s : file.path_starts) all.path_starts.push_back(first_segment + s);
  for (EndSection section : file.end_sections) {
    section.node += first_node;
    all.end_sections.push_back(std::move(section));
  }
  for (const std::string& name : file.radius_arrays) {
    if (std::ranges::find(all.radius_arrays, name) == all.radius_arrays.end()) all.radius_arrays.push_back(name);
  }
  all.warnings.insert(all.warnings.end(), file.warnings.begin(), file.warnings.end());
}

/// From one unit and frame to mm and LPS.
struct Conversion {
  LengthUnit unit;
  Space space;

  // Division by 1000 is correctly rounded, multiplication by 0.001 is not.
  double length(double x) const {
    if (unit == LengthUnit::nm) return x / 1e6;
    return unit == LengthUnit::um ? x / 1000 : x * millimetres_per(unit);
  }
  /// Half a turn about z, so that what is counter-clockwise stays so.
  Vec3 direction(const Vec3& v) const { return space == Space::ras ? Vec3(-v.x(), -v.y(), v.z()) : v; }
  Vec3 point(const Vec3& p) const {
    const Vec3 turned = direction(p);
    return {length(turned.x()), length(turned.y()), length(turned.z())};
  }

  void convert(RawCenterline& raw) const {
    for (auto& [position, radius] : raw.nodes) {
      position = point(position);
      radius = length(radius);
    }
    for (EndSection& section : raw.end_sections) {
      section.center = point(section.center);
      section.normal = direction(section.normal);
      section.area = length(length(section.area));
      for (Vec3& p : section.ring) p = point(p);
    }
  }
};

}  // namespace

std::string_view to_string(LengthUnit unit) {
  constexpr std::array<std::string_view, 6> kNames = {"unknown", "nm", "um", "mm", "cm", "m"};
  return kNames[static_cast<std::size_t>(unit)];
}

std::string_view to_string(Space space) {
  constexpr std::array<std::string_view, 3> kNames = {"unknown", "LPS", "RAS"};
  return kNames[static_cast<std::size_t>(space)];
}

std::optional<LengthUnit> parse_length_unit(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, LengthUnit>, 27> kNames = {{
      {"nm", LengthUnit::nm},          {"nanometer", LengthUnit::nm},   {"nanometre", LengthUnit::nm},
      {"nanometers", LengthUnit::nm},  {"nanometres", LengthUnit::nm},  {"\xB5m", LengthUnit::um},
      {"um", LengthUnit::um},          {"\xC2\xB5m", LengthUnit::um},   {"\xCE\xBCm", LengthUnit::um},
      {"micron", LengthUnit::um},      {"microns", LengthUnit::um},     {"micrometer", LengthUnit::um},
      {"micrometre", LengthUnit::um},  {"micrometers", LengthUnit::um}, {"mm", LengthUnit::mm},
      {"millimeter", LengthUnit::mm},  {"millimetre", LengthUnit::mm},  {"millimeters", LengthUnit::mm},
      {"millimetres", LengthUnit::mm}, {"cm", LengthUnit::cm},          {"centimeter", LengthUnit::cm},
      {"centimetre", LengthUnit::cm},  {"centimeters", LengthUnit::cm}, {"m", LengthUnit::m},
      {"meter", LengthUnit::m},        {"metre", LengthUnit::m},        {"unknown", LengthUnit::unknown},
  }};
  const std::string key = lower(text);
  for (const auto& [name, unit] : kNames) {
    if (key == name) return unit;
  }
  return std::nullopt;
}

std::optional<Space> parse_space(std::string_view text) {
  const std::string key = lower(text);
  if (key == "lps" || key == "left-posterior-superior") return Space::lps;
  if (key == "ras" || key == "right-anterior-superior") return Space::ras;
  if (key == "unknown") return Space::unknown;
  return std::nullopt;
}

EndTolerance parse_end_tolerance(std::string_view text) {
  const bool in_mm = text.ends_with("mm");
  const std::string_view number = text.substr(0, text.size() - (in_mm ? 2 : 0));
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size() || !(value > 0 && value <= 1e9))
    throw InvalidInput("\"" + std::string(text) +
                       "\" is no tolerance; give millimetres, such as 0.5mm, or radii, such as 0.1");
  return in_mm ? EndTolerance{value, 0} : EndTolerance{0, value};
}

double millimetres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::nm:
      return 1e-6;
    case LengthUnit::um:
      return 1e-3;
    case LengthUnit::mm:
      return 1;
    case LengthUnit::cm:
      return 10;
    case LengthUnit::m:
      return 1000;
    case LengthUnit::unknown:
      break;
  }
  throw InvalidInput("the unit of length is unknown; choose nm, um, mm, cm or m");
}

std::string RawCenterline::name_of_node(Index n) const {
  return (parts.empty() ? source : part_of(parts, &Part::first_node, n).source) + separator(source) +
         place(parts.empty() ? node_word : part_of(parts, &Part::first_node, n).node_word, node_numbers, n);
}

std::string RawCenterline::name_of_segment(Index s) const {
  return (parts.empty() ? source : part_of(parts, &Part::first_segment, s).source) + separator(source) +
         place(parts.empty() ? segment_word : part_of(parts, &Part::first_segment, s).segment_word, segment_numbers, s);
}

std::string RawCenterline::place_of_node(Index n) const {
  if (parts.empty()) return place(node_word, node_numbers, n);
  const Part& part = part_of(parts, &Part::first_node, n);
  return place(part.node_word, node_numbers, n) + " of " + part.source;
}

std::string RawCenterline::place_of_segment(Index s) const {
  if (parts.empty()) return place(segment_word, segment_numbers, s);
  const Part& part = part_of(parts, &Part::first_segment, s);
  return place(part.segment_word, segment_numbers, s) + " of " + part.source;
}

RawCenterline merge(std::vector<RawCenterline> files) {
  if (files.empty()) throw InvalidInput("there is no centerline to merge");
  if (files.size() == 1) return std::move(files.front());
  RawCenterline all;
  all.unit = files.front().unit;
  all.space = files.front().space;
  all.source = files.front().source + " and " + std::to_string(files.size() - 1) + " more";
  all.loose_branches = true;
  all.tree_only = std::all_of(files.begin(), files.end(), [](const RawCenterline& file) { return file.tree_only; });
  const bool has_paths =
      std::any_of(files.begin(), files.end(), [](const RawCenterline& file) { return !file.path_starts.empty(); });
  for (const RawCenterline& file : files) {
    check_agreement("unit", files.front().source, all.unit, file.source, file.unit);
    check_agreement("frame", files.front().source, all.space, file.source, file.space);
    append(file, has_paths, all);
  }
  return all;
}

std::optional<std::string> implausible_radii(const RawCenterline& raw) {
  constexpr double kThinnest = 0.05, kThickest = 40;  // mm: arterioles; an aneurysm of the aorta
  std::vector<double> radii;
  for (const CenterlineNode& node : raw.nodes) {
    if (std::isfinite(node.radius) && node.radius > 0) radii.push_back(node.radius);
  }
  if (radii.empty()) return std::nullopt;
  const double middle = median(std::move(radii));
  if (middle >= kThinnest && middle <= kThickest) return std::nullopt;
  std::ostringstream text;
  text << (raw.source.empty() ? "" : raw.source + ": ") << "half of the radii are "
       << (middle < kThinnest ? "below " : "above ") << middle
       << " mm; if these are not millimetres, give the unit with --unit";
  return text.str();
}

RawCenterline convert_to_internal(RawCenterline raw, std::optional<LengthUnit> unit_override,
                                  std::optional<Space> space_override, std::vector<std::string>& warnings) {
  raw.unit =
      choose(raw.unit, unit_override, LengthUnit::mm, raw.source, "unit", "--unit nm, um, mm, cm or m", warnings);
  raw.space = choose(raw.space, space_override, Space::lps, raw.source, "frame", "--space LPS or RAS", warnings);
  if (raw.unit != LengthUnit::mm || raw.space != Space::lps) Conversion{raw.unit, raw.space}.convert(raw);
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  return raw;
}

LengthUnit require_length_unit(const std::string& text) {
  if (const auto unit = parse_length_unit(text)) return *unit;
  throw InvalidInput("unit: \"" + text + "\" is not known; there are nm, um, mm, cm, m");
}

Space require_space(const std::string& text) {
  if (const auto space = parse_space(text)) return *space;
  throw InvalidInput("space: \"" + text + "\" is not known; there are LPS and RAS");
}

}  // namespace vmesh
