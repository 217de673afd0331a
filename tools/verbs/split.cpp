#include <numeric>
#include <optional>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/memory.h"
#include "vmesh/io/sha256.h"
#include "vmesh/parts/part_files.h"

#include "command_line/arguments_growth.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/generate_log.h"
#include "verbs/generate_arguments.h"
#include "verbs/part_origins.h"

namespace vmesh::tool::split_verb {
namespace {

namespace fs = std::filesystem;

struct SplitArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;  ///< folder
  double vertices = 1'000'000;   ///< approximate, of a part's surface
  GenerateArguments generate;    ///< its options of growth
};

void add_options(CLI::App& verb, SplitArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline");
  add_output_after_several(verb, arguments.output, kFolder, "folder for the parts");
  add_number(verb, "--vertices", arguments.vertices, 1.0, 1e9, "of a part's surface, approximately");
  add_growth(verb, arguments.generate.production);
  group(verb, "Resolution", {"--around", "--preset", "--max-vertices", "--simplification", "--elongation"});
  group(verb, "Shape", {"--blend", "--placement", "--overlap", "--gap"});
  group(verb, "How it is made", {"--beta", "--max-center-distance", "--sweeps", "--threads"});
}

bool is_ours(const fs::path& path) {
  const std::string name = path.filename().string(), extension = extension_of(path);
  return name.starts_with("part_") && (extension == kPartExtension || extension == kPartSurfaceExtension);
}

/// Throws unless the folder does not exist yet or contains nothing but parts.
void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw WriteError(folder.string() + ": cannot be made a folder for the parts");
  check_can_be_written(folder / kManifestName);
  if (fs::exists(folder / kManifestName)) return;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!is_ours(entry.path()))
      throw UsageError(folder.string() + ": is not empty and contains no parts; give a separate folder");
  }
}

/// Removes parts: old ones would not match new ones, and an incomplete set is useless.
void clear_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove(folder / kManifestName, error);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_ours(entry.path())) fs::remove(entry.path(), error);
  }
}

/// Writes the parts. Returns how they were made.
SplitSummary write_parts(const fs::path& folder, SplitCenterline& centerline, double vertices, const std::string& id,
                         Console& console) {
  std::size_t number = 0;
  const auto write = [&](SurfacePart part) {
    StoredPart stored{id, std::move(part), {}};
    stored.origins = centerline.origins_of(stored.part.field.node, stored.part.field.cone);
    write_part(folder / (part_name(number++) + kPartExtension), stored);
  };
  clear_folder(folder);
  try {
    return split_surface(centerline.take_centerline(), centerline.options(), vertices, write, console.progress());
  } catch (...) {
    clear_folder(folder);
    throw;
  }
}

/// The note in numbers of the centerline that was read.
GrowthSimplification as_read(GrowthSimplification note, const SplitCenterline& centerline) {
  const ConeOrigins origins = centerline.origins_of(note.nodes, note.segments);
  std::iota(note.nodes.begin(), note.nodes.end(), Index{0});
  std::iota(note.segments.begin(), note.segments.end(), Index{0});
  origins.refer_to_original(note);
  return note;
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
  std::optional<LoadedCenterline> loaded = load_clean_centerline(given.input, console);
  release_freed_memory();
  PartsManifest manifest;
  manifest.source = {generator_name(), describe(arguments), file_name_of(given.input), sha256_of(given.input)};
  manifest.id = vmesh::sha256_of(manifest.source.generator + "\n" + manifest.source.options + "\n" +
                                 manifest.source.input_sha256 + "\n" + std::to_string(given.vertices));
  stages.push_back({"read", watch.lap()});
  stop_if_interrupted();

  GenerateReport report;
  report.arguments = &arguments;
  PreparedCenterline prepared = prepare_centerline(loaded->cleaned.centerline, arguments.production.growth,
                                                   arguments.production.preparation, console.progress());
  log_preparation(prepared, report, console);
  const bool is_simplified = prepared.simplified.has_value();
  SplitCenterline centerline(std::move(prepared), arguments.production.growth);
  if (is_simplified) loaded.reset();  // not needed any more, and large
  release_freed_memory();
  stages.push_back({"prepare", watch.lap()});
  stop_if_interrupted();

  const SplitSummary summary = naming(
      given.input.path, [&] { return write_parts(given.output, centerline, given.vertices, manifest.id, console); });
  manifest.parts = summary.parts;
  manifest.pieces = summary.pieces;
  manifest.seams = summary.seams;
  manifest.around = static_cast<Index>(summary.options.around);
  manifest.components = summary.components;
  manifest.cycle_rank = summary.cycle_rank;
  manifest.expected_vertices = summary.expected_vertices;
  for (const GrowthSimplification& note : summary.simplifications)
    manifest.simplifications.push_back(as_read(note, centerline));
  write_manifest(given.output / kManifestName, manifest);
  stages.push_back({"split", watch.lap()});
  console.log("wrote " + std::to_string(manifest.parts) + " parts, " + std::to_string(manifest.pieces) +
              " pieces, to " + given.output.string());
  write_summary(given.common.json, manifest, stages);
  return kOk;
}

const VerbRegistration<SplitArguments> kRegistration({
    .rank = 150,
    .name = "split",
    .help = "Divide a surface into self-contained parts before it is grown, for many machines",
    .examples = R"(Examples:
  vmesh split brain.swc -o parts --vertices 1000000
  for part in parts/part_*.vpart; do vmesh generate $part; done
  vmesh join parts -o brain.ply)",
    .add_options = add_options,
    .settle = settle_output,
    .threads = [](const SplitArguments& arguments) { return arguments.generate.production.growth.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::split_verb
