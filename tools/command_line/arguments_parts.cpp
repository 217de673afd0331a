#include "command_line/arguments_common.h"
#include "command_line/outputs.h"

namespace vmesh::tool {
namespace {

constexpr const char* kSplitExamples = R"(Examples:
  vmesh split brain.swc -o parts --vertices 1000000
  for part in parts/part_*.vpart; do vmesh generate $part; done
  vmesh join parts -o brain.ply)";
constexpr const char* kJoinExamples = R"(Examples:
  vmesh join parts -o brain.ply
  vmesh join parts -o brain.vtm --json summary.json)";

}  // namespace

bool is_part(const std::filesystem::path& path) { return extension_of(path) == kPartExtension; }

void add_split(CLI::App& app, SplitArguments& arguments) {
  CLI::App& verb =
      *app.add_subcommand("split", "Divide a surface into self-contained parts before it is grown, for many machines");
  add_centerline_input(verb, arguments.input, "centerline");
  add_output_after_several(verb, arguments.output, "folder for the parts");
  verb.add_option("--vertices", arguments.vertices, "of a part's surface, approximately")
      ->check(in_range(1.0, 1e9))
      ->capture_default_str();
  add_growth(verb, arguments.generate);
  add_common(verb, arguments.common);
  group(verb, "Resolution", {"--around", "--preset", "--max-vertices", "--simplification", "--elongation"});
  group(verb, "Shape", {"--blend", "--placement", "--overlap", "--gap"});
  group(verb, "How it is made", {"--beta", "--max-center-distance", "--sweeps", "--threads"});
  verb.footer(kSplitExamples);
}

void add_join(CLI::App& app, JoinArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("join", "Join the surfaces of parts into the whole");
  verb.add_option("DIR", arguments.folder, "folder of the parts")->required();
  add_output(verb, arguments.output,
             "surface (.ply is written part by part; .vtm lists the parts, each a .vtp file; others need memory for "
             "the whole)");
  verb.add_option("--threads", arguments.threads, "to work on; 0: all; the result does not depend on it")
      ->check(in_range(0, 4096))
      ->capture_default_str();
  add_common(verb, arguments.common);
  verb.footer(kJoinExamples);
}

}  // namespace vmesh::tool
