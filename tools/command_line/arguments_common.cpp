#include "command_line/arguments_common.h"

#include <cmath>

#include "command_line/execution_model.h"

namespace vmesh::tool {

void add_common(CLI::App& verb, CommonArguments& common, bool with_json) {
  verb.add_flag("-q,--quiet", common.quiet, "only warnings and errors on stderr");
  verb.add_flag(
      kSlicerFlag, common.slicer,
      "called by 3D Slicer: progress as tags on stdout; _ for - in options; options that have their defaults are "
      "as if not given");
  if (with_json)
    verb.add_option("--json", common.json, "write a summary to this file; - for stdout")->type_name("FILE.json");
}

void add_html(CLI::App& verb, CommonArguments& common) {
  verb.add_option(
          "--html", common.html,
          "write a page to this file: the surface in 3D with its worst places, distributions and figures, for any "
          "browser, without a network (.html)")
      ->type_name("FILE.html|.htm");
}

void add_output(CLI::App& verb, std::filesystem::path& output, const std::string& type, const std::string& help) {
  verb.add_option("-o,--output,OUT", output, help)->type_name(type);
}

void add_output_after_several(CLI::App& verb, std::filesystem::path& output, const std::string& type,
                              const std::string& help) {
  verb.add_option("-o,--output", output, help + "; without -o, the last of the files")->type_name(type);
}

static constexpr const char* kWriting = "How to write the output";

void add_output_frame(CLI::App& verb, WritingArguments& writing) {
  add_choice(
      verb, "--output-unit", {"nm", "um", "mm", "cm", "m"},
      [&writing](const std::string& text) { writing.unit = *parse_length_unit(text); }, "unit of the output")
      ->default_str("mm");
  add_choice(
      verb, "--output-space", {"LPS", "RAS"},
      [&writing](const std::string& text) { writing.space = *parse_space(text); }, "patient frame of the output")
      ->default_str("LPS");
  group(verb, kWriting, {"--output-unit", "--output-space"});
}

void add_writing_without_attributes(CLI::App& verb, WritingArguments& writing) {
  add_output_frame(verb, writing);
  verb.add_flag_callback(
      "--ascii", [&writing] { writing.encoding = SurfaceEncoding::text; },
      "write the surface as text (" +
          listed(extensions_of(surface_formats(), [](const auto& f) { return f.has_text_form; }), "and") + ")");
  verb.add_flag_callback(
          "--compress", [&writing] { writing.encoding = SurfaceEncoding::compressed; },
          "compress a .glb for web pages and game engines (EXT_meshopt_compression), to about a third; positions are "
          "rounded to a millionth of the size")
      ->excludes("--ascii");
  group(verb, kWriting, {"--ascii", "--compress"});
}

void add_writing(CLI::App& verb, WritingArguments& writing) {
  add_writing_without_attributes(verb, writing);
  verb.add_option("--attributes", writing.attributes,
                  "of a surface: all; vertex: none of faces, which some PLY readers reject; or none")
      ->check(CLI::IsMember({"all", "vertex", "none"}))
      ->capture_default_str()
      ->group(kWriting);
}

void add_reading(CLI::App& verb, InputArguments& input, const std::string& of) {
  input.options_of = of;
  add_choice(
      verb, "--" + of + "unit", {"nm", "um", "mm", "cm", "m"},
      [&input](const std::string& text) { input.unit = parse_length_unit(text); },
      "unit of the numbers in the file; overrides what the file says");
  add_choice(
      verb, "--" + of + "space", {"LPS", "RAS"}, [&input](const std::string& text) { input.space = parse_space(text); },
      "patient frame of the file; overrides what the file says");
}

void add_input(CLI::App& verb, InputArguments& input, const std::string& help) {
  verb.add_option("IN", input.path, help)->required()->type_name(kFile);
  add_reading(verb, input, "");
}

void group(CLI::App& verb, const std::string& heading, std::initializer_list<const char*> options) {
  for (const char* option : options) verb.get_option(option)->group(heading);
}

CLI::Option* add_choice(CLI::App& verb, const std::string& option, const std::vector<std::string>& choices,
                        const TakeText& take, const std::string& help) {
  return verb.add_option_function<std::string>(option, take, help)->check(CLI::IsMember(choices));
}

CLI::Option& add_read_option(CLI::App& verb, const std::string& option, const TakeText& take, const std::string& help) {
  return *verb.add_option_function<std::string>(
      option,
      [option, take](const std::string& text) {
        try {
          take(text);
        } catch (const InvalidInput& error) {
          throw CLI::ValidationError(option, error.what());
        }
      },
      help);
}

void add_threads(CLI::App& verb, int& threads) {
  add_number(verb, "--threads", threads, 0, 4096, "to work on; 0: all; the result does not depend on it");
}

CLI::Option& add_budget(CLI::App& verb, std::optional<Budget>& budget, const std::string& help) {
  return add_read_option(
      verb, "--budget", [&budget](const std::string& text) { budget = parse_budget(text); }, help);
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    double number = 0;
    if (!CLI::detail::lexical_cast(item, number) || !std::isfinite(number))
      throw CLI::ValidationError(option, "\"" + item + "\" is not a number");
    numbers.push_back(number);
  }
  if (numbers.size() != count || text.ends_with(','))
    throw CLI::ValidationError(option, "needs " + std::to_string(count) + " numbers, separated by commas: " + text);
  return numbers;
}

