// Text forms of the options and of what a result says.
#include <charconv>
#include <cstdio>
#include <cstdlib>

#include "vmesh/core/error.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

std::string_view to_string(GrowthMethod method) { return method == GrowthMethod::paper ? "paper" : "guided"; }

std::string_view to_string(GrowthWarning::Kind kind) {
  switch (kind) {
    case GrowthWarning::Kind::filled_loop:
      return "filled_loop";
    case GrowthWarning::Kind::closed_end:
      return "closed_end";
    case GrowthWarning::Kind::refused_faces:
      return "refused_faces";
    case GrowthWarning::Kind::unclosed_loop:
      return "unclosed_loop";
    case GrowthWarning::Kind::forced_vertices:
      return "forced_vertices";
    case GrowthWarning::Kind::crossing_faces:
      return "crossing_faces";
    case GrowthWarning::Kind::stopped_refining:
      break;
  }
  return "stopped_refining";
}

std::string_view to_string(GrowthSimplification::Kind kind) {
  switch (kind) {
    case GrowthSimplification::Kind::merged_nodes:
      return "merged_nodes";
    case GrowthSimplification::Kind::buried_branch:
      return "buried_branch";
    case GrowthSimplification::Kind::filled_loop:
      break;
  }
  return "filled_loop";
}

GrowthMethod parse_growth_method(std::string_view text) {
  for (const GrowthMethod method : {GrowthMethod::guided, GrowthMethod::paper}) {
    if (text == to_string(method)) return method;
  }
  throw InvalidInput("growth method \"" + std::string(text) + "\": must be guided or paper");
}

std::string_view to_string(Placement placement) { return placement == Placement::inscribed ? "inscribed" : "balanced"; }

Placement parse_placement(std::string_view text) {
  for (const Placement placement : {Placement::inscribed, Placement::balanced}) {
    if (text == to_string(placement)) return placement;
  }
  throw InvalidInput("placement \"" + std::string(text) + "\": must be inscribed or balanced");
}

namespace {

// `value` times `scale` in the fewest digits that read as the same value.
std::string exact_text(double value, double scale) {
  char text[32];
  for (int digits = 6; digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, scale * value);
    if (std::strtod(text, nullptr) / scale == value) break;
  }
  return text;
}

}  // namespace

std::string to_string(const ErrorLimit& limit) {
  std::string text;
  if (std::isfinite(limit.mm)) text.append(exact_text(limit.mm, 1)).append("mm");
  if (!std::isfinite(limit.relative)) return text;
  if (!text.empty()) text += ',';
  return text.append(exact_text(limit.relative, 100)).append("%");
}

ErrorLimit parse_error_limit(std::string_view text) {
  ErrorLimit limit;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    double value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    const std::string_view unit = item.substr(static_cast<std::size_t>(end - item.data()));
    if (error != std::errc() || !(value > 0) || !std::isfinite(value) || (unit != "mm" && unit != "%"))
      throw InvalidInput("error limit \"" + std::string(item) + "\": must be a value such as 0.3mm or 10%");
    if (unit == "mm") {
      limit.mm = value;
    } else {
      limit.relative = value / 100;
    }
  }
  if (!limit.is_set()) throw InvalidInput("the error limit is empty: must be a value such as 0.3mm or 10%");
  return limit;
}

}  // namespace vmesh
