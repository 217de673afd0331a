#include "verbs/part.h"

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/text.h"
#include "vmesh/parts/part_files.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/generate_log.h"
#include "report/summary.h"

namespace vmesh::tool {
namespace {

/// A part contains the options with which it is grown.
void check_arguments(const GenerateArguments& arguments) {
  GenerateArguments plain;
  plain.input = arguments.input;
  if (!arguments.input.more.empty())
    throw UsageError(arguments.input.more.front().string() + ": parts are grown one at a time");
  if (describe(arguments) != describe(plain) || arguments.budget || !arguments.fitting.reference.path.empty() ||
      arguments.writing.encoding != SurfaceEncoding::usual || arguments.bones || arguments.check ||
      arguments.allow_defects || !arguments.common.html.empty() || !arguments.centerline_output.empty())
    throw UsageError(arguments.input.path.string() +
                     ": a part is grown with the options given to vmesh split; only --threads, --json and "
                     "--quiet apply");
  if (extension_of(arguments.output) != kPartSurfaceExtension)
    throw UsageError(arguments.output.string() + ": the surface of a part is written as " + kPartSurfaceExtension +
                     "; vmesh join makes other formats of them");
  check_outputs({{arguments.common.json, PlannedOutput::Kind::summary}}, {arguments.input.path});
  check_can_be_written(arguments.output);
}

std::string at(const Vec3& p) { return formatted("(%g, %g, %g)", p.x(), p.y(), p.z()); }

std::string words(const PieceFault& fault) {
  const char* what = fault.vessels_overlap                      ? "vessels overlap"
                     : fault.kind == DefectKind::crossing_faces ? "faces cross"
                     : fault.kind == DefectKind::bad_triangle   ? "a triangle is nearly degenerate"
                                                                : "a node of the centerline is not inside";
  return what + (" at " + at(fault.position));
}

std::vector<std::string> faults_of(const PartSurface& surface) {
  std::vector<std::string> faults;
  for (const PartSurface::Piece& piece : surface.pieces) {
    for (const PieceFault& fault : piece.faults) faults.push_back(words(fault));
  }
  return faults;
}

void write_summary(const GenerateArguments& arguments, const PartSurface& surface,
                   const std::vector<StageTime>& stages) {
  std::vector<std::size_t> rungs(kRungs, 0);
  double worst = 0;
  for (const PartSurface::Piece& piece : surface.pieces) {
    ++rungs[piece.rung];
    worst = std::max(worst, piece.worst_skewness);
  }
  Json json = {{"schema", "vmesh.part-summary/1"},
               {"generator", generator_json()},
               {"input", arguments.input.path.filename().string()},
               {"output", arguments.output.filename().string()},
               {"vertices", surface.mesh.vertices.size()},
               {"faces", surface.mesh.faces.size()},
               {"pieces", surface.pieces.size()},
               {"pieces_by_rung", rungs},
               {"walls_that_cross", surface.crossings.size()},
               {"max_skewness", worst}};
  for (const auto& [stage, seconds] : stages) json["seconds"][stage] = seconds;
  write_json(arguments.common.json, json);
}

}  // namespace

bool is_part(const std::filesystem::path& path) { return extension_of(path) == kPartExtension; }

int run_part(const GenerateArguments& arguments, Console& console) {
  check_arguments(arguments);
  Stopwatch watch;
  std::vector<StageTime> stages;
  const StoredPart part = read_part(arguments.input.path);
  stages.push_back({"read", watch.lap()});
  stop_if_interrupted();
  PartSurface surface = naming(arguments.input.path, [&] {
    return grow_part(part.part, arguments.production.growth.threads, console.progress());
  });
  stages.push_back({"grow", watch.lap()});
  if (const std::vector<std::string> faults = faults_of(surface); !faults.empty()) {
    log_refusal(faults,
                arguments.input.path.string() +
                    ": no sound surface was found, nothing is written: check the radii and nodes there, or grow the "
                    "whole in one go, which may merge pieces",
                console);
    return kDefective;
  }
  const StoredPartSurface stored = refer_to_read(part, std::move(surface));
  write_part_surface(arguments.output, stored);
  stages.push_back({"write", watch.lap()});
  console.log("wrote " + arguments.output.string() + ": " + std::to_string(stored.surface.mesh.faces.size()) +
              " faces");
  write_summary(arguments, stored.surface, stages);
  return kOk;
}

}  // namespace vmesh::tool
