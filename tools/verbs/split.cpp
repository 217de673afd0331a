#include "vmesh/core/atomic_file.h"
#include "vmesh/io/sha256.h"
#include "vmesh/parts/part_files.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/generate_log.h"
#include "report/summary.h"
#include "verbs/part_origins.h"
#include "verbs/prepared_centerline.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

namespace fs = std::filesystem;

bool is_ours(const fs::path& path) {
  const std::string name = path.filename().string(), extension = extension_of(path);
  return name.starts_with("part_") && (extension == kPartExtension || extension == kPartSurfaceExtension);
}

/// An empty folder, or one that held parts: these go, as they would not fit to the new ones.
void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw WriteError(folder.string() + ": cannot be made a folder for the parts");
  check_can_be_written(folder / kManifestName);
  if (!fs::exists(folder / kManifestName)) {
    if (!fs::is_empty(folder))
      throw UsageError(folder.string() + ": is not empty, and no parts are in it; name a folder of their own");
    return;
  }
  fs::remove(folder / kManifestName, error);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_ours(entry.path())) fs::remove(entry.path(), error);
  }
}

void write_summary(const fs::path& path, const PartsManifest& manifest, const std::vector<StageTime>& stages) {
  Json json = {{"schema", "vmesh.split/1"},
               {"generator", generator_json()},
               {"input", {{"file", manifest.source.input_name}, {"sha256", manifest.source.input_sha256}}},
               {"options", manifest.source.options},
               {"id", manifest.id},
               {"parts", manifest.parts},
               {"pieces", manifest.pieces},
               {"seams", manifest.seams},
               {"expected_vertices", manifest.expected_vertices}};
  for (const auto& [stage, seconds] : stages) json["seconds"][stage] = seconds;
  write_json(path, json);
}

}  // namespace

int run(const SplitArguments& given, Console& console) {
  GenerateArguments arguments = given.generate;
  arguments.input = given.input;
  if (is_image(given.input.path))
    throw UsageError(given.input.path.string() + ": is an image; extract a centerline first: vmesh centerline " +
                     given.input.path.string() + " -o centerline.swc");
  prepare_folder(given.output);
  check_outputs({{given.common.json, PlannedOutput::Kind::summary}}, files_of(given.input));
  Stopwatch watch;
  std::vector<StageTime> stages;
  const LoadedCenterline loaded = load_clean_centerline(given.input, console);
  PartsManifest manifest;
  manifest.source = {generator_name(), describe(arguments), file_name_of(given.input), sha256_of(given.input)};
  manifest.id = vmesh::sha256_of(manifest.source.generator + "\n" + manifest.source.options + "\n" +
                                 manifest.source.input_sha256 + "\n" + std::to_string(given.vertices));
  stages.push_back({"read", watch.lap()});
  stop_if_interrupted();

  GenerateReport report;
  report.arguments = &arguments;
  report.cleaned = &loaded.cleaned;
  const PreparedCenterline prepared = prepare_centerline(report, console);
  const SplitCenterline centerline(prepared, arguments.options);
  stages.push_back({"prepare", watch.lap()});
  stop_if_interrupted();

  const SplitSummary summary = naming(given.input.path, [&] {
    return split_surface(
        centerline.centerline(), centerline.options(), given.vertices,
        [&](SurfacePart part) {
          StoredPart stored{manifest.id, std::move(part), {}};
          stored.origins = centerline.origins_of(stored.part.field.node, stored.part.field.cone);
          write_part(given.output / (part_name(manifest.parts++) + kPartExtension), stored);
        },
        console.progress());
  });
  manifest.pieces = summary.pieces;
  manifest.seams = summary.seams;
  manifest.around = static_cast<Index>(summary.options.around);
  manifest.components = summary.components;
  manifest.cycle_rank = summary.cycle_rank;
  manifest.expected_vertices = summary.expected_vertices;
  for (GrowthSimplification note : summary.simplifications) {
    const std::vector<Index> nodes = note.nodes, segments = note.segments;
    const ConeOrigins origins = centerline.origins_of(nodes, segments);
    for (Index i = 0; i < nodes.size(); ++i) note.nodes[i] = i;
    for (Index i = 0; i < segments.size(); ++i) note.segments[i] = i;
    origins.refer_to_original(note);
    manifest.simplifications.push_back(std::move(note));
  }
  write_manifest(given.output / kManifestName, manifest);
  stages.push_back({"split", watch.lap()});
  console.log("wrote " + std::to_string(manifest.parts) + " parts, " + std::to_string(manifest.pieces) +
              " pieces, to " + given.output.string());
  if (!given.common.json.empty()) write_summary(given.common.json, manifest, stages);
  return kOk;
}

}  // namespace vmesh::tool
