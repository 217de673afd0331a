#pragma once

#include <sstream>

#include <CLI/CLI.hpp>

#include "command_line/arguments.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {

/// CLI::Range lets NaN pass.
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

/// -o, or the last word: see settle_output().
void add_output(CLI::App& verb, std::filesystem::path& output, const std::string& help);

/// The same for verbs whose input may be several files.
void add_output_after_several(CLI::App& verb, std::filesystem::path& output, const std::string& help);

/// Of several inputs without -o, the last one is the output. Throws UsageError when none is left.
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

/// In what unit and frame the output is written, and which attributes a surface gets.
void add_writing(CLI::App& verb, WritingArguments& writing);

/// Options that tell how to read a file; `of`: "" for the input, else "reference-" or the like.
void add_reading(CLI::App& verb, InputArguments& input, const std::string& of);

void add_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// The same for centerlines, which several files may make, and which may need a radius.
void add_centerline_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// Options for centerlines that do not say all of themselves; `of` as above.
void add_centerline_reading(CLI::App& verb, InputArguments& input, const std::string& of);

/// Puts options under a heading of their own in the help.
void group(CLI::App& verb, const std::string& heading, std::initializer_list<const char*> options);

/// `count` finite numbers, separated by commas. Throws CLI::ValidationError in the name of `option`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);

/// Where a report goes besides stdout, and its format there.
void add_report(CLI::App& verb, std::filesystem::path& report, std::string& format);

/// --budget, as parse_budget() reads it.
CLI::Option& add_budget(CLI::App& verb, std::optional<Budget>& budget, const std::string& help);

/// How a surface is measured against another one.
void add_measuring(CLI::App& verb, double& tolerance_mm, std::size_t& samples);

/// The verbs that deal with what surfaces are compared with.
void add_reference(CLI::App& app, ReferenceArguments& arguments);
void add_cones(CLI::App& app, ConesArguments& arguments);
void add_centerline(CLI::App& app, CenterlineArguments& arguments);
void add_table2(CLI::App& app, Table2Arguments& arguments);
void add_tradeoff(CLI::App& app, TradeoffArguments& arguments);
void add_fit(CLI::App& app, FitArguments& arguments);

/// How surfaces grow: the options that generate and split have in common.
void add_growth(CLI::App& verb, GenerateArguments& arguments);

/// The verbs for surfaces in parts.
void add_split(CLI::App& app, SplitArguments& arguments);
void add_join(CLI::App& app, JoinArguments& arguments);

/// What makes a surface of an image.
void add_image_options(CLI::App& verb, ReferenceOptions& options);
/// How a centerline is extracted.
void add_extraction(CLI::App& verb, ExtractOptions& options);
/// How a surface is fitted, and to what.
void add_fitting(CLI::App& verb, FittingArguments& arguments);

/// The verbs that deal with motion.
void add_deform(CLI::App& app, DeformArguments& arguments);
void add_table1(CLI::App& app, Table1Arguments& arguments);

}  // namespace vmesh::tool
