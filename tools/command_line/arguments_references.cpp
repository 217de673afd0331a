#include <cmath>
#include <sstream>

#include "vmesh/core/error.h"

#include "command_line/arguments_common.h"

namespace vmesh::tool {
namespace {

constexpr const char* kReferenceExamples = R"(Examples:
  vmesh reference liver.nii.gz --label 2 --spacing 0.8 --smooth 0.8 -o portal.ply
  vmesh reference ct.nrrd --threshold 150 --all-components -o bright.stl
  vmesh reference tree.swc --voxel 0.5 -o tree_reference.ply)";
constexpr const char* kConesExamples = R"(Examples:
  vmesh cones tree.swc -o cones.ply
  vmesh cones tree.swc -o cones.stl --sides 12)";
constexpr const char* kCenterlineExamples = R"(Examples:
  vmesh centerline portal.ply -o portal.json
  vmesh centerline liver.nii.gz --label 2 -o portal.swc --tree
  vmesh centerline aorta-open.stl --unit mm -o aorta.vtp --require coverage=.98
  vmesh centerline circle.nii.gz --each-label -o circle.json)";
constexpr const char* kTable2Examples = R"(Examples:
  vmesh table2
  vmesh table2 --centerline tree.swc --voxel 0.5 --format markdown
  vmesh table2 --reference liver.nii.gz --label 2 --spacing 1 --smooth 0.8 --report table.md --surfaces folder
  vmesh table2 --reference portal.ply --tree)";
constexpr const char* kFitExamples = R"(Examples:
  vmesh fit tree.ply scan.stl --centerline tree.swc -o fitted.ply
  vmesh fit portal.ply liver.nii.gz --label 2 --spacing 1 --smooth 1 --centerline portal.swc -o fitted.ply \
    --html fitted.html)";
constexpr const char* kTradeoffExamples = R"(Examples:
  vmesh tradeoff tree.swc --report tradeoff.md --plot tradeoff.svg --json tradeoff.json)";

}  // namespace

void add_image_options(CLI::App& verb, ReferenceOptions& options) {
  CLI::Option* label =
      verb.add_option("--label", options.labels, "image: voxels of this value are inside, or of these: 1,2,5")
          ->delimiter(',')
          ->allow_extra_args(false)
          ->type_name("N,N,...");
  verb.add_option("--threshold", options.threshold, "image: voxels of at least this value are inside")->excludes(label);
  verb.add_option("--spacing", options.spacing, "image: resample to cubic voxels of this side, mm; 0: do not resample")
      ->check(in_range(0.0, 1e6))
      ->capture_default_str();
  verb.add_option("--smooth", options.smooth, "smooth with a Gaussian of this standard deviation, mm; 0: do not smooth")
      ->check(in_range(0.0, 1e6))
      ->capture_default_str();
}

void add_extraction(CLI::App& verb, ExtractOptions& options) {
  verb.add_option("--step", options.spacing, "distance between nodes along a vessel, in local radii")
      ->check(in_range(0.1, 10.0))
      ->capture_default_str();
  verb.add_option("--join", options.join,
                  "join ends with what they point at over gaps of up to this times the smaller radius; 0: none")
      ->check(in_range(0.0, 1e6))
      ->capture_default_str();
  CLI::Option* largest = verb.add_flag("--largest", options.largest, "keep the longest component only");
  verb.add_option("--least-length", options.least_length,
                  "leave out components shorter than this, mm; 0: those no longer than wide")
      ->check(in_range(0.0, 1e9))
      ->excludes(largest)
      ->capture_default_str();
  verb.add_flag("--tree", options.tree, "open all loops, each at its thinnest contact");
  verb.add_flag(
      "--balanced-wall", options.balanced_wall,
      "the wall's faces, not its vertices, lie on the vessels' boundary in the mean, as in surfaces that vmesh "
      "grows");
}

