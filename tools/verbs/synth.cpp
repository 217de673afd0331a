#include "vmesh/io/centerline_io.h"
#include "vmesh/synth/synthetic_tree.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"

namespace vmesh::tool::synth_verb {
namespace {

struct SynthArguments {
  CommonArguments common;
  std::filesystem::path output;
  SyntheticTreeOptions options;
};

void add_options(CLI::App& verb, SynthArguments& arguments) {
  add_output(verb, arguments.output, kCenterlineFile, "centerline");
  add_number(verb, "--vertices", arguments.options.vertices, 2, 10000000, "nodes of the centerline");
  verb.add_option("--seed", arguments.options.seed, "of the random numbers; each gives a different tree")
      ->capture_default_str();
}

int run(const SynthArguments& arguments, Console& console) {
  check_outputs({{arguments.output, PlannedOutput::Kind::centerline}}, {});
  const SyntheticTreeOptions& options = arguments.options;
  const Centerline tree = synthetic_tree(options);
  stop_if_interrupted();
  const std::string how =
      "synth --vertices " + std::to_string(options.vertices) + " --seed " + std::to_string(options.seed);
  write_centerline(arguments.output, tree, {generator_name(), how, "", ""});
  console.log("wrote " + arguments.output.string() + ": " + std::to_string(tree.nodes().size()) + " nodes");
  return kOk;
}

const VerbRegistration<SynthArguments> kRegistration({
    .rank = 30,
    .name = "synth",
    .help = "Make a synthetic tree like a liver's portal vein",
    .examples = R"(Examples:
  vmesh synth -o tree.json
  vmesh synth --vertices 119 --seed 7 -o small.swc)",
    .with_json = false,
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::synth_verb
