#include "vmesh/reference/cones.h"

#include "vmesh/io/sha256.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/outputs.h"
#include "report/summary.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

MeshAttributes attributes_of(const TruncatedCones& cones) {
  MeshAttributes attributes;
  attributes.vertex = {{"radius", cones.radius}, {"segment", {cones.segment.begin(), cones.segment.end()}, true}};
  return attributes;
}

}  // namespace

int run(const ConesArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check_outputs({{arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}}, files_of(arguments.input));
  const Centerline centerline = load_clean_centerline(arguments.input, console).cleaned.centerline;
  const TruncatedCones cones = truncated_cones(centerline, arguments.sides);
  const std::string how = "cones --sides " + std::to_string(arguments.sides), sha256 = sha256_of(arguments.input);
  write_surface(arguments.output, cones.mesh, attributes_of(cones),
                {generator_name(), how, file_name_of(arguments.input), sha256});
  console.log("wrote " + arguments.output.string() + ": " + std::to_string(centerline.segments().size()) + " cones, " +
              std::to_string(cones.mesh.vertices.size()) + " vertices");
  if (!arguments.common.json.empty())
    write_json(arguments.common.json, {{"schema", "vmesh.cones/1"},
                                       {"generator", generator_json()},
                                       {"input", {{"file", path.string()}, {"sha256", sha256}}},
                                       {"centerline", to_json(centerline)},
                                       {"sides", arguments.sides},
                                       {"cones", centerline.segments().size()},
                                       {"vertices", cones.mesh.vertices.size()},
                                       {"faces", cones.mesh.faces.size()}});
  return kOk;
}

}  // namespace vmesh::tool
