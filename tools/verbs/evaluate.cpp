#include <exception>
#include <functional>
#include <optional>

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include "vmesh/io/sha256.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/evaluation_report.h"
#include "report/pages.h"
#include "report/requirements.h"

namespace vmesh::tool::evaluate_verb {
namespace {

struct EvaluateArguments {
  CommonArguments common;
  InputArguments input;
  InputArguments reference;      ///< surface to compare with; empty path: none
  InputArguments centerline;     ///< whose volume to compare with; empty path: none
  std::filesystem::path output;  ///< the surface with distances and skewness; empty: none
  WritingArguments writing;
  ReportArguments report;
  std::string require;         ///< see parse_requirements()
  double tolerance_mm = 1e-4;  ///< of the Hausdorff distance
  std::size_t samples = 100'000;
  int threads = 0;  ///< 0: as many as there are
};

void add_options(CLI::App& verb, EvaluateArguments& arguments) {
  add_input(verb, arguments.input, "surface");
  verb.add_option(
      "--reference", arguments.reference.path,
      "surface to compare with: guaranteed Hausdorff distance, mean, RMS and percentiles, in both directions");
  add_reading(verb, arguments.reference, "reference-");
  verb.add_option("--centerline", arguments.centerline.path,
                  "compare with the exact volume of its round cones, in both directions, in mm and in local radii");
  add_reading(verb, arguments.centerline, "centerline-");
  add_centerline_reading(verb, arguments.centerline, "centerline-");
  verb.add_option("-o,--output", arguments.output,
                  "the surface with the skewness of its faces, and its vertices' distance to the reference and "
                  "volume_distance (.ply, .vtp)")
      ->type_name(kSurfaceFile);
  add_writing(verb, arguments.writing);
  add_report(verb, arguments.report);
  add_measuring(verb, arguments.tolerance_mm, arguments.samples);
  add_threads(verb, arguments.threads);
  verb.add_option("--require", arguments.require,
                  "exit with 1 unless all of these hold, separated by commas: " + describe_requirements())
      ->type_name("LIST");
  add_html(verb, arguments.common);
}

/// The inputs of a comparison, loaded.
struct Comparison {
  LoadedSurface surface;
  std::optional<LoadedSurface> reference;
  std::optional<Centerline> centerline;
};

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Calls all of them side by side. If some throw, the error of the first in this order is thrown.
void do_all(const std::vector<std::function<void()>>& work) {
  std::vector<std::exception_ptr> errors(work.size());
  tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t i) {
    try {
      work[i]();
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

Comparison load(const EvaluateArguments& arguments, std::vector<std::string>& warnings) {
  Comparison comparison;
  std::vector<std::string> of_centerline;
  do_all({[&] { comparison.surface = load_surface(arguments.input); },
          [&] {
            if (!arguments.reference.path.empty()) comparison.reference = load_surface(arguments.reference);
          },
          [&] {
            if (arguments.centerline.path.empty()) return;
            comparison.centerline = clean(load_raw_centerline(arguments.centerline, of_centerline)).centerline;
          }});
  append(warnings, comparison.surface.warnings);
  if (comparison.reference) append(warnings, comparison.reference->warnings);
  append(warnings, of_centerline);
  return comparison;
}

void measure_surface_alone(const TriMesh& mesh, EvaluationReport& report) {
  report.vertices = mesh.vertices.size();
  report.faces = mesh.faces.size();
  report.area_mm2 = surface_area(mesh);
  report.measures = measure_faces(mesh);
  tbb::parallel_invoke([&] { report.measure_summaries = summarize_measures(report.measures); },
                       [&] { report.defects = find_defects(mesh); });
  if (report.defects.topology.closed && report.defects.topology.oriented) report.volume_mm3 = enclosed_volume(mesh);
}

ReferenceComparison compare(const TriMesh& mesh, const ClosestPointIndex& index, const TriMesh& reference,
                            const ClosestPointIndex& reference_index, const EvaluateArguments& arguments,
                            const Progress& progress) {
  ReferenceComparison result;
  result.file = arguments.reference.path.string();
  result.faces = reference.faces.size();
  result.tolerance_mm = arguments.tolerance_mm;
  result.hausdorff = hausdorff(mesh, reference, {arguments.tolerance_mm, progress});
  result.forward = sample_distance(mesh, reference_index, arguments.samples, progress);
  result.backward = sample_distance(reference, index, arguments.samples, progress);
  return result;
}

void replace(std::vector<MeshAttribute>& attributes, MeshAttribute attribute) {
  std::erase_if(attributes, [&](const MeshAttribute& old) { return old.name == attribute.name; });
  attributes.push_back(std::move(attribute));
}

SurfaceMetadata metadata_of(const EvaluateArguments& arguments, const std::string& sha256) {
  std::string options = "evaluate";
  if (!arguments.reference.path.empty()) options += " --reference " + arguments.reference.path.filename().string();
  if (!arguments.centerline.path.empty()) options += " --centerline " + arguments.centerline.path.filename().string();
  return {generator_name(), options, arguments.input.path.filename().string(), sha256};
}

ClosestPointIndex index_of(const TriMesh& mesh, const std::filesystem::path& path) {
  return naming(path, [&] { return ClosestPointIndex(mesh); });
}

/// The reference and the volume, each with its search structure.
class Evaluation {
 public:
  Evaluation(const EvaluateArguments& arguments, const Comparison& comparison)
      : arguments_(arguments), mesh_(comparison.surface.mesh), comparison_(comparison) {
    do_all({[&] { index_ = index_of(mesh_, arguments.input.path); },
            [&] {
              if (comparison.reference)
                reference_index_ = index_of(comparison.reference->mesh, arguments.reference.path);
            },
            [&] {
              if (comparison.centerline) field_.emplace(*comparison.centerline);
            }});
  }

  // Much of it is serial by itself: what does not depend on each other is done side by side.
  EvaluationReport measure(const Progress& progress) const {
    EvaluationReport report;
    do_all({[&] { measure_surface_alone(mesh_, report); }, [&] { compare_with_others(report, progress); },
            [&] { report.sha256 = sha256_of_file(arguments_.input.path); }});
    stop_if_interrupted();
    return report;
  }

  /// The attributes of the surface's file, plus skewness and distances.
  MeshAttributes attributes(const FaceMeasures& measures) const {
    MeshAttributes attributes = comparison_.surface.attributes;
    replace(attributes.face, {"EquiangleSkewness", measures.equiangle_skewness});
    if (reference_index_) replace(attributes.vertex, {"distance", vertex_distances(mesh_, *reference_index_)});
    if (field_) replace(attributes.vertex, {"volume_distance", vertex_vessel_distances(mesh_, *field_)});
    return attributes;
  }

 private:
  void compare_with_others(EvaluationReport& report, const Progress& progress) const {
    if (comparison_.reference) {
      report.reference = compare(mesh_, *index_, comparison_.reference->mesh, *reference_index_, arguments_, progress);
      stop_if_interrupted();
    }
    if (field_) {
      report.volume = VolumeComparison{arguments_.centerline.path.string(),
                                       measure_vessel_distance(mesh_, *index_, *field_, arguments_.samples, progress)};
    }
  }

  const EvaluateArguments& arguments_;
  const TriMesh& mesh_;
  const Comparison& comparison_;
  std::optional<ClosestPointIndex> index_, reference_index_;
  std::optional<VesselField> field_;
};

void check_files(const EvaluateArguments& arguments) {
  if (!arguments.output.empty()) {
    check_writing(arguments.output, arguments.writing);
  } else if (arguments.writing != WritingArguments{}) {
    throw UsageError("how to write the surface was given, but not where; add -o FILE");
  }
  check_outputs({{arguments.output, PlannedOutput::Kind::surface},
                 {arguments.common.json, PlannedOutput::Kind::summary},
                 {arguments.common.html, PlannedOutput::Kind::page},
                 {arguments.report.file, PlannedOutput::Kind::report}},
                files_of({&arguments.input, &arguments.reference, &arguments.centerline}));
}

int check(const EvaluationReport& report, Console& console) {
  bool all_met = true;
  for (const CheckedRequirement& requirement : report.requirements) {
    if (requirement.met) continue;
    all_met = false;
    console.error("requirement not met: " + requirement.text + "; found " + requirement.found);
  }
  return all_met ? kOk : kCheckFailed;
}

int evaluate(const EvaluateArguments& arguments, Console& console) {
  const std::vector<Requirement> requirements = parse_requirements(arguments.require);
  check_requirements_can_be_checked(requirements, !arguments.reference.path.empty(),
                                    !arguments.centerline.path.empty());
  check_files(arguments);
  std::vector<std::string> warnings;
  const Comparison comparison = load(arguments, warnings);
  console.warn(warnings);
  stop_if_interrupted();

  const Evaluation evaluation(arguments, comparison);
  EvaluationReport report = evaluation.measure(console.progress());
  report.file = arguments.input.path.string();
  report.warnings = warnings;
  for (const Requirement& requirement : requirements) {
    report.requirements.push_back(check_requirement(requirement, report));
  }
  stop_if_interrupted();
  if (!arguments.output.empty()) {
    write_surface(arguments.output, comparison.surface.mesh, evaluation.attributes(report.measures),
                  metadata_of(arguments, report.sha256), arguments.writing);
    console.log("wrote " + arguments.output.string());
  }
  if (!arguments.common.html.empty()) {
    const TriMesh* reference = comparison.reference ? &comparison.reference->mesh : nullptr;
    const Centerline* centerline = comparison.centerline ? &*comparison.centerline : nullptr;
    write_page(arguments.common.html,
               page_of(arguments.common, report, comparison.surface.mesh, evaluation.attributes(report.measures),
                       reference, centerline),
               console);
  }
  write_report(to_tables(report), to_json(report), arguments.report, arguments.common.json);
  return check(report, console);
}

int run(const EvaluateArguments& arguments, Console& console) {
  tbb::task_arena arena(arguments.threads > 0 ? arguments.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return evaluate(arguments, console); });
}

const VerbRegistration<EvaluateArguments> kRegistration({
    .rank = 60,
    .name = "evaluate",
    .help = "Measure a surface: faces, defects, distance to a reference surface or to a centerline's vessels",
    .examples = R"(Examples:
  vmesh evaluate tree.ply
  vmesh evaluate tree.ply --reference scan.stl --report report.md --json report.json -o colored.ply
  vmesh evaluate tree.ply --reference scan.stl --centerline tree.swc --html tree.html
  vmesh evaluate tree.ply --centerline tree.swc --require closed,max-skewness=0.9,relative-volume-distance=0.5)",
    .add_options = add_options,
    .threads = [](const EvaluateArguments& arguments) { return arguments.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::evaluate_verb
