#include "vmesh/parts/join.h"

#include <iomanip>

#include "vmesh/core/atomic_file.h"
#include "vmesh/io/ply_stream.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/branch_labels.h"

#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/generate_log.h"

namespace vmesh::tool::join_verb {
namespace {

namespace fs = std::filesystem;

struct JoinArguments {
  CommonArguments common;
  std::filesystem::path folder;
  std::filesystem::path output;
  WritingArguments writing;
  int threads = 0;  ///< 0: as many as there are
};

void add_options(CLI::App& verb, JoinArguments& arguments) {
  verb.add_option("DIR", arguments.folder, "folder of the parts")->required()->type_name(kFolder);
  add_output(verb, arguments.output, kSurfaceFile,
             "surface (.ply is written part by part, unless one of the options below is given; .vtm lists the parts, "
             "each a .vtp file; others need memory for the whole)");
  add_writing(verb, arguments.writing);
  add_threads(verb, arguments.threads);
}

/// The attributes of surface_attributes().
std::vector<MeshAttribute> attributes_of(const SurfaceSink::Vertices& vertices) {
  MeshAttribute segment{"segment", {}, true}, parameter{"parameter", {}};
  for (const auto& [s, t] : vertices.place) {
    segment.values.push_back(s);
    parameter.values.push_back(t);
  }
  return {{"radius", {vertices.radius.begin(), vertices.radius.end()}},
          std::move(segment),
          std::move(parameter),
          {"branch", {vertices.branch.begin(), vertices.branch.end()}, true}};
}

std::vector<MeshAttribute> attributes_of(const SurfaceSink::Faces& faces) {
  return {{"EquiangleSkewness", {faces.skewness.begin(), faces.skewness.end()}},
          {"branch", {faces.branch.begin(), faces.branch.end()}, true}};
}

SurfaceMetadata metadata_of(const PartsSource& source) {
  return {source.generator, source.options, source.input_name, source.input_sha256};
}

/// Writes block by block.
class PlySink : public SurfaceSink {
 public:
  PlySink(const fs::path& path, SurfaceMetadata metadata) : path_(path), metadata_(std::move(metadata)) {}

  void begin(std::size_t vertices, std::size_t faces) override {
    MeshAttributes declared{attributes_of(Vertices{}), attributes_of(Faces{})};
    add_for_viewers(".ply", declared.vertex);
    stream_ = std::make_unique<PlyStream>(path_, vertices, faces, declared, metadata_);
  }
  void add(const Vertices& vertices) override {
    std::vector<MeshAttribute> attributes = attributes_of(vertices);
    add_for_viewers(".ply", attributes);
    stream_->add_vertices(vertices.position, vertices.normal, attributes);
  }
  void add(const Faces& faces) override { stream_->add_faces(faces.corners, attributes_of(faces)); }
  void finish() { stream_->commit(); }

 private:
  fs::path path_;
  SurfaceMetadata metadata_;
  std::unique_ptr<PlyStream> stream_;
};

void append(std::vector<MeshAttribute>& whole, std::vector<MeshAttribute> block) {
  if (whole.empty()) {
    whole = std::move(block);
    return;
  }
  for (std::size_t i = 0; i < whole.size(); ++i)
    whole[i].values.insert(whole[i].values.end(), block[i].values.begin(), block[i].values.end());
}

/// Collects everything in memory.
class MemorySink : public SurfaceSink {
 public:
  void begin(std::size_t vertices, std::size_t faces) override {
    mesh.vertices.reserve(vertices);
    mesh.faces.reserve(faces);
  }
  void add(const Vertices& vertices) override {
    mesh.vertices.insert(mesh.vertices.end(), vertices.position.begin(), vertices.position.end());
    append(attributes.vertex, attributes_of(vertices));
  }
  void add(const Faces& faces) override {
    mesh.faces.insert(mesh.faces.end(), faces.corners.begin(), faces.corners.end());
    append(attributes.face, attributes_of(faces));
  }

