#include "vmesh/io/sha256.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"

namespace vmesh::tool::convert_verb {
namespace {

using Kind = PlannedOutput::Kind;

struct ConvertArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  WritingArguments writing;
};

void add_options(CLI::App& verb, ConvertArguments& arguments) {
  add_centerline_input(verb, arguments.input, "centerline or surface");
  add_output_after_several(verb, arguments.output, kFile, "file of the same kind");
  add_writing(verb, arguments.writing);
}

/// What a file of that name contains; nullopt for VTK's, which may contain either.
std::optional<Kind> kind_of(const std::filesystem::path& path) {
  if (!may_be_centerline(path)) {
    surface_format(path);  // throws Unsupported
    return Kind::surface;
  }
  if (find_surface_format(path) == nullptr) return Kind::centerline;
  return std::nullopt;
}

/// Throws Unsupported.
[[noreturn]] void refuse_output(const std::filesystem::path& path) {
  const auto is_written = [](const auto& format) { return format.is_written(); };
  throw Unsupported(path.string() + ": \"" + extension_of(path) + "\" is not supported; centerlines are written as " +
                    listed(extensions_of(centerline_formats(), is_written)) + ", surfaces as " +
                    listed(extensions_of(surface_formats(), is_written)));
}

std::optional<Kind> kind_of_output(const std::filesystem::path& path) {
  const CenterlineFormat* format = find_centerline_format(path);
  if (format == nullptr && find_surface_format(path) == nullptr) refuse_output(path);
  return format != nullptr && format->holds_lines != nullptr ? Kind::surface : kind_of(path);
}

[[noreturn]] void refuse_surface(const ConvertArguments& arguments) {
  throw UsageError(arguments.input.path.string() + ": holds a surface, which cannot be written to " +
                   arguments.output.string() + "; see vmesh centerline");
}

[[noreturn]] void refuse_lines(const ConvertArguments& arguments) {
  throw UsageError(arguments.input.path.string() +
                   ": holds lines, no faces: a centerline, which cannot be written to " + arguments.output.string() +
                   "; see vmesh generate");
}

/// Of a file in a format that is mostly a surface's.
bool holds_lines(const std::filesystem::path& path) {
  const CenterlineFormat* format = find_centerline_format(path);
  return format != nullptr && format->holds_lines != nullptr && may_be_centerline(path);
}

void check_kinds(const ConvertArguments& arguments) {
  check_is_no_image(arguments.input);
  if (kind_of_output(arguments.output) == Kind::surface && holds_lines(arguments.input.path)) refuse_lines(arguments);
  const auto from = kind_of(arguments.input.path), to = kind_of_output(arguments.output);
  if (from && to && *from != *to)
    throw UsageError(arguments.output.string() + ": a " + (*from == Kind::surface ? "surface" : "centerline") +
                     " cannot be converted to a " + (*to == Kind::surface ? "surface" : "centerline") + "; see vmesh " +
                     (*from == Kind::centerline ? "generate" : "centerline"));
}

std::vector<PlannedOutput> planned_outputs(const std::filesystem::path& output) {
  const Kind kind = kind_of_output(output).value_or(Kind::surface);
  std::vector<PlannedOutput> outputs;
  for (const std::filesystem::path& file : files_of(output)) outputs.push_back({file, kind});
  return outputs;
}

void convert(const RawCenterline& raw, const ConvertArguments& arguments, Console& console) {
  CleaningOptions options;
  options.canonical_order = false;
  const CleanedCenterline cleaned = clean(raw, options);
  for (const std::string& line : cleaned.report.summary()) console.log("cleaning: " + line);
  write_centerline(arguments.output, cleaned.centerline,
                   {generator_name(), "convert", file_name_of(arguments.input), sha256_of(arguments.input),
                    arguments.writing.unit, arguments.writing.space},
                   cleaned.end_sections, console);
}

void convert(const LoadedSurface& surface, const ConvertArguments& arguments, Console&) {
  write_surface(arguments.output, surface.mesh, surface.attributes,
                {generator_name(), "convert", file_name_of(arguments.input), sha256_of(arguments.input)},
                arguments.writing);
}

int run(const ConvertArguments& arguments, Console& console) {
  check_kinds(arguments);
  check_writing(arguments.output, arguments.writing);
  check_outputs(planned_outputs(arguments.output), files_of(arguments.input));
  std::vector<std::string> warnings;
  const AnyInput input = load_any(arguments.input, warnings);
  console.warn(warnings);
  stop_if_interrupted();
  const bool is_surface = std::holds_alternative<LoadedSurface>(input);
  if (const auto to = kind_of_output(arguments.output); to && (*to == Kind::surface) != is_surface)
    is_surface ? refuse_surface(arguments) : refuse_lines(arguments);
  std::visit([&](const auto& content) { convert(content, arguments, console); }, input);
  console.log("wrote " + arguments.output.string());
  return kOk;
}

const VerbRegistration<ConvertArguments> kRegistration({
    .rank = 40,
    .name = "convert",
    .help = "Convert between centerline formats or between surface formats",
    .examples = R"(Examples:
  vmesh convert tree.swc -o tree.vtp
  vmesh convert tree.swc -o tree.json --unit um
  vmesh convert tree.ply -o tree.stl
  vmesh convert tree.ply tree.obj --output-unit cm --output-space RAS)",
    .with_json = false,
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::convert_verb
