// What several reports in JSON have in common.
#pragma once

#include <filesystem>
#include <limits>

#include <nlohmann/json.hpp>

#include "vmesh/core/types.h"
#include "vmesh/core/version.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/quality/hausdorff.h"

namespace vmesh::tool {

/// JSON that keeps the order in which its members were written.
using Json = nlohmann::ordered_json;

/// The program and its version.
inline Json generator_json() { return {{"name", "vmesh"}, {"version", version()}}; }

inline Json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Null for kNone.
inline Json index_json(Index index) { return index == kNone ? Json() : Json(index); }

inline Json to_json(const SkewnessSummary& skewness) { return {{"mean", skewness.mean}, {"max", skewness.max}}; }

/// The interval that contains the distance: of both directions (Hausdorff), or of one.
inline Json interval_json(double lower, double upper) { return {{"lower", lower}, {"upper", upper}}; }
inline Json to_json(const Hausdorff& hausdorff) { return interval_json(hausdorff.lower(), hausdorff.upper()); }

/// What `convert` makes of the elements, of the first `most`.
template <class List, class Convert>
Json list_json(const List& list, Convert convert, std::size_t most = std::numeric_limits<std::size_t>::max()) {
  Json json = Json::array();
  for (const auto& element : list) {
    if (json.size() == most) break;
    json.push_back(convert(element));
  }
  return json;
}

/// The same with the number of all.
template <class List, class Convert>
Json counted_json(const List& list, Convert convert, std::size_t most) {
  return {{"count", list.size()}, {"list", list_json(list, convert, most)}};
}

/// Writes the JSON with a newline at its end, as write_text() does; nothing if the path is empty. Text that is not
/// UTF-8 is repaired.
void write_json(const std::filesystem::path& path, const Json& json);

}  // namespace vmesh::tool
