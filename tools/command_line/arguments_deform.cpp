#include "command_line/arguments_common.h"

namespace vmesh::tool {
namespace {

constexpr const char* kDeformExamples = R"(Examples:
  vmesh deform tree.json tree.ply --script scene.json -o frames/
  vmesh deform tree.swc scan.stl --script scene.json -o frames/ --format obj --html moved.html)";
constexpr const char* kTable1Examples = R"(Examples:
  vmesh table1
  vmesh table1 --format markdown --report table1.md --plot trade.svg)";

}  // namespace

void add_deform(CLI::App& app, DeformArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("deform", "Move a centerline under forces, and its surface with it");
  add_input(verb, arguments.input, "centerline");
  add_centerline_reading(verb, arguments.input, "");
  verb.add_option("SURFACE", arguments.surface.path, "surface around it, grown by vmesh or not")->required();
  add_reading(verb, arguments.surface, "surface-");
  verb.add_option("--script", arguments.script, "scene: what is held, dragged and pushed (tools/README.md, Scenes)")
      ->required();
  add_output(verb, arguments.output, "new or empty folder for the frames");
  verb.add_option("--format", arguments.format, "of the frames")
      ->check(CLI::IsMember({"vtp", "obj", "ply", "stl", "off", "glb"}))
      ->capture_default_str();
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  verb.footer(kDeformExamples);
}

void add_table1(CLI::App& app, Table1Arguments& arguments) {
  CLI::App& verb = *app.add_subcommand(
      "table1", "Measure deformation and synchronisation as in the paper's Table 1, on synthetic trees of its sizes");
  add_report(verb, arguments.report, arguments.format);
  verb.add_option("--plot", arguments.plot, "accuracy against time, as a picture (.svg)");
  add_common(verb, arguments.common);
  verb.footer(kTable1Examples);
}

}  // namespace vmesh::tool