void add_required_coverage(CLI::App& verb, RequiredCoverage& required) {
  verb.add_option_function<std::string>(
          "--require",
          [&required](const std::string& text) {
            std::istringstream list(text);
            for (std::string item; std::getline(list, item, ',');) {
              const std::size_t equals = item.find('=');
              const std::string name = item.substr(0, equals);
              double value = -1;
              const bool is_number =
                  equals != std::string::npos && CLI::detail::lexical_cast(item.substr(equals + 1), value);
              double* target = name == "coverage"          ? &required.wall
                               : name == "length-coverage" ? &required.length
                                                           : nullptr;
              if (target == nullptr || !is_number || !(value >= 0 && value <= 1))
                throw CLI::ValidationError(
                    "--require", "\"" + item + "\" is none of coverage=SHARE and length-coverage=SHARE, with 0 to 1");
              *target = value;
            }
          },
          "exit with 1 unless the extracted centerline covers this share of the wall (coverage=.98) or of the length "
          "of all vessels (length-coverage=.99)")
      ->type_name("NAME=SHARE,...");
}

void add_fitting(CLI::App& verb, FittingArguments& arguments) {
  add_reading(verb, arguments.reference, "reference-");
  add_image_options(verb, arguments.image);
  verb.add_option_function<std::string>(
          "--fit-error",
          [&arguments](const std::string& text) {
            try {
              const ErrorLimit limit = parse_error_limit(text);
              if (std::isfinite(limit.relative)) throw InvalidInput("give millimetres, such as 0.3mm");
              arguments.options.error = limit.mm;
            } catch (const InvalidInput& error) {
              throw CLI::ValidationError("--fit-error", error.what());
            }
          },
          "as many vertices as needed for 95 % of either surface to be nearer than this to the other")
      ->type_name("Xmm");
  verb.add_option("--fit-rounds", arguments.options.rounds, "rounds of the fit")
      ->check(in_range(1, 100))
      ->capture_default_str();
  verb.add_flag("!--keep-triangles", arguments.options.resize,
                "only move the vertices; otherwise triangles become finer where the error is large, and coarser where "
                "it is small");
}

void add_fit(CLI::App& app, FitArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("fit", "Fit a surface grown by vmesh to a segmentation: a surface or an image");
  add_input(verb, arguments.input, "surface, with places on the centerline (.ply, .vtp)");
  verb.add_option("REFERENCE", arguments.fitting.reference.path,
                  "surface, or image (.nii, .nii.gz, .nrrd, .mha, or a folder of DICOM files)")
      ->required();
  add_output(verb, arguments.output, "surface");
  add_writing(verb, arguments.writing);
  verb.add_option("--centerline", arguments.centerline.path, "around which the surface was grown")->required();
  add_reading(verb, arguments.centerline, "centerline-");
  add_fitting(verb, arguments.fitting);
  verb.add_option("--max-vertices", arguments.fitting.options.max_vertices,
                  "0: a twentieth more than the surface has, or as many as --fit-error needs")
      ->capture_default_str();
  add_budget(verb, arguments.budget, "vertices=N: as --max-vertices N; error=Xmm: as --fit-error Xmm")
      .type_name("vertices=N|error=Xmm")
      ->excludes("--max-vertices")
      ->excludes("--fit-error");
  verb.add_option("--threads", arguments.fitting.options.threads,
                  "to work on; 0: all; the result does not depend on it")
      ->check(in_range(0, 4096))
      ->capture_default_str();
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  verb.footer(kFitExamples);
}

void add_reference(CLI::App& app, ReferenceArguments& arguments) {
  CLI::App& verb = *app.add_subcommand(
      "reference", "Contour an image by marching cubes, or the vessel volume of a centerline sampled on voxels");
  add_input(verb, arguments.input, "image (.nii, .nii.gz, .nrrd, .mha, or a folder of DICOM files) or centerline");
  add_output(verb, arguments.output, "surface");
  add_image_options(verb, arguments.options);
  verb.add_option("--voxel", arguments.voxel, "centerline: side of the voxels, mm")->check(in_range(1e-6, 1e6));
  verb.add_flag("--binary", arguments.options.binary,
                "contour only inside and outside instead of grey values: a staircase, with better triangles");
  verb.add_flag("--all-components", arguments.options.all_components,
                "keep all components and cavities, not only the component of the largest volume");
  add_common(verb, arguments.common);
  verb.footer(kReferenceExamples);
}

