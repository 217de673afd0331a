#include "vmesh/comparison/method_comparison.h"
#include "vmesh/comparison/paper_table.h"
#include "vmesh/io/sha256.h"
#include "vmesh/synth/synthetic_tree.h"

#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/pages.h"
#include "report/table2_report.h"

namespace vmesh::tool::table2_verb {
namespace {

struct Table2Arguments {
  CommonArguments common;
  InputArguments reference;     ///< image or surface; empty path: the sampled volume of the centerline
  InputArguments centerline;    ///< empty path: extracted from the reference; without one, the synthetic tree
  ReferenceOptions image;       ///< how an image becomes the reference
  bool all_components = false;  ///< of the reference
  std::optional<double> voxel;  ///< of the sampled volume, mm; not given: as many vertices as the paper has
  ExtractOptions extraction;
  MethodOptions methods;
  std::filesystem::path surfaces;  ///< folder for them; empty: none
  ReportArguments report;
  bool check = false;  ///< exit code 1 unless all demands are met
};

void add_options(CLI::App& verb, Table2Arguments& arguments) {
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
  add_number(verb, "--sides", arguments.methods.sides, 3, 1000, "of a cone");
  add_measuring(verb, arguments.methods.tolerance, arguments.methods.samples);
  add_report(verb, arguments.report);
  verb.add_option("--surfaces", arguments.surfaces,
                  "folder for reference.ply, cones.ply, low.ply and high.ply with distances (the reference's: to low), "
                  "and centerline.json")
      ->type_name(kFolder);
  verb.add_flag("--check", arguments.check, "exit with 1 unless the low resolution meets all requirements");
  add_html(verb, arguments.common);
}

// With it, marching cubes of the synthetic tree has about as many vertices as in the paper.
constexpr double kVoxel = 0.665;

struct SurfaceFile {
  SurfaceMethod method;
  const char* name;
};
constexpr SurfaceFile kSurfaceFiles[] = {{SurfaceMethod::marching_cubes, "reference.ply"},
                                         {SurfaceMethod::truncated_cones, "cones.ply"},
                                         {SurfaceMethod::low_resolution, "low.ply"},
                                         {SurfaceMethod::high_resolution, "high.ply"}};
constexpr const char* kCenterlineFile = "centerline.json";

bool has_image(const Table2Arguments& arguments) { return is_image(arguments.reference.path); }

void check_options(const Table2Arguments& arguments) {
  const ReferenceOptions& image = arguments.image;
  const bool has_reference = !arguments.reference.path.empty(), has_centerline = !arguments.centerline.path.empty();
  if (!has_image(arguments) &&
      (!image.labels.empty() || !image.segments.empty() || image.threshold || image.spacing > 0))
    throw UsageError("--label, --threshold and --spacing are for a --reference that is an image");
  if (has_reference && !has_image(arguments) && (image.smooth > 0 || image.binary))
    throw UsageError(arguments.reference.path.string() + ": --smooth and --binary do not apply to a surface");
  if (!has_reference && arguments.all_components)
    throw UsageError("--all-components is for --reference; of a sampled volume all are kept");
  if (has_reference && arguments.voxel)
    throw UsageError("--voxel is for the volume of a centerline; see --spacing for an image");
  const ExtractOptions plain;
  const bool extraction_asked = arguments.extraction.tree || arguments.extraction.spacing != plain.spacing ||
                                arguments.extraction.join != plain.join;
  if ((has_centerline || !has_reference) && extraction_asked)
    throw UsageError("--step, --join and --tree are for a centerline that is extracted from --reference");
}

void check_files(const Table2Arguments& arguments) {
  using Kind = PlannedOutput::Kind;
  std::vector<PlannedOutput> outputs = {{arguments.common.json, Kind::summary},
                                        {arguments.report.file, Kind::report},
                                        {arguments.common.html, Kind::page}};
  if (!arguments.surfaces.empty()) {
    for (const SurfaceFile& file : kSurfaceFiles) outputs.push_back({arguments.surfaces / file.name, Kind::surface});
    outputs.push_back({arguments.surfaces / kCenterlineFile, Kind::centerline});
  }
  check_outputs(outputs, files_of({&arguments.reference, &arguments.centerline}));
}

SourceFile source_file(const std::filesystem::path& path) {
  return path.empty() ? SourceFile{} : SourceFile{path.string(), sha256_of_input(path)};
}

void describe_contour(const ReferenceSurface& surface, Table2Source& source) {
  source.contour_of = surface.binary ? "binary" : "grey";
  source.spacing = surface.spacing;
  source.components = surface.components;
}

/// The reference surface of the vessels, and their centerline.
struct Vessels {
  TriMesh reference;
  Centerline centerline;
  Table2Source source;
};

Vessels sampled_vessels(const Table2Arguments& arguments, Console& console) {
  const bool given = !arguments.centerline.path.empty();
  Centerline centerline =
      given ? load_clean_centerline(arguments.centerline, console).cleaned.centerline : synthetic_tree();
  stop_if_interrupted();
  ReferenceOptions contour = arguments.image;
  contour.all_components = true;  // a twig as thin as a voxel may come apart, but is still a vessel
  ReferenceSurface surface = naming(arguments.centerline.path, [&] {
    return reference_surface(centerline, arguments.voxel.value_or(kVoxel), contour);
  });
  Table2Source source;
  source.vessels = given ? "the volume of " + arguments.centerline.path.string()
                         : "a synthetic portal vein of " + std::to_string(centerline.nodes().size()) + " nodes";
  describe_contour(surface, source);
  return {std::move(surface.mesh), std::move(centerline), std::move(source)};
}

TriMesh load_reference(const Table2Arguments& arguments, Table2Source& source, Console& console) {
  if (!has_image(arguments)) {
    LoadedSurface surface = load_surface(arguments.reference);
    console.warn(surface.warnings);
    return std::move(surface.mesh);
  }
  ReferenceOptions contour = arguments.image;
  contour.all_components = arguments.all_components;
  ReferenceSurface surface = naming(arguments.reference.path, [&] {
    return reference_surface(load_image(arguments.reference, contour, console), contour);
  });
  describe_contour(surface, source);
  return std::move(surface.mesh);
}

Centerline centerline_of(const Table2Arguments& arguments, const TriMesh& reference, Table2Source& source,
                         Console& console) {
  if (!arguments.centerline.path.empty())
    return load_clean_centerline(arguments.centerline, console).cleaned.centerline;
  ExtractOptions options = arguments.extraction;
  options.largest = !arguments.all_components;
  ExtractedCenterline extracted =
      naming(arguments.reference.path, [&] { return extract_centerline(reference, options, console.progress()); });
  source.extraction = extracted.report;
  return std::move(extracted.centerline);
}

Vessels vessels_of(const Table2Arguments& arguments, Console& console) {
  if (arguments.reference.path.empty()) return sampled_vessels(arguments, console);
  Table2Source source;
  source.vessels = arguments.reference.path.string();
  TriMesh reference = load_reference(arguments, source, console);
  stop_if_interrupted();
  Centerline centerline = centerline_of(arguments, reference, source, console);
  return {std::move(reference), std::move(centerline), std::move(source)};
}

std::vector<std::string> warnings_of(const Table2Report& report) {
  std::vector<std::string> warnings;
  for (const MethodRow& row : report.comparison.rows)
    for (const std::string& warning : row.warnings) warnings.push_back(name_of(row) + ": " + warning);
  const std::optional<ExtractionReport>& extraction = report.source.extraction;
  if (extraction && extraction->left_out > 0)
    warnings.push_back(std::to_string(extraction->left_out) + " of " + std::to_string(extraction->components) +
                       " components of the reference have no centerline but count in the distances; --all-components "
                       "keeps them");
  return warnings;
}

Table2Report make_table(const Table2Arguments& arguments, Console& console) {
  Vessels vessels = vessels_of(arguments, console);
  stop_if_interrupted();
  vessels.source.reference = source_file(arguments.reference.path);
  vessels.source.centerline = source_file(arguments.centerline.path);
  const auto& named = arguments.reference.path.empty() ? arguments.centerline.path : arguments.reference.path;
  MethodComparison comparison = naming(named, [&] {
    MethodOptions methods = arguments.methods;
    methods.fitted = !arguments.reference.path.empty();  // without a reference, the vessels are round cones anyway
    methods.paper_growth = true;
    return compare_methods(std::move(vessels.reference), vessels.centerline, methods, console.progress());
  });
  Table2Report report{
      std::move(vessels.source), std::move(vessels.centerline), arguments.methods.tolerance, std::move(comparison), {}};
  report.warnings = warnings_of(report);
  return report;
}

void write_surfaces(const Table2Arguments& arguments, const Table2Report& report) {
  const MethodComparison& comparison = report.comparison;
  const SourceFile& file = report.source.reference.path.empty() ? report.source.centerline : report.source.reference;
  const std::string source = std::filesystem::path(file.path).filename().string();
  const TriMesh& low = comparison.row(SurfaceMethod::low_resolution).mesh;
  const ClosestPointIndex low_index(low), reference_index(comparison.row(SurfaceMethod::marching_cubes).mesh);
  for (const auto& [method, name] : kSurfaceFiles) {
    const MethodRow& row = comparison.row(method);
    MeshAttributes attributes;
    attributes.vertex = {{"distance", vertex_distances(row.mesh, row.distance ? reference_index : low_index)}};
    attributes.face = {{"EquiangleSkewness", equiangle_skewness(row.mesh)}};
    write_surface(arguments.surfaces / name, row.mesh, attributes,
                  {generator_name(), "table2: " + std::string(to_string(method)), source, file.sha256});
  }
  write_centerline(arguments.surfaces / kCenterlineFile, report.centerline,
                   {generator_name(), "table2", source, file.sha256});
}

int check_demands_of(const Table2Report& report, Console& console) {
  bool all_met = true;
  for (const TableDemand& demand : check_demands(report.comparison)) {
    if (demand.met()) continue;
    all_met = false;
    console.error(std::string("not met: ").append(demand.what) + (demand.below ? " below " : " at most ") +
                  format_number(demand.limit) + "; found " + format_number(demand.found));
  }
  return all_met ? kOk : kCheckFailed;
}

int run(const Table2Arguments& arguments, Console& console) {
  check_options(arguments);
  check_files(arguments);
  const Table2Report report = make_table(arguments, console);
  console.warn(report.warnings);
  stop_if_interrupted();
  if (!arguments.surfaces.empty()) write_surfaces(arguments, report);
  if (!arguments.common.html.empty()) write_page(arguments.common.html, page_of(arguments.common, report), console);
  write_report(to_tables(report), to_json(report), arguments.report, arguments.common.json);
  return arguments.check ? check_demands_of(report, console) : kOk;
}

const VerbRegistration<Table2Arguments> kRegistration({
    .rank = 100,
    .name = "table2",
    .help = "Compare marching cubes, truncated cones and both presets as in the paper's Table 2; without a file, on a "
            "synthetic portal vein",
    .examples = R"(Examples:
  vmesh table2
  vmesh table2 --centerline tree.swc --voxel 0.5 --format markdown
  vmesh table2 --reference liver.nii.gz --label 2 --spacing 1 --smooth 0.8 --report table.md --surfaces folder
  vmesh table2 --reference portal.ply --tree)",
    .add_options = add_options,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::table2_verb
