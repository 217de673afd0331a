#include <algorithm>
#include <iostream>
#include <sstream>

#include "vmesh/io/sha256.h"
#include "vmesh/quality/sampled_distance.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/openings.h"
#include "report/summary.h"
#include "verbs/info_image.h"

namespace vmesh::tool::info_verb {
namespace {

struct InfoArguments {
  CommonArguments common;
  InputArguments input;
  bool check = false;  ///< exit code 1 when the file has problems
};

void add_options(CLI::App& verb, InfoArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline, surface or image");
  verb.add_flag("--check", arguments.check, "exit with 1 when there is a problem");
}

std::string text_of(const Json& value) {
  return value.is_string() ? printable(value.get<std::string>()) : value.dump();
}

/// One value per line, as "name: value"; members of members as "name.member: value".
void print(std::ostream& out, const Json& json, const std::string& prefix = "") {
  for (const auto& [key, value] : json.items()) {
    const std::string name = prefix + key;
    if (value.is_object()) {
      print(out, value, name + ".");
    } else if (value.is_array()) {
      for (const Json& element : value) out << name << ": " << text_of(element) << "\n";
    } else {
      out << name << ": " << text_of(value) << "\n";
    }
  }
}

Json messages_of(const std::vector<CenterlineProblem>& problems) {
  return list_json(problems, [](const CenterlineProblem& problem) { return problem.message; });
}

/// Describes what the file contains, its problems, and the result of cleaning. If it cannot be cleaned, the reason is
/// under "error".
void describe(const RawCenterline& raw, Json& json) {
  json["kind"] = "centerline";
  json["in_file"] = {
      {"nodes", raw.nodes.size()}, {"segments", raw.segments.size()}, {"radius_arrays", raw.radius_arrays}};
  try {
    const CleanedCenterline cleaned = clean(raw);
    json["centerline"] = to_json(cleaned.centerline);
    json["centerline"]["end_sections"] = cleaned.end_sections.size();
    json["cleaning"] = to_json(cleaned.report);
  } catch (const InvalidInput& error) {
    json["error"] = error.what();
  }
  json["problems"] = messages_of(validate(raw.nodes, raw.segments));
}

/// The box around the surface, and its holes.
void describe_place(const TriMesh& mesh, Json& json) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  json["box_mm"] = {{"from", to_json(Vec3(box.min()))}, {"to", to_json(Vec3(box.max()))}};
  constexpr std::size_t kNamed = 100;
  const std::vector<BoundaryLoop> loops = boundary_loops(mesh);
  const auto of_loop = [](const BoundaryLoop& loop) {
    return Json{{"center_mm", to_json(loop.center)}, {"area_mm2", loop.area_mm2}, {"edges", loop.edges}};
  };
  json["openings"] = {{"count", loops.size()}, {"largest", list_json(loops, of_loop, kNamed)}};
}

void describe(const LoadedSurface& surface, Json& json) {
  json["kind"] = "surface";
  json["vertices"] = surface.mesh.vertices.size();
  json["faces"] = surface.mesh.faces.size();
  const SurfaceMeasurement measurement = measure_surface(surface.mesh);
  json.update(to_json(measurement));
  json["area_mm2"] = surface_area(surface.mesh);
  describe_place(surface.mesh, json);
  if (measurement.topology.closed && measurement.topology.oriented)
    json["enclosed_volume_mm3"] = enclosed_volume(surface.mesh);
  for (const auto& [name, list] : {std::pair{"vertex_attributes", &surface.attributes.vertex},
                                   std::pair{"face_attributes", &surface.attributes.face}}) {
    json[name] = list_json(*list, [](const MeshAttribute& attribute) { return attribute.name; });
  }
  json["problems"] = problems_of(measurement);
}

/// What is in the input, by its kind.
Json description(const InputArguments& input, Console& console) {
  if (is_image(input.path)) return describe_image(input, console);
  std::vector<std::string> warnings;
  FileFrame frame;
  const AnyInput any = load_any(input, warnings, &frame);
  console.warn(warnings);
  Json json;
  std::visit([&json](const auto& content) { describe(content, json); }, any);
  json["unit_in_file"] = to_string(frame.unit);
  json["space_in_file"] = to_string(frame.space);
  json["warnings"] = warnings;
  return json;
}

int run(const InfoArguments& arguments, Console& console) {
  check_outputs({{arguments.common.json, PlannedOutput::Kind::summary}}, files_of(arguments.input));
  const Json content = description(arguments.input, console);
  Json json = {{"schema", "vmesh.info/1"},
               {"generator", generator_json()},
               {"file", arguments.input.path.string()},
               {"sha256", sha256_of(arguments.input)}};
  json.update(content);
  stop_if_interrupted();

  if (arguments.common.json != "-") {
    std::ostringstream text;
    print(text, json);
    write_text("-", text.str());
  }
  write_json(arguments.common.json, json);
  if (json.contains("error")) throw InvalidInput(json["error"].get<std::string>());
  return arguments.check && !json["problems"].empty() ? kCheckFailed : kOk;
}

const VerbRegistration<InfoArguments> kRegistration({
    .rank = 20,
    .name = "info",
    .help = "Show what a centerline, surface or image contains, and what is wrong with it",
    .examples = R"(Examples:
  vmesh info tree.swc
  vmesh info tree.ply --json -
  vmesh info liver.nii.gz
  vmesh info tree.ply --check && echo flawless)",
    .add_options = add_options,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::info_verb