void add_cones(CLI::App& app, ConesArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("cones", "Make a separate truncated cone around every segment of a centerline");
  add_centerline_input(verb, arguments.input, "centerline");
  add_output_after_several(verb, arguments.output, "surface");
  verb.add_option("--sides", arguments.sides, "of a cone")->check(in_range(3, 1000))->capture_default_str();
  add_common(verb, arguments.common);
  verb.footer(kConesExamples);
}

void add_centerline(CLI::App& app, CenterlineArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("centerline",
                                       "Extract the centerline with radii from a surface, open or closed, or an image");
  add_input(verb, arguments.input, "surface, or image (.nii, .nii.gz, .nrrd, .mha, or a folder of DICOM files)");
  add_output(verb, arguments.output, "centerline");
  add_image_options(verb, arguments.image);
  verb.add_flag("--each-label", arguments.each_label,
                "image: a centerline of each label on its own, in one file; segments carry the label (.json, .vtp)");
  add_extraction(verb, arguments.options);
  add_required_coverage(verb, arguments.required_coverage);
  add_common(verb, arguments.common);
  group(verb, "What of an image is inside", {"--label", "--each-label", "--threshold", "--spacing", "--smooth"});
  verb.footer(kCenterlineExamples);
}

void add_table2(CLI::App& app, Table2Arguments& arguments) {
  CLI::App& verb = *app.add_subcommand(
      "table2",
      "Compare marching cubes, truncated cones and both presets as in the paper's Table 2; without a file, on a "
      "synthetic portal vein");
  verb.add_option("--reference", arguments.reference.path,
                  "image or closed surface to compare with; centerline and surfaces are made from it");
  add_reading(verb, arguments.reference, "reference-");
  verb.add_option("--centerline", arguments.centerline.path,
                  "centerline to start from; without a reference, its sampled volume is the reference");
  add_reading(verb, arguments.centerline, "centerline-");
  add_image_options(verb, arguments.image);
  verb.add_flag("--binary", arguments.image.binary, "contour only inside and outside instead of grey values");
  verb.add_flag("--all-components", arguments.all_components,
                "keep all components of the reference, not only that of the largest volume");
  verb.add_option("--voxel", arguments.voxel,
                  "without a reference: side of the voxels on which the centerline's volume is sampled, mm")
      ->check(in_range(1e-6, 1e6))
      ->default_str("0.665");
  add_extraction(verb, arguments.extraction);
  verb.add_option("--sides", arguments.methods.sides, "of a cone")->check(in_range(3, 1000))->capture_default_str();
  add_measuring(verb, arguments.methods.tolerance, arguments.methods.samples);
  add_report(verb, arguments.report, arguments.format);
  verb.add_option("--surfaces", arguments.surfaces,
                  "folder for reference.ply, cones.ply, low.ply and high.ply with distances (the reference's: to low), "
                  "and centerline.json");
  verb.add_flag("--check", arguments.check, "exit with 1 unless the low resolution meets all requirements");
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  verb.footer(kTable2Examples);
}

void add_tradeoff(CLI::App& app, TradeoffArguments& arguments) {
  CLI::App& verb = *app.add_subcommand(
      "tradeoff", "Grow a centerline's surface with many settings, and compare accuracy against time and vertices");
  add_centerline_input(verb, arguments.input, "centerline");
  add_report(verb, arguments.report, arguments.format);
  verb.add_option("--plot", arguments.plot, "error against time and against vertices, as a picture (.svg)");
  verb.add_option("--samples", arguments.options.samples, "points on each surface and on the vessels")
      ->check(in_range<std::size_t>(1, 10'000'000))
      ->capture_default_str();
  verb.add_option("--threads", arguments.options.generate.threads, "to work on; 0: all")
      ->check(in_range(0, 4096))
      ->capture_default_str();
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  verb.footer(kTradeoffExamples);
}

}  // namespace vmesh::tool
