#include <sstream>

#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/extraction_report.h"
#include "report/summary.h"

namespace vmesh::tool::reference_verb {
namespace {

struct ReferenceArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  ReferenceOptions options;
  double voxel = 0;  ///< of a sampled centerline, mm; 0: not given
  WritingArguments writing;
};

void add_options(CLI::App& verb, ReferenceArguments& arguments) {
  add_input(verb, arguments.input, "image (" + listed_image_extensions() + ") or centerline");
  add_voxel_size(verb, arguments.input, "");
  add_output(verb, arguments.output, kSurfaceFile, "surface");
  add_image_options(verb, arguments.options);
  verb.add_option("--voxel", arguments.voxel, "centerline: side of the voxels, mm")->check(in_range(1e-6, 1e6));
  verb.add_flag("--binary", arguments.options.binary,
                "contour only inside and outside instead of grey values: a staircase, with better triangles");
  verb.add_flag("--all-components", arguments.options.all_components,
                "keep all components and cavities, not only the component of the largest volume");
  add_writing_without_attributes(verb, arguments.writing);
}

void check(const ReferenceArguments& arguments) {
  const ReferenceOptions& options = arguments.options;
  const bool image = is_image(arguments.input.path);
  const std::string name = arguments.input.path.string();
  if (image && arguments.voxel > 0) throw UsageError(name + ": --voxel is for centerlines; see --spacing");
  if (image) return;
  if (!options.labels.empty() || !options.segments.empty() || options.threshold || options.spacing > 0)
    throw UsageError(name + ": --label, --threshold and --spacing are for images; this is taken for a centerline");
  if (arguments.voxel == 0)
    throw UsageError(name + ": to contour the volume of a centerline, give the side of the voxels: --voxel MM");
}

std::string describe(const ReferenceArguments& arguments) {
  const ReferenceOptions& options = arguments.options;
  std::ostringstream text;
  text << "reference";
  if (arguments.voxel > 0) text << " --voxel " << arguments.voxel;
  text << tool::describe(options);
  if (options.binary) text << " --binary";
  if (options.all_components) text << " --all-components";
  return text.str();
}

ReferenceSurface contoured(const ReferenceArguments& arguments, Console& console) {
  return naming(arguments.input.path, [&] {
    if (is_image(arguments.input.path)) {
      const LoadedImage image = load_image(arguments.input, arguments.options, console);
      stop_if_interrupted();
      return reference_surface(image, arguments.options);
    }
    const Centerline centerline = load_clean_centerline(arguments.input, console).cleaned.centerline;
    stop_if_interrupted();
    return reference_surface(centerline, arguments.voxel, arguments.options);
  });
}

int run(const ReferenceArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check(arguments);
  check_writing(arguments.output, arguments.writing);
  check_outputs({{arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}}, files_of_input(path));
  const ReferenceSurface surface = contoured(arguments, console);
  stop_if_interrupted();
  const std::string sha256 = sha256_of_input(path);
  write_surface(arguments.output, surface.mesh, {},
                {generator_name(), describe(arguments), path.filename().string(), sha256}, arguments.writing);
  if (surface.components > 1 && !arguments.options.all_components)
    console.log("the largest of " + std::to_string(surface.components) + " components was kept (--all-components)");
  const char* kind = surface.binary ? "a binary volume" : "grey values";
  console.log("wrote " + arguments.output.string() + ": marching cubes of " + kind + ", " +
              std::to_string(surface.mesh.vertices.size()) + " vertices, " + std::to_string(surface.mesh.faces.size()) +
              " faces");
  write_json(arguments.common.json, {{"schema", "vmesh.reference/1"},
                                     {"generator", generator_json()},
                                     {"input", {{"file", path.string()}, {"sha256", sha256}}},
                                     {"options", describe(arguments)},
                                     {"contour_of", surface.binary ? "binary" : "grey"},
                                     {"spacing_mm", {surface.spacing.x(), surface.spacing.y(), surface.spacing.z()}},
                                     {"components", surface.components},
                                     {"vertices", surface.mesh.vertices.size()},
                                     {"faces", surface.mesh.faces.size()}});
  return kOk;
}

const VerbRegistration<ReferenceArguments> kRegistration({
    .rank = 70,
    .name = "reference",
    .help = "Contour an image by marching cubes, or the vessel volume of a centerline sampled on voxels",
    .examples = R"(Examples:
  vmesh reference liver.nii.gz --label 2 --spacing 0.8 --smooth 0.8 -o portal.ply
  vmesh reference ct.nrrd --threshold 150 --all-components -o bright.stl
  vmesh reference tree.swc --voxel 0.5 -o tree_reference.ply)",
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::reference_verb
