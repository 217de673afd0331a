#include "vmesh/io/centerline_io.h"

#include "command_line/exit_code.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "verbs/verbs.h"

namespace vmesh::tool {

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

}  // namespace vmesh::tool
