#include "options.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/error.h"
#include "vmesh/core/version.h"

namespace vmesh::wasm {
namespace {

/// A number without fraction that `Number` can hold.
template <class Number>
bool holds(const nlohmann::json& value) {
  if (!value.is_number()) return false;
  const double number = value.get<double>();
  return number == std::floor(number) && number >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
         number <= static_cast<double>(std::numeric_limits<Number>::max());
}

/// Replaces what `parse` makes of a text that is given.
template <class Value, class Parse>
void take_parsed(GivenOptions& given, const char* name, Value& value, const Parse& parse) {
  std::string text;
  given.take(name, text);
  if (!text.empty()) value = parse(text);
}

}  // namespace

GivenOptions::GivenOptions(const char* text, std::string function)
    : function_(std::move(function)), options_(nlohmann::json::parse(text, nullptr, false)) {
  if (!options_.is_object()) throw InvalidInput(function_ + ": the options must be an object");
}

const nlohmann::json* GivenOptions::find(const char* name) {
  taken_.emplace_back(name);
  const auto found = options_.find(name);
  return found == options_.end() || found->is_null() ? nullptr : &*found;
}

void GivenOptions::refuse(const char* name, const char* type) const {
  throw InvalidInput(function_ + ": the option " + name + " must be " + type);
}

void GivenOptions::take(const char* name, double& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  if (!given->is_number()) refuse(name, "a number");
  value = given->get<double>();
}

void GivenOptions::take(const char* name, int& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  if (!holds<int>(*given)) refuse(name, "a whole number");
  value = static_cast<int>(given->get<double>());
}

void GivenOptions::take(const char* name, std::size_t& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  if (!holds<std::uint32_t>(*given)) refuse(name, "a whole number, 0 or more");
  value = static_cast<std::size_t>(given->get<double>());
}

void GivenOptions::take(const char* name, bool& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  if (!given->is_boolean()) refuse(name, "true or false");
  value = given->get<bool>();
}

void GivenOptions::take(const char* name, std::string& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  if (!given->is_string()) refuse(name, "a text");
  value = given->get<std::string>();
}

void GivenOptions::take(const char* name, std::vector<std::string>& value) {
  const nlohmann::json* given = find(name);
  if (given == nullptr) return;
  const auto is_text = [](const nlohmann::json& element) { return element.is_string(); };
  if (!given->is_array() || !std::all_of(given->begin(), given->end(), is_text)) refuse(name, "a list of texts");
  value = given->get<std::vector<std::string>>();
}

void GivenOptions::finish() const {
  for (const auto& [name, value] : options_.items()) {
    if (std::find(taken_.begin(), taken_.end(), name) == taken_.end())
      throw InvalidInput(function_ + ": there is no option \"" + name + "\"; there are " + listed(taken_, "and"));
  }
}

ReadRequest read_request(const char* json) {
  GivenOptions given(json, "read()");
  ReadRequest request;
  CenterlineLoadOptions& options = request.options;
  std::vector<std::string> files;
  given.take("files", files);
  request.paths.assign(files.begin(), files.end());
  take_parsed(given, "unit", options.unit, require_length_unit);
  take_parsed(given, "space", options.space, require_space);
  given.take("radiusArray", options.read.radius_array);
  double radius = 0;
  given.take("radius", radius);
  if (radius != 0) options.read.radius = radius;
  given.finish();
  return request;
}

ProductionOptions production_options(const char* json) {
  GivenOptions given(json, "generate()");
  ProductionOptions options;
  GenerateOptions& growth = options.growth;
  given.take("around", growth.around);
  take_parsed(given, "maxError", growth.max_error, parse_error_limit);
  given.take("blend", growth.blend);
  take_parsed(given, "placement", growth.placement, parse_placement);
  take_parsed(given, "growth", growth.growth, parse_growth_method);
  take_parsed(given, "overlap", options.preparation.separate, [](const std::string& text) {
    if (text != "separate" && text != "keep")
      throw InvalidInput("overlap: \"" + text + "\" is not known; there are separate and keep");
    return text == "separate";
  });
  given.take("gap", options.preparation.gap);
  take_parsed(given, "ends", options.ends, parse_end_shape);
  given.take("flowExtension", options.extension);
  given.take("simplification", growth.simplification);
  given.take("elongation", growth.elongation);
  given.take("ringSpacing", growth.ring_spacing);
  given.take("leastVertices", growth.least_vertices);
  given.take("deformable", growth.deformable);
  given.take("sweeps", growth.sweeps);
  given.take("maxVertices", growth.max_vertices);
  given.finish();
  return options;
}

WriteRequest write_request(const char* json) {
  GivenOptions given(json, "write()");
  WriteRequest request;
  request.metadata.generator = "vmesh " + std::string(version()) + ", WebAssembly";
  take_parsed(given, "unit", request.metadata.unit, require_length_unit);
  take_parsed(given, "space", request.metadata.space, require_space);
  bool ascii = false;
  given.take("ascii", ascii);
  if (ascii) request.encoding = SurfaceEncoding::text;
  given.finish();
  return request;
}

}  // namespace vmesh::wasm
