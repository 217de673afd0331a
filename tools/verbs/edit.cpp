#include <functional>
#include <optional>

#include "vmesh/centerline/edits.h"
#include "vmesh/core/text.h"
#include "vmesh/io/sha256.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/solid/followed_volume.h"
#include "vmesh/solid/volume_check.h"
#include "vmesh/surface/followed_surface.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "verbs/bound_surface.h"
#include "verbs/moving_volume.h"

namespace vmesh::tool::edit_verb {
namespace {

using Kind = PlannedOutput::Kind;

struct EditArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  CenterlineEdit edit;
  std::string text;  ///< of the edit, as given
  InputArguments follow;
  std::filesystem::path follow_output;
  WritingArguments writing;
};

/// NODE,LENGTH,SHARE; `sign` of the share: narrower or wider.
RadiusChange parse_change(const std::string& option, const std::string& text, double sign) {
  const std::vector<double> numbers = parse_numbers(option, text, 3);
  if (!(numbers[0] >= 0 && numbers[0] < kNone && std::floor(numbers[0]) == numbers[0]))
    throw InvalidInput("the first number is a node of the centerline, 0 or more");
  if (!(numbers[1] > 0)) throw InvalidInput("the length must be positive, in mm");
  if (!(numbers[2] > 0 && (sign > 0 || numbers[2] < 1)))
    throw InvalidInput(sign > 0 ? "the share must be positive" : "the share must be between 0 and 1");
  return {static_cast<Index>(numbers[0]), numbers[1], sign * numbers[2]};
}

void add_change(CLI::App& verb, EditArguments& arguments, const std::string& option, double sign,
                const std::string& help) {
  const auto take = [&arguments, option, sign](const std::string& text) {
    arguments.edit.radius.push_back(parse_change(option, text, sign));
    arguments.text += " " + option + " " + text;
  };
  add_read_option(verb, option, take, help).type_name("NODE,LENGTH,SHARE")->take_all()->trigger_on_parse();
}

void add_options(CLI::App& verb, EditArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline");
  add_output_after_several(verb, arguments.output, kCenterlineFile, "edited centerline");
  add_change(verb, arguments, "--stenosis", -1,
             "narrow the vessels around a node, over LENGTH mm, by this share of the diameter in the middle");
  add_change(verb, arguments, "--dilate", 1, "the same, wider");
  verb.add_option("--remove", arguments.edit.removed_branches,
                  "branch to leave out, with what it joins to the thickest end of its component")
      ->allow_extra_args(false);
  add_number(verb, "--scale", arguments.edit.scale, 1e-6, 1e6, "of all lengths, about the origin");
  verb.add_option("--follow", arguments.follow.path,
                  "surface that vmesh grew around the centerline, or volume mesh: moved with it, faces and cells stay "
                  "(.ply, .vtp, .vtu)");
  add_reading(verb, arguments.follow, "follow-");
  verb.add_option("--follow-output", arguments.follow_output, "where to write it")->type_name(kSurfaceFile);
  add_writing(verb, arguments.writing);
}

bool follows_volume(const EditArguments& arguments) {
  const VolumeFormat* format = find_volume_format(arguments.follow.path);
  return format != nullptr && format->is_read();
}

void check_arguments(const EditArguments& arguments) {
  if (arguments.follow.path.empty() != arguments.follow_output.empty())
    throw UsageError("--follow names the surface and --follow-output the file to write: give both, or none");
  check_writing(arguments.output, arguments.writing);
  std::vector<PlannedOutput> outputs;
  for (const std::filesystem::path& file : files_of(arguments.output)) outputs.push_back({file, Kind::centerline});
  outputs.push_back({arguments.follow_output, follows_volume(arguments) ? Kind::volume : Kind::surface});
  outputs.push_back({arguments.common.json, Kind::summary});
  check_outputs(outputs, files_of({&arguments.input, &arguments.follow}));
}

/// What is wrong with a surface that was moved, a sentence each.
std::vector<std::string> problems_of(const TriMesh& before, const TriMesh& after) {
  std::vector<std::string> problems;
  const auto tell = [&](std::size_t number, const char* what, Index face) {
    problems.push_back(std::to_string(number) + what + point_text(after.vertices[after.faces[face][0]]));
  };
  std::vector<Index> turned;
  for (Index f = 0; f < after.faces.size(); ++f) {
    if (!(area_normal(before, f).dot(area_normal(after, f)) > 0)) turned.push_back(f);
  }
  if (!turned.empty()) tell(turned.size(), " of its faces would turn over, the first at ", turned.front());
  const auto crossing = self_intersections(after);
  if (!crossing.empty())
    tell(crossing.size(), " pairs of its faces would cross, the first at ", crossing.front().first);
  return problems;
}

/// With the radii and the skewness of the moved surface.
MeshAttributes attributes_after(const LoadedSurface& surface, const TriMesh& moved,
                                const std::vector<CenterlineBinding>& binding, const Centerline& centerline,
                                const CenterlineEdit& edit) {
  MeshAttributes attributes = surface.attributes;
  const ChangedRadius radius(centerline, edit.radius);
  for (MeshAttribute& attribute : attributes.vertex) {
    if (attribute.name != "radius") continue;
    for (std::size_t v = 0; v < binding.size(); ++v)
      attribute.values[v] *= edit.scale * radius.factor(binding[v].segment, binding[v].t);
  }
  for (MeshAttribute& attribute : attributes.face) {
    if (attribute.name == "EquiangleSkewness") attribute.values = equiangle_skewness(moved);
  }
  return attributes;
}

/// A surface or volume that was moved: what is wrong with it, and how it is written.
struct Followed {
  std::vector<std::string> problems;
  std::function<void(const std::string& options)> write;
};

Followed follow_volume(const EditArguments& arguments, const Centerline& centerline, Console& console) {
  LoadedVolume volume = load_volume(arguments.follow.path, console);
  VolumeMesh& mesh = volume.mesh;
  mesh.points = follow_edit(mesh, centerline, arguments.edit);
  Followed followed;
  for (const VolumeDefect& defect : find_volume_defects(mesh)) followed.problems.push_back(defect.message);
  followed.write = [&arguments, volume = std::move(volume)](const std::string& options) {
    write_volume(arguments.follow_output, volume.mesh,
                 {generator_name(), options, file_name_of(arguments.follow), sha256_of(arguments.follow),
                  arguments.writing.unit, arguments.writing.space},
                 volume.attributes);
  };
  return followed;
}

Followed follow_surface(const EditArguments& arguments, const Centerline& centerline, Console& console) {
  const LoadedSurface surface = load_surface(arguments.follow);
  console.warn(surface.warnings);
  const std::vector<CenterlineBinding> binding = binding_of(surface, centerline);
  TriMesh moved = surface.mesh;
  moved.vertices = follow_edit(surface.mesh.vertices, binding, centerline, arguments.edit);
  MeshAttributes attributes = attributes_after(surface, moved, binding, centerline, arguments.edit);
  Followed followed{problems_of(surface.mesh, moved), {}};
  followed.write = [&arguments, moved = std::move(moved),
                    attributes = std::move(attributes)](const std::string& options) {
    write_surface(arguments.follow_output, moved, attributes,
                  {generator_name(), options, file_name_of(arguments.follow), sha256_of(arguments.follow)},
                  arguments.writing);
  };
  return followed;
}

Followed follow(const EditArguments& arguments, const Centerline& centerline, Console& console) {
  Followed followed = naming(arguments.follow.path, [&] {
    return follows_volume(arguments) ? follow_volume(arguments, centerline, console)
                                     : follow_surface(arguments, centerline, console);
  });
  for (const std::string& problem : followed.problems)
    console.error(arguments.follow.path.string() + ": cannot follow: " + problem +
                  "; nothing is written. Change less, or make a mesh of the edited centerline");
  return followed;
}

std::string options_of(const EditArguments& arguments) {
  std::string options = "edit" + arguments.text;
  for (const Index branch : arguments.edit.removed_branches) options += " --remove " + std::to_string(branch);
  if (arguments.edit.scale != 1) options += formatted(" --scale %.17g", arguments.edit.scale);
  return options;
}

int run(const EditArguments& arguments, Console& console) {
  check_arguments(arguments);
  const LoadedCenterline loaded = load_clean_centerline(arguments.input, console);
  const Centerline& centerline = loaded.cleaned.centerline;
  const EditedCenterline edited = naming(
      arguments.input.path, [&] { return edit_centerline(centerline, arguments.edit, loaded.cleaned.end_sections); });
  stop_if_interrupted();
  std::optional<Followed> followed;
  if (!arguments.follow.path.empty()) followed = follow(arguments, centerline, console);
  if (followed && !followed->problems.empty()) return kDefective;

  const std::string options = options_of(arguments), name = file_name_of(arguments.input);
  write_centerline(
      arguments.output, edited.centerline,
      {generator_name(), options, name, sha256_of(arguments.input), arguments.writing.unit, arguments.writing.space},
      edited.end_sections, console);
  console.log("wrote " + arguments.output.string() + ": " + std::to_string(edited.centerline.nodes().size()) +
              " nodes, were " + std::to_string(centerline.nodes().size()));
  if (followed) {
    followed->write(options);
    console.log("wrote " + arguments.follow_output.string());
  }
  return kOk;
}

const VerbRegistration<EditArguments> kRegistration({
    .rank = 85,
    .name = "edit",
    .help = "Change a centerline for a study: a stenosis, a branch less; a surface can follow",
    .examples = R"(Examples:
  vmesh edit tree.swc -o narrowed.json --stenosis 12,8,0.5
  vmesh edit tree.swc -o larger.swc --remove 7 --scale 1.1
  vmesh edit tree.swc -o narrowed.json --stenosis 12,8,0.5 --follow tree.ply --follow-output narrowed.ply
Nodes and branches are numbered as vmesh info and generate tell them.)",
    .with_json = false,
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::edit_verb
