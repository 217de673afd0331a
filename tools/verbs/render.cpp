#include "vmesh/render/render.h"

#include <utility>

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"

namespace vmesh::tool::render_verb {
namespace {

struct RenderArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  RenderOptions options;
  int threads = 0;    ///< 0: as many as there are
  std::string color;  ///< attribute to colour by, or "skewness"; empty: one colour
};

void add_render_view(CLI::App& verb, RenderOptions& options) {
  add_number(verb, "--width", options.width, 16, 16384, "pixels");
  add_number(verb, "--height", options.height, 16, 16384, "pixels");
  add_read_option(
      verb, "--view", [&options](const std::string& text) { options.view = view_direction(text); },
      "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees")
      .type_name("VIEW");
  verb.add_option_function<std::string>(
          "--look-at",
          [&options](const std::string& text) {
            const std::vector<double> p = parse_numbers("--look-at", text, 3);
            options.look_at = Vec3(p[0], p[1], p[2]);
          },
          "point at the centre of the picture, mm; default: the centre of the mesh")
      ->type_name("X,Y,Z");
  add_number(verb, "--view-height", options.view_height_mm, 0.0, 1e9,
             "height of the scene in the picture, mm; 0: the whole mesh");
  add_number(verb, "--zoom", options.zoom, 1e-3, 1e6, "magnification");
  add_number(verb, "--field-of-view", options.field_of_view_deg, 0.0, 119.0, "degrees; 0: orthographic");
}

void add_render_look(CLI::App& verb, RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  verb.add_flag("--edges", options.edges, "draw the triangles' edges");
  add_number(verb, "--edge-width", options.edge_width_px, 0.01, 100.0, "pixels");
  verb.add_flag("!--flat", options.smooth, "shade facet by facet");
  verb.add_flag("!--no-back-faces", options.highlight_back_faces,
                "do not highlight the inside of the surface in magenta");
  verb.add_flag("!--no-legend", options.legend, "omit the colour scale or the list of categories");
  add_number(verb, "--occlusion", options.occlusion, 0.0, 1.0, "darkening where little ambient light arrives");
  verb.add_option("--color", arguments.color,
                  "colour by this attribute of the file, or by skewness; integers (branch, segment): a colour for each")
      ->type_name("NAME");
  verb.add_option_function<std::string>(
          "--range",
          [&options](const std::string& text) {
            const std::vector<double> ends = parse_numbers("--range", text, 2);
            options.range = std::pair(ends[0], ends[1]);
          },
          "attribute values at the ends of the colour scale, which integers then have too")
      ->type_name("A,B");
}

void add_options(CLI::App& verb, RenderArguments& arguments) {
  add_input(verb, arguments.input, "surface");
  add_output(verb, arguments.output, "FILE.png", "picture (.png)");
  add_render_view(verb, arguments.options);
  add_render_look(verb, arguments);
  add_threads(verb, arguments.threads);
  group(verb, "How to read the input", {"--unit", "--space"});
  group(verb, "View", {"--width", "--height", "--view", "--look-at", "--view-height", "--zoom", "--field-of-view"});
  group(verb, "Look",
        {"--edges", "--edge-width", "--flat", "--no-back-faces", "--no-legend", "--occlusion", "--color", "--range"});
}

Image draw(const LoadedSurface& surface, const RenderArguments& arguments, const Progress& progress) {
  if (arguments.color.empty()) return render(surface.mesh, arguments.options, progress);
  return render(surface.mesh, surface.attributes, arguments.color, arguments.options, progress);
}

int run(const RenderArguments& arguments, Console& console) {
  check_outputs({{arguments.output, PlannedOutput::Kind::picture}}, files_of(arguments.input.path));
  const LoadedSurface surface = load_surface(arguments.input);
  console.warn(surface.warnings);
  const Image image = draw(surface, arguments, console.progress());
  stop_if_interrupted();
  write_png(arguments.output, image);
  console.log("wrote " + arguments.output.string());
  return kOk;
}

const VerbRegistration<RenderArguments> kRegistration({
    .rank = 50,
    .name = "render",
    .help = "Draw a surface; needs no display",
    .examples = R"(Examples:
  vmesh render tree.ply -o tree.png
  vmesh render tree.ply -o tree.png --edges --color radius --view left --width 1200 --height 900)",
    .with_json = false,
    .add_options = add_options,
    .settle = settle_output,
    .threads = [](const RenderArguments& arguments) { return arguments.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::render_verb
