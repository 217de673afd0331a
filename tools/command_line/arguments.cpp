#include "command_line/arguments.h"

#include <charconv>
#include <iostream>
#include <sstream>

#include "vmesh/core/error.h"
#include "vmesh/core/version.h"

#include "command_line/arguments_common.h"
#include "command_line/arguments_help.h"
#include "command_line/console.h"
#include "command_line/exit_code.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/requirements.h"

namespace vmesh::tool {
namespace {

constexpr const char* kGenerateExamples = R"(Examples:
  vmesh generate tree.swc -o tree.ply
  vmesh generate tree.vtp -o tree.vtp --around 8 --blend 0.8 --json summary.json
  vmesh generate network.csv -o network.stl --unit um --check
  vmesh generate branch-*.mrk.json -o tree.ply
  vmesh generate tree.vtk -o tree.ply --radius-array Thickness
  vmesh generate aorta.pth -o aorta.ply --unit cm --radius 9
  vmesh generate tree.swc -o fine.ply --preset high
  vmesh generate tree.swc -o exact.ply --max-error 5%
  vmesh generate tree.swc -o game.obj --budget vertices=5000
  vmesh generate portal.swc -o portal.ply --fit liver.nii.gz --label 2 --spacing 1 --smooth 1
  vmesh generate liver.nii.gz --label 2 --spacing 1 --smooth 1 --tree -o portal.ply --centerline-output portal.swc
  vmesh generate aorta.vtp -o aorta-flow.vtp --ends flat --flow-extensions 5 --json caps.json
  vmesh generate tree.swc tree.glb --bones
  vmesh generate tree.swc -o tree.ply --html tree.html
  vmesh generate crowded.swc -o crowded.ply --overlap separate --gap 0.2)";
constexpr const char* kInfoExamples = R"(Examples:
  vmesh info tree.swc
  vmesh info tree.ply --json -
  vmesh info liver.nii.gz
  vmesh info tree.ply --check && echo flawless)";
constexpr const char* kSynthExamples = R"(Examples:
  vmesh synth -o tree.json
  vmesh synth --vertices 119 --seed 7 -o small.swc)";
constexpr const char* kConvertExamples = R"(Examples:
  vmesh convert tree.swc -o tree.vtp
  vmesh convert tree.swc -o tree.json --unit um
  vmesh convert tree.ply -o tree.stl
  vmesh convert tree.ply tree.obj --output-unit cm --output-space RAS)";
constexpr const char* kRenderExamples = R"(Examples:
  vmesh render tree.ply -o tree.png
  vmesh render tree.ply -o tree.png --edges --color radius --view left --width 1200 --height 900)";
constexpr const char* kEvaluateExamples = R"(Examples:
  vmesh evaluate tree.ply
  vmesh evaluate tree.ply --reference scan.stl --report report.md --json report.json -o colored.ply
  vmesh evaluate tree.ply --reference scan.stl --centerline tree.swc --html tree.html
  vmesh evaluate tree.ply --centerline tree.swc --require closed,max-skewness=0.9,relative-volume-distance=0.5)";

OpenEnds parse_open_ends(const std::string& text) {
  OpenEnds ends;
  ends.all = text == "all";
  if (ends.all) return ends;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    Index node = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), node);
    if (error != std::errc() || end != item.data() + item.size())
      throw CLI::ValidationError("--open-ends",
                                 "\"" + item + "\" is not a node number; give all, or numbers such as 3,17");
    ends.nodes.push_back(node);
  }
  return ends;
}

void add_ends(CLI::App& verb, GenerateArguments& arguments) {
  verb.add_option_function<std::string>(
          "--ends", [&arguments](const std::string& text) { arguments.production.ends = parse_end_shape(text); },
          "how vessels end: round; flat: closed by flat caps, numbered for flow solvers (ModelFaceID, CapID in .vtp "
          "and .ply); open: not closed")
      ->check(CLI::IsMember({"round", "flat", "open"}))
      ->default_str("round");
  verb.add_option_function<std::string>(
          "--open-ends",
          [&arguments](const std::string& text) { arguments.production.growth.open_ends = parse_open_ends(text); },
          "leave the surface open at these ends of the centerline, regardless of --ends: all, or node numbers as in "
          "the summary, separated by commas")
      ->type_name("all|N,N,...");
  verb.add_option("--flow-extensions", arguments.production.extension,
                  "length of straight extensions at ends that are not round, in radii; 0: none")
      ->check(in_range(0.0, 1000.0))
      ->capture_default_str();
}

