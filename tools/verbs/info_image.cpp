#include "verbs/info_image.h"

#include <charconv>
#include <cstdlib>

#include "vmesh/core/text.h"

#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

/// To the seven digits that float has: files often store 0.7 as 0.699999988.
double rounded(double number) {
  return std::strtod(formatted("%.7g", number + 0.0).c_str(), nullptr);  // -0 becomes 0
}

/// The shortest number that is the same float.
double shortest(float value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value + 0.0f);
  double number = value;
  std::from_chars(text, end, number);
  return number;
}

Json numbers(const Vec3& p) { return {rounded(p.x()), rounded(p.y()), rounded(p.z())}; }

void describe_place(const VoxelImage& frame, Json& json) {
  const auto [columns, rows, slices] = frame.size;
  const Vec3 spacing = frame.spacing();
  json["size_voxels"] = {columns, rows, slices};
  json["spacing_mm"] = numbers(spacing);
  json["extent_mm"] = numbers(
      spacing.cwiseProduct(Vec3(static_cast<double>(columns), static_cast<double>(rows), static_cast<double>(slices))));
  json["frame"] = {{"space", "LPS"}, {"origin_mm", numbers(frame.origin)}, {"axes", Json::array()}};
  for (int a = 0; a < 3; ++a) json["frame"]["axes"].push_back(numbers(frame.steps.col(a).normalized()));
}

void describe_labels(const ImageSummary& summary, Json& json) {
  json["labels"] = list_json(summary.labels, [](const ImageLabel& label) {
    return Json{{"value", static_cast<std::int64_t>(label.value)},
                {"voxels", label.voxels},
                {"components", label.components},
                {"volume_mm3", rounded(label.volume_mm3)}};
  });
}

void describe_grey(const GreyValues& grey, Json& json) {
  json["values"] = {
      {"least", shortest(grey.least)}, {"greatest", shortest(grey.greatest)}, {"mean", rounded(grey.mean)}};
  for (const Percentile& percentile : grey.percentiles)
    json["values"]["percentiles"][formatted("%g", percentile.percent)] = shortest(percentile.value);
}

/// One voxel along an axis, or no boundary between inside and outside.
std::vector<std::string> problems_of(const ImageSummary& summary) {
  std::vector<std::string> problems;
  for (std::size_t a = 0; a < 3; ++a)
    if (summary.image.frame.size[a] == 1)
      problems.push_back("there is only one voxel along axis " + std::to_string(a) + "; vessels need a volume");
  if (summary.zeros == summary.voxels()) {
    problems.emplace_back("all its voxels are 0; there is no vessel");
  } else if ((summary.labels.size() == 1 && summary.zeros == 0) ||
             (summary.grey && summary.grey->least == summary.grey->greatest)) {
    problems.emplace_back("all its voxels have the same value; there is no boundary");
  }
  return problems;
}

/// The name of the image or folder, without extensions.
std::string name_of(const std::filesystem::path& path) {
  const std::filesystem::path last = path.has_filename() ? path : path.parent_path();
  const std::string name = last.stem().stem().string();
  return name.empty() || name.starts_with('.') ? "vessels" : name;
}

/// Commands that take the image; N and T stand for what only the user can choose.
Json next_commands(const std::filesystem::path& path, const ImageSummary& summary) {
  if (summary.zeros == summary.voxels()) return Json::array();
  std::string choice = summary.grey ? " --threshold T" : " --label N";
  if (summary.labels.size() == 1)
    choice = " --label " + std::to_string(static_cast<std::int64_t>(summary.labels.front().value));
  const std::string image = path.string() + choice;
  return {"vmesh generate " + image + " -o " + name_of(path) + ".ply",
          "vmesh centerline " + image + " -o " + name_of(path) + ".centerline.json"};
}

}  // namespace

Json describe_image(const InputArguments& input, Console& console) {
  if (!input.more.empty()) throw UsageError(input.more.front().string() + ": an image must be the only input");
  const ImageSummary summary = load_image_summary(input, console);
  Json json = {{"kind", "image"}};
  describe_place(summary.image.frame, json);
  json["whole_numbers"] = summary.image.integer;
  json["voxels"] = summary.voxels();
  json["zeros"] = summary.zeros;
  if (summary.grey) {
    describe_grey(*summary.grey, json);
  } else {
    describe_labels(summary, json);
  }
  if (!summary.image.segments.empty()) {
    json["segments"] = list_json(summary.image.segments, [](const ImageSegment& segment) {
      return Json{{"name", segment.name}, {"label", static_cast<std::int64_t>(segment.value)}};
    });
  }
  json["next"] = next_commands(input.path, summary);
  json["problems"] = problems_of(summary);
  json["warnings"] = summary.image.warnings;
  return json;
}

}  // namespace vmesh::tool