  TriMesh mesh;
  MeshAttributes attributes;
};

/// Discards the surface: the parts themselves are listed.
class NoSink : public SurfaceSink {
 public:
  void begin(std::size_t, std::size_t) override {}
  void add(const Vertices&) override {}
  void add(const Faces&) override {}
};

int refuse(const JoinArguments& arguments, const JoinSummary& summary, Console& console) {
  std::vector<std::string> lines;
  for (const JoinDefect& defect : summary.defects)
    lines.push_back(std::string(to_string(defect.kind)) + ": " + defect.message);
  log_refusal(
      lines,
      arguments.folder.string() +
          ": the parts do not form a sound surface, nothing is written: grow the whole in one go, which makes pieces "
          "that cross again as one",
      console);
  return kDefective;
}

std::string vtm_text(const std::string& folder, std::size_t parts) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n  <vtkMultiBlockDataSet>\n";
  for (std::size_t p = 0; p < parts; ++p)
    text += "    <DataSet index=\"" + std::to_string(p) + "\" name=\"" + part_name(p) + "\" file=\"" + folder + "/" +
            part_name(p) + ".vtp\"/>\n";
  return text + "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
}

/// Writes a .vtp file for each part, with the vertices of its seams, in a folder beside the list.
void write_list(const JoinArguments& arguments, const JoinSummary& summary) {
  if (summary.walls_parted > 0)
    throw Unsupported(arguments.output.string() +
                      ": walls of different parts were parted from each other; write the whole, as .ply");
  const fs::path folder = fs::path(arguments.output).replace_extension();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw WriteError(folder.string() + ": cannot be made a folder for the parts");
  for (std::size_t p = 0; p < summary.manifest.parts; ++p) {
    const StoredPartSurface part = read_part_surface(arguments.folder / (part_name(p) + kPartSurfaceExtension));
    const PartSurface& surface = part.surface;
    std::vector<Index> label;
    for (const auto& [a, b, c] : surface.mesh.faces)
      label.push_back(label_of_face(part.branch[a], part.branch[b], part.branch[c]));
    const std::vector<double> skewness = equiangle_skewness(surface.mesh);
    MeshAttributes attributes{
        attributes_of(SurfaceSink::Vertices{surface.mesh.vertices, {}, surface.radius, part.place, part.branch}),
        attributes_of(SurfaceSink::Faces{surface.mesh.faces, skewness, label})};
    write_surface(folder / (part_name(p) + ".vtp"), surface.mesh, std::move(attributes),
                  metadata_of(summary.manifest.source), arguments.writing);
  }
  write_text(arguments.output, vtm_text(folder.filename().string(), summary.manifest.parts));
}

void write_summary(const fs::path& path, const fs::path& output, const JoinSummary& summary) {
  const PartsManifest& manifest = summary.manifest;
  Json json = {{"schema", "vmesh.join/1"},
               {"generator", generator_json()},
               {"input", {{"file", manifest.source.input_name}, {"sha256", manifest.source.input_sha256}}},
               {"output", output.filename().string()},
               {"options", manifest.source.options},
               {"parts", manifest.parts},
               {"vertices", summary.vertices},
               {"faces", summary.faces},
               {"topology",
                {{"euler_characteristic", summary.euler_characteristic},
                 {"expected_components", summary.growth.components},
                 {"expected_genus", summary.growth.cycle_rank}}},
               {"skewness", {{"mean", summary.mean_skewness}, {"max", summary.max_skewness}}},
               {"walls_parted", summary.walls_parted},
               {"growth", to_json(summary.growth)}};
  write_json(path, json);
}

void check_arguments(const JoinArguments& arguments) {
  const fs::path manifest = arguments.folder / kManifestName;
  check_outputs({{arguments.common.json, PlannedOutput::Kind::summary}}, {manifest});
  const bool lists_parts = extension_of(arguments.output) == ".vtm";
  check_writing(lists_parts ? "part.vtp" : arguments.output, arguments.writing);
  if (lists_parts) {
    check_can_be_written(arguments.output);
  } else {
    check_outputs({{arguments.output, PlannedOutput::Kind::surface}}, {manifest});
  }
}

int run(const JoinArguments& arguments, Console& console) {
  check_arguments(arguments);
  const std::string extension = extension_of(arguments.output);
  const SurfaceMetadata metadata = metadata_of(read_manifest(arguments.folder / kManifestName).source);
  PlySink file(arguments.output, metadata);
  MemorySink memory;
  NoSink none;
  const bool by_blocks = extension == ".ply" && arguments.writing == WritingArguments{};
  SurfaceSink& sink = by_blocks             ? static_cast<SurfaceSink&>(file)
                      : extension == ".vtm" ? static_cast<SurfaceSink&>(none)
                                            : static_cast<SurfaceSink&>(memory);
  const JoinSummary summary = join_parts(arguments.folder, sink, arguments.threads, console.progress());
  if (!summary.is_sound()) return refuse(arguments, summary, console);
  if (by_blocks) {
    file.finish();
  } else if (extension == ".vtm") {
    write_list(arguments, summary);
  } else {
    write_surface(arguments.output, memory.mesh, std::move(memory.attributes), metadata, arguments.writing);
  }
  std::ostringstream line;
  line << "wrote " << arguments.output.string() << ": " << summary.vertices << " vertices, " << summary.faces
       << " faces, skewness " << std::setprecision(3) << summary.mean_skewness << " mean, " << summary.max_skewness
       << " max";
  console.log(line.str());
  write_summary(arguments.common.json, arguments.output, summary);
  return kOk;
}

const VerbRegistration<JoinArguments> kRegistration({
    .rank = 160,
    .name = "join",
    .help = "Join the surfaces of parts into the whole",
    .examples = R"(Examples:
  vmesh join parts -o brain.ply
  vmesh join parts -o brain.vtm --json summary.json)",
    .add_options = add_options,
    .settle = settle_output,
    .threads = [](const JoinArguments& arguments) { return arguments.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::join_verb