/// With --ends, --open-ends all means that all are open.
GenerateArguments settled(GenerateArguments arguments) {
  EndShape& ends = arguments.production.ends;
  OpenEnds& open = arguments.production.growth.open_ends;
  if (arguments.production.extension > 0 && ends == EndShape::round && !open.all && open.nodes.empty())
    throw UsageError("--flow-extensions needs ends that are not round: --ends flat, or --ends open");
  if (ends == EndShape::round || !open.all) return arguments;
  ends = EndShape::open;
  open = {};
  return arguments;
}

/// By default, a part's surface is written beside it.
void settle_generate(GenerateArguments& arguments) {
  if (is_part(arguments.input.path) && arguments.output.empty() && arguments.input.more.empty()) {
    arguments.output = arguments.input.path;
    arguments.output.replace_extension(kPartSurfaceExtension);
  }
  settle_output(arguments);
}

// The values of a preset can be overridden by their own options, wherever these are on the line.
void add_preset(CLI::App& verb, GenerateOptions& options) {
  CLI::Option* preset = verb.add_option("--preset", "low: 6 vertices around; high: 12, about four times as many in all")
                            ->check(CLI::IsMember({"low", "high"}))
                            ->default_str("low");
  verb.parse_complete_callback([&verb, &options, preset] {
    if (preset->count() == 0 || verb.get_option("--around")->count() > 0) return;
    options.around = vertices_around(preset->as<std::string>() == "high" ? Preset::high : Preset::low);
  });
}

void add_generate(CLI::App& app, GenerateArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("generate", "Grow a surface around a centerline");
  add_centerline_input(
      verb, arguments.input,
      "centerline, or segmentation to extract it from and to fit to: an image (.nii, .nii.gz, .nrrd, .mha, or a folder "
      "of DICOM files) or a wall (.stl, .ply, .obj, .vtp ...), open or closed");
  add_output_after_several(verb, arguments.output, "surface (.ply, .vtp, .stl, .obj, .off, .glb)");
  add_writing(verb, arguments.writing);
  verb.add_flag("--bones", arguments.bones, "add bones along the centerline to a .glb, for bending it");
  add_growth(verb, arguments);
  verb.add_option_function<std::string>(
          "--growth",
          [&arguments](const std::string& text) { arguments.production.growth.growth = parse_growth_method(text); },
          "guided: with the topology of the centerline; paper: a single seed, as published")
      ->check(CLI::IsMember({"guided", "paper"}))
      ->default_str("guided");
  verb.add_option_function<std::string>(
          "--max-error",
          [&arguments](const std::string& text) {
            try {
              arguments.production.growth.max_error = parse_error_limit(text);
            } catch (const InvalidInput& error) {
              throw CLI::ValidationError("--max-error", error.what());
            }
          },
          "refine until the surface is proven to be no farther than this from the boundary, and the boundary from it: "
          "0.3mm, 10% (of the local radius), or both, separated by a comma")
      ->type_name("Xmm|X%");
  verb.add_option("--least-vertices", arguments.production.growth.least_vertices,
                  "with --elongation: leave out vertices until there are so few; those that are left are where they "
                  "reduce the mean error most; with --max-error, only as long as that stays proven; 0: as few as "
                  "--max-error allows")
      ->capture_default_str();
  verb.add_flag("--deformable", arguments.production.growth.deformable,
                "for a centerline that is to move: a ring of vertices at every node, whatever the elongation");
  add_budget(verb, arguments.budget,
             "choose the resolution: the finest surface with vertices=N at most, or grown within time=Xms, or the one "
             "with the fewest vertices that keeps error=Xmm or error=X% everywhere; with --elongation, vertices=N are "
             "where they reduce the mean error most")
      .type_name("vertices=N|time=Xms|error=X")
      ->excludes("--around")
      ->excludes("--preset")
      ->excludes("--max-error")
      ->excludes("--least-vertices");
  add_ends(verb, arguments);
  verb.add_flag("--check", arguments.check,
                "exit with 1 unless the surface is closed, manifold, free of "
                "self-intersections, of the expected topology, and contains every centerline node");
  verb.add_flag("--allow-defects", arguments.allow_defects,
                "write the surface even if it is not sound; the summary lists its defects with their positions");
  verb.add_option("--fit", arguments.fitting.reference.path,
                  "fit to this surface or image: the vessels' own walls instead of round cones");
  add_fitting(verb, arguments.fitting);
  verb.add_option("--centerline-output", arguments.centerline_output,
                  "with an image or a wall as input: where to save the extracted centerline");
  add_extraction(verb, arguments.extraction);
  add_required_coverage(verb, arguments.required_coverage);
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  group(verb, "Resolution",
        {"--around", "--preset", "--max-error", "--budget", "--max-vertices", "--simplification", "--elongation",
         "--least-vertices", "--deformable"});
  group(verb, "Shape", {"--blend", "--placement", "--overlap", "--gap"});
  group(verb, "Ends", {"--ends", "--open-ends", "--flow-extensions"});
  group(verb, "How it is made", {"--growth", "--beta", "--max-center-distance", "--sweeps", "--threads"});
  group(verb, "Checks", {"--check", "--allow-defects"});
  verb.footer(kGenerateExamples);
}

