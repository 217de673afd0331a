#include "vmesh/centerline/raw_centerline.h"

#include <algorithm>
#include <array>
#include <utility>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

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
                         "; taken as " + std::string(to_string(*override_value)) + " as asked");
    }
    return *override_value;
  }
  if (in_file != Value::unknown) return in_file;
  warnings.push_back(prefix + "the file does not say its " + what + "; taken as " + std::string(to_string(fallback)) +
                     " (set it with " + option + ")");
  return fallback;
}

}  // namespace

std::string_view to_string(LengthUnit unit) {
  constexpr std::array<std::string_view, 5> kNames = {"unknown", "um", "mm", "cm", "m"};
  return kNames[static_cast<std::size_t>(unit)];
}

std::string_view to_string(Space space) {
  constexpr std::array<std::string_view, 3> kNames = {"unknown", "LPS", "RAS"};
  return kNames[static_cast<std::size_t>(space)];
}

std::optional<LengthUnit> parse_length_unit(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, LengthUnit>, 21> kNames = {{
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

double millimetres_per(LengthUnit unit) {
  switch (unit) {
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
  throw InvalidInput("the unit of length is unknown; choose um, mm, cm or m");
}

std::string RawCenterline::name_of_node(Index n) const {
  return (source.empty() ? "" : source + ": ") + place_of_node(n);
}

std::string RawCenterline::name_of_segment(Index s) const {
  return (source.empty() ? "" : source + ": ") + place_of_segment(s);
}

std::string RawCenterline::place_of_node(Index n) const { return place(node_word, node_numbers, n); }

std::string RawCenterline::place_of_segment(Index s) const { return place(segment_word, segment_numbers, s); }

RawCenterline convert_to_internal(RawCenterline raw, std::optional<LengthUnit> unit_override,
                                  std::optional<Space> space_override, std::vector<std::string>& warnings) {
  raw.unit = choose(raw.unit, unit_override, LengthUnit::mm, raw.source, "unit", "--unit um, mm, cm or m", warnings);
  raw.space = choose(raw.space, space_override, Space::lps, raw.source, "frame", "--space LPS or RAS", warnings);
  const double scale = millimetres_per(raw.unit);
  const double flip = raw.space == Space::ras ? -1 : 1;
  if (scale != 1 || flip != 1) {
    for (auto& [position, radius] : raw.nodes) {
      // Division by 1000 is correctly rounded, multiplication by 0.001 is not.
      const auto convert = [&](double x) { return raw.unit == LengthUnit::um ? x / 1000 : x * scale; };
      position = {convert(flip * position.x()), convert(flip * position.y()), convert(position.z())};
      radius = convert(radius);
    }
  }
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  return raw;
}

}  // namespace vmesh