void add_voxel_size(CLI::App& verb, InputArguments& input, const std::string& of) {
  verb.add_option_function<std::string>(
          "--" + of + "voxel-size",
          [&input, option = "--" + of + "voxel-size"](const std::string& text) {
            const bool cube = text.find(',') == std::string::npos;
            std::vector<double> sides = parse_numbers(option, text, cube ? 1 : 3);
            sides.resize(3, sides[0]);
            input.read.voxel_size = Vec3(sides[0], sides[1], sides[2]);
            if (!(input.read.voxel_size->minCoeff() > 0))
              throw CLI::ValidationError(option, "must be above 0: " + text);
          },
          "sides of the voxels: in which a file counts, in its unit (GXL of VascuSynth, SWC); of a TIFF stack, mm")
      ->type_name("S|SX,SY,SZ");
}

void add_centerline_reading(CLI::App& verb, InputArguments& input, const std::string& of) {
  verb.add_option(
          "--" + of + "radius-array", input.read.radius_array,
          "array or column of the file that holds the radius; the diameter if \"diam\" is in its name, the area "
          "of the cross-section if \"area\" is")
      ->type_name("NAME");
  verb.add_option_function<double>(
          "--" + of + "radius", [&input](const double& radius) { input.read.radius = radius; },
          "radius of all nodes of a file without radii, mm")
      ->check(in_range(1e-9, 1e9));
  add_read_option(
      verb, "--" + of + "tolerance",
      [&input](const std::string& text) { input.read.tolerance = parse_end_tolerance(text); },
      "join ends of branches that are nearer to each other than this: .5mm, or .1 of their radius")
      .type_name("Xmm|X");
  add_voxel_size(verb, input, of);
}

void add_centerline_input(CLI::App& verb, InputArguments& input, const std::string& help) {
  verb.add_option_function<std::vector<std::string>>(
          "IN",
          [&input](const std::vector<std::string>& paths) {
            input.path = paths.front();
            input.more.assign(paths.begin() + 1, paths.end());
          },
          help + "; several files with a branch each form one")
      ->required()
      ->type_name(kFile);
  add_reading(verb, input, "");
  add_centerline_reading(verb, input, "");
  group(verb, "How to read the input",
        {"--unit", "--space", "--radius-array", "--radius", "--tolerance", "--voxel-size"});
}

void add_report(CLI::App& verb, ReportArguments& report) {
  verb.add_option("--report", report.file, "also write the report to this file (.txt, .md, .csv, .json)")
      ->type_name("FILE.txt|.md|.csv|.json");
  verb.add_option("--format", report.format, "of the report on stdout")
      ->check(CLI::IsMember({"text", "markdown", "csv"}))
      ->capture_default_str();
}

void add_measuring(CLI::App& verb, double& tolerance_mm, std::size_t& samples) {
  add_number(verb, "--tolerance", tolerance_mm, 1e-12, 1e6,
             "width of the interval that contains a Hausdorff distance, mm");
  add_number(verb, "--samples", samples, std::size_t{1}, std::size_t{10'000'000},
             "points on each surface for mean, RMS and percentiles");
}

}  // namespace vmesh::tool
