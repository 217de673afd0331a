#pragma once

#include <sstream>

#include <CLI/CLI.hpp>

#include "command_line/arguments.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {

/// CLI::Range accepts NaN.
template <class Number>
CLI::Validator in_range(Number low, Number high) {
  std::ostringstream name;
  name << "in [" << low << ", " << high << "]";
  const auto check = [low, high, words = name.str()](std::string& text) {
    Number value;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
    return good ? std::string() : "not " + words + ": " + text;
  };
  return {check, name.str()};
}

void add_common(CLI::App& verb, CommonArguments& common, bool with_json = true);

/// Adds --html, for verbs that can make a page.
void add_html(CLI::App& verb, CommonArguments& common);

/// Adds -o, or the last word: see settle_output().
void add_output(CLI::App& verb, std::filesystem::path& output, const std::string& help);

/// The same for verbs whose input may be several files.
void add_output_after_several(CLI::App& verb, std::filesystem::path& output, const std::string& help);

/// Without -o, the last of several inputs is the output. Throws UsageError if none is left.
template <class Arguments>
void settle_output(Arguments& arguments) {
  if constexpr (requires { arguments.input; }) {
    if (arguments.output.empty() && !arguments.input.more.empty()) {
      arguments.output = std::move(arguments.input.more.back());
      arguments.input.more.pop_back();
    }
  }
  if (arguments.output.empty()) throw UsageError("name the file to write: at the end, or with -o");
}

/// Adds options for the unit and frame of the output, and for the attributes of a surface.
void add_writing(CLI::App& verb, WritingArguments& writing);

/// Adds options for reading a file; `of`: "" for the input, else "reference-" or the like.
void add_reading(CLI::App& verb, InputArguments& input, const std::string& of);

void add_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// The same for centerlines, which may consist of several files and may need a radius.
void add_centerline_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// Adds options for centerline files with missing information; `of` as above.
void add_centerline_reading(CLI::App& verb, InputArguments& input, const std::string& of);

/// Puts options under a heading of their own in the help.
void group(CLI::App& verb, const std::string& heading, std::initializer_list<const char*> options);

/// `count` finite numbers, separated by commas. Throws CLI::ValidationError for `option`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);

/// Adds options for a report's file, and its format on stdout.
void add_report(CLI::App& verb, std::filesystem::path& report, std::string& format);

/// Adds --budget, see parse_budget().
CLI::Option& add_budget(CLI::App& verb, std::optional<Budget>& budget, const std::string& help);

/// Adds options for measuring a surface against another one.
void add_measuring(CLI::App& verb, double& tolerance_mm, std::size_t& samples);

/// Adds the verbs about surfaces to compare with.
void add_reference(CLI::App& app, ReferenceArguments& arguments);
void add_cones(CLI::App& app, ConesArguments& arguments);
void add_centerline(CLI::App& app, CenterlineArguments& arguments);
void add_table2(CLI::App& app, Table2Arguments& arguments);
void add_tradeoff(CLI::App& app, TradeoffArguments& arguments);
void add_fit(CLI::App& app, FitArguments& arguments);

/// Adds the options of growth that generate and split have in common.
void add_growth(CLI::App& verb, GenerateArguments& arguments);

/// Adds the verbs for surfaces in parts.
void add_split(CLI::App& app, SplitArguments& arguments);
void add_join(CLI::App& app, JoinArguments& arguments);

/// Adds options for making a surface from an image.
void add_image_options(CLI::App& verb, ReferenceOptions& options);
/// Adds options for extracting a centerline.
void add_extraction(CLI::App& verb, ExtractOptions& options);
/// Adds --require for what extraction has to cover.
void add_required_coverage(CLI::App& verb, RequiredCoverage& required);
/// Adds options for the target and the parameters of a fit.
void add_fitting(CLI::App& verb, FittingArguments& arguments);

/// Adds the verbs about motion.
void add_deform(CLI::App& app, DeformArguments& arguments);
void add_table1(CLI::App& app, Table1Arguments& arguments);

}  // namespace vmesh::tool