void add_info(CLI::App& app, InfoArguments& arguments) {
  CLI::App& verb =
      *app.add_subcommand("info", "Show what a centerline, surface or image contains, and what is wrong with it");
  add_centerline_input(verb, arguments.input, "centerline, surface or image");
  verb.add_flag("--check", arguments.check, "exit with 1 when there is a problem");
  add_common(verb, arguments.common);
  verb.footer(kInfoExamples);
}

void add_synth(CLI::App& app, SynthArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("synth", "Make a synthetic tree like a liver's portal vein");
  add_output(verb, arguments.output, "centerline");
  verb.add_option("--vertices", arguments.options.vertices, "nodes of the centerline")
      ->check(in_range(2, 10000000))
      ->capture_default_str();
  verb.add_option("--seed", arguments.options.seed, "of the random numbers; each gives a different tree")
      ->capture_default_str();
  add_common(verb, arguments.common, false);
  verb.footer(kSynthExamples);
}

void add_convert(CLI::App& app, ConvertArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("convert", "Convert between centerline formats or between surface formats");
  add_centerline_input(verb, arguments.input, "centerline or surface");
  add_output_after_several(verb, arguments.output, "file of the same kind");
  add_writing(verb, arguments.writing);
  add_common(verb, arguments.common, false);
  verb.footer(kConvertExamples);
}

void add_render_view(CLI::App& verb, RenderOptions& options) {
  verb.add_option("--width", options.width, "pixels")->check(in_range(16, 16384))->capture_default_str();
  verb.add_option("--height", options.height, "pixels")->check(in_range(16, 16384))->capture_default_str();
  verb.add_option_function<std::string>(
          "--view",
          [&options](const std::string& text) {
            try {
              options.view = view_direction(text);
            } catch (const InvalidInput& error) {
              throw CLI::ValidationError("--view", error.what());
            }
          },
          "front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees")
      ->type_name("VIEW");
  verb.add_option_function<std::string>(
          "--look-at",
          [&options](const std::string& text) {
            const std::vector<double> p = parse_numbers("--look-at", text, 3);
            options.look_at = Vec3(p[0], p[1], p[2]);
          },
          "point at the centre of the picture, mm; default: the centre of the mesh")
      ->type_name("X,Y,Z");
  verb.add_option("--view-height", options.view_height_mm, "height of the scene in the picture, mm; 0: the whole mesh")
      ->check(in_range(0.0, 1e9))
      ->capture_default_str();
  verb.add_option("--zoom", options.zoom, "magnification")->check(in_range(1e-3, 1e6))->capture_default_str();
  verb.add_option("--field-of-view", options.field_of_view_deg, "degrees; 0: orthographic")
      ->check(in_range(0.0, 119.0))
      ->capture_default_str();
}

