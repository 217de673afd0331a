#include "report/fit_report.h"

#include <algorithm>
#include <sstream>

#include "report/evaluation_report.h"
#include "report/exact_text.h"
#include "report/extraction_report.h"

namespace vmesh::tool {
namespace {

constexpr std::size_t kListedParts = 1000;
constexpr std::size_t kPartsNamed = 5;

Json to_json(const FitDistance& distance) {
  return {{"hausdorff_mm", tool::to_json(distance.hausdorff)},
          {"mean_mm", distance.mean()},
          {"rms_mm", distance.rms()},
          {"p95_mm", distance.p95()},
          {"from_surface", side_json(distance.hausdorff.forward, distance.from_surface)},
          {"from_reference", side_json(distance.hausdorff.backward, distance.from_reference)}};
}

Json to_json(const std::vector<UnmatchedPart>& parts) {
  const auto of_part = [](const UnmatchedPart& part) {
    return Json{{"at", tool::to_json(part.position)},
                {"distance_mm", part.distance},
                {"area_mm2", part.area},
                {"inside", part.inside},
                {"segment", index_json(part.segment)}};
  };
  return counted_json(parts, of_part, kListedParts);
}

Json outside_json(const std::vector<Defect>& defects) {
  std::size_t count = 0;
  for (const Defect& defect : defects) count += defect.count;
  return count;
}

std::string text_of(const UnmatchedPart& part) {
  return formatted("%.1f mm^2 as far as %.2f mm at ", part.area, part.distance) + point_text(part.position);
}

void name_parts(const std::vector<UnmatchedPart>& parts, const std::string& what, std::vector<std::string>& warnings,
                Console& console) {
  const auto tell = [&](const std::string& text) {
    console.warn(text);
    warnings.push_back(text);
  };
  for (std::size_t i = 0; i < std::min(parts.size(), kPartsNamed); ++i) tell(what + ": " + text_of(parts[i]));
  if (parts.size() > kPartsNamed)
    tell(what + ", " + std::to_string(parts.size() - kPartsNamed) + " more: the summary lists them");
}

}  // namespace

Json to_json(const FitReport& report) {
  return {{"vertices_before", report.vertices_before},
          {"before", to_json(report.before)},
          {"after", to_json(report.after)},
          {"nodes_outside", outside_json(report.nodes_outside)},
          {"reference_turned", report.turned},
          {"rounds", report.rounds},
          {"parts_apart", {{"count", report.parts_apart}, {"area_mm2", report.area_apart}}},
          {"uncovered", to_json(report.uncovered)},
          {"unsupported", to_json(report.unsupported)},
          {"beyond", to_json(report.beyond)}};
}

void log_fit(const FitReport& report, std::vector<std::string>& warnings, Console& console) {
  const FitDistance &a = report.before, &b = report.after;
  if (report.turned) console.log("the reference faced inwards and was turned over");
  console.log(
      formatted("distance to the reference, larger direction, mm: mean %.3f, was %.3f; 95 %% %.3f, was %.3f; Hausdorff "
                "%.3f, was %.3f",
                b.mean(), a.mean(), b.p95(), a.p95(), b.hausdorff.upper(), a.hausdorff.upper()));
  if (report.parts_apart > 0)
    console.log(formatted("%zu components of the reference, %.1f mm^2, belong to no vessel and were left out",
                          report.parts_apart, report.area_apart));
  for (const Defect& defect : report.nodes_outside) {
    console.warn(defect.message);
    warnings.push_back(defect.message);
  }
  name_parts(report.uncovered, "region of the reference that no vessel covers", warnings, console);
  std::vector<UnmatchedPart> inside, outside;
  for (const UnmatchedPart& part : report.unsupported) (part.inside ? inside : outside).push_back(part);
  name_parts(inside, "wall within the reference, as of a hairpin in a wide vessel", warnings, console);
  name_parts(outside, "region of the surface that the reference lacks", warnings, console);
}

bool keeps_error(const FitReport& report, const FitOptions& options, std::vector<std::string>& warnings,
                 Console& console) {
  const bool is_near = options.error == 0 || report.after.p95() <= options.error;
  if (!is_near) {
    warnings.push_back(
        formatted("95 %% of the surfaces are within %.3f mm of each other, not %.3f: regions that the other "
                  "surface lacks count as well",
                  report.after.p95(), options.error));
    console.warn(warnings.back());
  }
  name_parts(report.beyond, formatted("farther than %.3f mm", options.max_error), warnings, console);
  return is_near && report.beyond.empty();
}

std::string describe(const FittingArguments& arguments) {
  std::ostringstream text;
  text << tool::describe(arguments.image);
  if (arguments.options.error > 0) text << " --fit-error " << arguments.options.error << "mm";
  if (arguments.options.max_error > 0) text << " --fit-error max=" << arguments.options.max_error << "mm";
  if (arguments.options.elongation > 1) text << " --elongation " << exact_text(arguments.options.elongation);
  text << " --fit-rounds " << arguments.options.rounds;
  if (!arguments.options.resize) text << " --keep-triangles";
  return text.str();
}

}  // namespace vmesh::tool
