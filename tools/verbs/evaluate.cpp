#include <tbb/task_arena.h>

#include "vmesh/io/sha256.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "report/evaluation_report.h"
#include "report/pages.h"
#include "report/report_output.h"
#include "report/requirements.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

/// The inputs of a comparison, loaded.
struct Comparison {
  LoadedSurface surface;
  std::optional<LoadedSurface> reference;
  std::optional<Centerline> centerline;
};

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

Comparison load(const EvaluateArguments& arguments, std::vector<std::string>& warnings) {
  Comparison comparison;
  comparison.surface = load_surface(arguments.input);
  append(warnings, comparison.surface.warnings);
  if (!arguments.reference.path.empty()) {
    comparison.reference = load_surface(arguments.reference);
    append(warnings, comparison.reference->warnings);
  }
  if (!arguments.centerline.path.empty()) {
    CleanedCenterline cleaned = clean(load_raw_centerline(arguments.centerline, warnings));
    comparison.centerline = std::move(cleaned.centerline);
  }
  return comparison;
}

EvaluationReport measure_surface_alone(const TriMesh& mesh) {
  EvaluationReport report;
  report.vertices = mesh.vertices.size();
  report.faces = mesh.faces.size();
  report.area_mm2 = surface_area(mesh);
  report.measures = measure_faces(mesh);
  report.defects = find_defects(mesh);
  if (report.defects.topology.closed && report.defects.topology.oriented) report.volume_mm3 = enclosed_volume(mesh);
  return report;
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

/// Adds the file's name to errors about the surface.
ClosestPointIndex index_of(const TriMesh& mesh, const std::filesystem::path& path) {
  try {
    return ClosestPointIndex(mesh);
  } catch (const InvalidInput& error) {
    throw InvalidInput(path.string() + ": " + error.what());
  }
}

/// The reference and the volume, each with its search structure.
class Evaluation {
 public:
  Evaluation(const EvaluateArguments& arguments, const Comparison& comparison)
      : arguments_(arguments),
        mesh_(comparison.surface.mesh),
        comparison_(comparison),
        index_(index_of(mesh_, arguments.input.path)) {
    if (comparison.reference) reference_index_ = index_of(comparison.reference->mesh, arguments.reference.path);
    if (comparison.centerline) field_.emplace(*comparison.centerline);
  }

  EvaluationReport measure(const Progress& progress) const {
    EvaluationReport report = measure_surface_alone(mesh_);
    stop_if_interrupted();
    if (comparison_.reference) {
      report.reference = compare(mesh_, index_, comparison_.reference->mesh, *reference_index_, arguments_, progress);
      stop_if_interrupted();
    }
    if (field_) {
      report.volume = VolumeComparison{arguments_.centerline.path.string(),
                                       measure_vessel_distance(mesh_, index_, *field_, arguments_.samples, progress)};
    }
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
  const EvaluateArguments& arguments_;
  const TriMesh& mesh_;
  const Comparison& comparison_;
  ClosestPointIndex index_;
  std::optional<ClosestPointIndex> reference_index_;
  std::optional<VesselField> field_;
};

void check_files(const EvaluateArguments& arguments) {
  std::vector<std::filesystem::path> inputs;
  for (const InputArguments* input : {&arguments.input, &arguments.reference, &arguments.centerline}) {
    if (input->path.empty()) continue;
    for (const std::filesystem::path& file : files_of(input->path)) inputs.push_back(file);
  }
  check_outputs({{arguments.output, PlannedOutput::Kind::surface},
                 {arguments.common.json, PlannedOutput::Kind::summary},
                 {arguments.common.html, PlannedOutput::Kind::page},
                 {arguments.report, PlannedOutput::Kind::report}},
                inputs);
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
  report.sha256 = sha256_of_file(arguments.input.path);
  report.warnings = warnings;
  for (const Requirement& requirement : requirements) {
    report.requirements.push_back(check_requirement(requirement, report));
  }
  stop_if_interrupted();
  if (!arguments.output.empty()) {
    write_surface(arguments.output, comparison.surface.mesh, evaluation.attributes(report.measures),
                  metadata_of(arguments, report.sha256));
    console.log("wrote " + arguments.output.string());
  }
  if (!arguments.common.html.empty()) {
    const TriMesh* reference = comparison.reference ? &comparison.reference->mesh : nullptr;
    const Centerline* centerline = comparison.centerline ? &*comparison.centerline : nullptr;
    write_page(arguments.common.html,
               page_of(arguments, report, comparison.surface.mesh, evaluation.attributes(report.measures), reference,
                       centerline),
               console);
  }
  write_report(to_tables(report), to_json(report), {arguments.format, arguments.common.json, arguments.report});
  return check(report, console);
}

}  // namespace

int run(const EvaluateArguments& arguments, Console& console) {
  tbb::task_arena arena(arguments.threads > 0 ? arguments.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return evaluate(arguments, console); });
}

}  // namespace vmesh::tool
