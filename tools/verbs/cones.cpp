#include "vmesh/reference/cones.h"

#include "vmesh/io/sha256.h"

#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/summary.h"

namespace vmesh::tool::cones_verb {
namespace {

struct ConesArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  int sides = 18;
  WritingArguments writing;
};

void add_options(CLI::App& verb, ConesArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline");
  add_output_after_several(verb, arguments.output, kSurfaceFile, "surface");
  add_number(verb, "--sides", arguments.sides, 3, 1000, "of a cone");
  add_writing(verb, arguments.writing);
}

MeshAttributes attributes_of(const TruncatedCones& cones) {
  MeshAttributes attributes;
  attributes.vertex = {{"radius", cones.radius}, {"segment", {cones.segment.begin(), cones.segment.end()}, true}};
  return attributes;
}

int run(const ConesArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check_writing(arguments.output, arguments.writing);
  check_outputs({{arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}}, files_of(arguments.input));
  const Centerline centerline = load_clean_centerline(arguments.input, console).cleaned.centerline;
  const TruncatedCones cones = truncated_cones(centerline, arguments.sides);
  const std::string how = "cones --sides " + std::to_string(arguments.sides), sha256 = sha256_of(arguments.input);
  write_surface(arguments.output, cones.mesh, attributes_of(cones),
                {generator_name(), how, file_name_of(arguments.input), sha256}, arguments.writing);
  console.log("wrote " + arguments.output.string() + ": " + std::to_string(centerline.segments().size()) + " cones, " +
              std::to_string(cones.mesh.vertices.size()) + " vertices");
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

const VerbRegistration<ConesArguments> kRegistration({
    .rank = 80,
    .name = "cones",
    .help = "Make a separate truncated cone around every segment of a centerline",
    .examples = R"(Examples:
  vmesh cones tree.swc -o cones.ply
  vmesh cones tree.swc -o cones.stl --sides 12)",
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::cones_verb