void add_render_look(CLI::App& verb, RenderArguments& arguments) {
  RenderOptions& options = arguments.options;
  verb.add_flag("--edges", options.edges, "draw the triangles' edges");
  verb.add_option("--edge-width", options.edge_width_px, "pixels")->check(in_range(0.01, 100.0))->capture_default_str();
  verb.add_flag("!--flat", options.smooth, "shade facet by facet");
  verb.add_flag("!--no-back-faces", options.highlight_back_faces,
                "do not highlight the inside of the surface in magenta");
  verb.add_flag("!--no-legend", options.legend, "omit the colour scale");
  verb.add_option("--occlusion", options.occlusion, "darkening where little ambient light arrives")
      ->check(in_range(0.0, 1.0))
      ->capture_default_str();
  verb.add_option("--color", arguments.color,
                  "colour by this attribute of the file, or by skewness; branch: a colour for each")
      ->type_name("NAME");
  verb.add_option_function<std::string>(
          "--range",
          [&options](const std::string& text) {
            const std::vector<double> ends = parse_numbers("--range", text, 2);
            options.range = std::pair(ends[0], ends[1]);
          },
          "attribute values at the ends of the colour scale")
      ->type_name("A,B");
}

void add_render(CLI::App& app, RenderArguments& arguments) {
  CLI::App& verb = *app.add_subcommand("render", "Draw a surface; needs no display");
  add_input(verb, arguments.input, "surface");
  add_output(verb, arguments.output, "picture (.png)");
  add_render_view(verb, arguments.options);
  add_render_look(verb, arguments);
  add_common(verb, arguments.common, false);
  group(verb, "How to read the input", {"--unit", "--space"});
  group(verb, "View", {"--width", "--height", "--view", "--look-at", "--view-height", "--zoom", "--field-of-view"});
  group(verb, "Look",
        {"--edges", "--edge-width", "--flat", "--no-back-faces", "--no-legend", "--occlusion", "--color", "--range"});
  verb.footer(kRenderExamples);
}

void add_evaluate(CLI::App& app, EvaluateArguments& arguments) {
  CLI::App& verb = *app.add_subcommand(
      "evaluate", "Measure a surface: faces, defects, distance to a reference surface or to a centerline's vessels");
  add_input(verb, arguments.input, "surface");
  verb.add_option(
      "--reference", arguments.reference.path,
      "surface to compare with: guaranteed Hausdorff distance, mean, RMS and percentiles, in both directions");
  add_reading(verb, arguments.reference, "reference-");
  verb.add_option("--centerline", arguments.centerline.path,
                  "compare with the exact volume of its round cones, in both directions, in mm and in local radii");
  add_reading(verb, arguments.centerline, "centerline-");
  add_centerline_reading(verb, arguments.centerline, "centerline-");
  verb.add_option("-o,--output", arguments.output,
                  "the surface with the skewness of its faces, and its vertices' distance to the reference and "
                  "volume_distance (.ply, .vtp)");
  add_report(verb, arguments.report, arguments.format);
  add_measuring(verb, arguments.tolerance_mm, arguments.samples);
  verb.add_option("--threads", arguments.threads, "to work on; 0: all; the result does not depend on it")
      ->check(in_range(0, 4096))
      ->capture_default_str();
  verb.add_option("--require", arguments.require,
                  "exit with 1 unless all of these hold, separated by commas: " + describe_requirements())
      ->type_name("LIST");
  add_html(verb, arguments.common);
  add_common(verb, arguments.common);
  verb.footer(kEvaluateExamples);
}

}  // namespace

void add_growth(CLI::App& verb, GenerateArguments& arguments) {
  for_each_generate_option(arguments.production.growth,
                           [&verb](const char* flag, auto& member, auto low, auto high, const char* help) {
                             verb.add_option(flag, member, help)->check(in_range(low, high))->capture_default_str();
                           });
  add_preset(verb, arguments.production.growth);
  verb.add_option_function<std::string>(
          "--placement",
          [&arguments](const std::string& text) { arguments.production.growth.placement = parse_placement(text); },
          "inscribed: vertices on the boundary; balanced: lifted off it, so that the volume is kept")
      ->check(CLI::IsMember({"inscribed", "balanced"}))
      ->default_str("balanced");
  verb.add_option("--threads", arguments.production.growth.threads,
                  "to work on; 0: all; the result does not depend on it")
      ->check(in_range(0, 4096))
      ->capture_default_str();
  verb.add_option_function<std::string>(
          "--overlap",
          [&arguments](const std::string& text) { arguments.production.preparation.separate = text == "separate"; },
          "vessels that touch without being neighbours: separate them by narrowing, and by moving those that cross; or "
          "keep them: the surface then intersects itself there and is refused")
      ->check(CLI::IsMember({"keep", "separate"}))
      ->default_str("separate");
  verb.add_option("--gap", arguments.production.preparation.gap,
                  "gap between vessels below which they count as touching, in smaller radii")
      ->check(in_range(0.001, 1.0))
      ->capture_default_str();
}

std::optional<Arguments> parse_arguments(int argc, const char* const* argv, int& exit_code) {
  CLI::App app("vmesh turns vessel centerlines into surfaces.", "vmesh");
  app.set_version_flag("--version", "vmesh " + std::string(version()));
  app.footer(
      "vmesh VERB --help lists the options of a verb with examples.\n"
      "Exit codes: 0 ok, 1 a requested check failed, 2 usage, 3 bad input, 4 unsupported or not built in,\n"
      "5 cannot write, 6 did not converge, 7 no sound surface was found, 130 interrupted.");
  app.require_subcommand(1);

  GenerateArguments generate;
  InfoArguments info;
  SynthArguments synth;
  ConvertArguments convert;
  RenderArguments render;
  EvaluateArguments evaluate;
  ReferenceArguments reference;
  ConesArguments cones;
  CenterlineArguments centerline;
  Table2Arguments table2;
  TradeoffArguments tradeoff;
  DeformArguments deform;
  Table1Arguments table1;
  FitArguments fit;
  SplitArguments split;
  JoinArguments join;
  add_generate(app, generate);
  add_info(app, info);
  add_synth(app, synth);
  add_convert(app, convert);
  add_render(app, render);
  add_evaluate(app, evaluate);
  add_reference(app, reference);
  add_cones(app, cones);
  add_centerline(app, centerline);
  add_table2(app, table2);
  add_tradeoff(app, tradeoff);
  add_deform(app, deform);
  add_table1(app, table1);
  add_fit(app, fit);
  add_split(app, split);
  add_join(app, join);
  HelpArguments help;
  add_help(app, help);
  if (argc > 1 && argv[1][0] != '-') check_verb(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream complaint;  // may quote what was typed
    // CLI11's own codes run from 100 to 127.
    exit_code = app.exit(error, std::cout, complaint) == 0 ? kOk : kUsage;
    std::istringstream lines(complaint.str());
    for (std::string line; std::getline(lines, line);) std::cerr << printable(line) << "\n";
    return std::nullopt;
  }
  exit_code = kOk;
  if (ran_help(app, help)) return std::nullopt;
  if (app.got_subcommand("generate")) settle_generate(generate);
  if (app.got_subcommand("split")) settle_output(split);
  if (app.got_subcommand("join")) settle_output(join);
  if (app.got_subcommand("synth")) settle_output(synth);
  if (app.got_subcommand("convert")) settle_output(convert);
  if (app.got_subcommand("render")) settle_output(render);
  if (app.got_subcommand("reference")) settle_output(reference);
  if (app.got_subcommand("cones")) settle_output(cones);
  if (app.got_subcommand("centerline")) settle_output(centerline);
  if (app.got_subcommand("deform")) settle_output(deform);
  if (app.got_subcommand("fit")) settle_output(fit);
  if (app.got_subcommand("generate")) return settled(generate);
  if (app.got_subcommand("info")) return info;
  if (app.got_subcommand("synth")) return synth;
  if (app.got_subcommand("convert")) return convert;
  if (app.got_subcommand("reference")) return reference;
  if (app.got_subcommand("cones")) return cones;
  if (app.got_subcommand("centerline")) return centerline;
  if (app.got_subcommand("table2")) return table2;
  if (app.got_subcommand("tradeoff")) return tradeoff;
  if (app.got_subcommand("deform")) return deform;
  if (app.got_subcommand("table1")) return table1;
  if (app.got_subcommand("fit")) return fit;
  if (app.got_subcommand("split")) return split;
  if (app.got_subcommand("join")) return join;
  if (app.got_subcommand("evaluate")) return evaluate;
  return render;
}

}  // namespace vmesh::tool
