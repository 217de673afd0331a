#pragma once

#include <functional>
#include <sstream>

#include <CLI/CLI.hpp>

#include "vmesh/tuning/budget.h"

#include "command_line/arguments.h"
#include "command_line/file_types.h"
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

/// Adds an option for a number within limits; the help shows its default.
template <class Number, class Limit>
CLI::Option* add_number(CLI::App& verb, const std::string& option, Number& number, Limit low, Limit high,
                        const std::string& help) {
  return verb.add_option(option, number, help)->check(in_range(low, high))->capture_default_str();
}

void add_common(CLI::App& verb, CommonArguments& common, bool with_json);

/// Adds --html, for verbs that can make a page.
void add_html(CLI::App& verb, CommonArguments& common);

/// Adds -o, or the last word: see settle_output(). `type`: of file_types.h.
void add_output(CLI::App& verb, std::filesystem::path& output, const std::string& type, const std::string& help);

/// The same for verbs whose input may be several files.
void add_output_after_several(CLI::App& verb, std::filesystem::path& output, const std::string& type,
                              const std::string& help);

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

/// Adds options for the unit and frame of the output.
void add_output_frame(CLI::App& verb, WritingArguments& writing);

/// The same, and for its encoding.
void add_writing_without_attributes(CLI::App& verb, WritingArguments& writing);

/// The same, and one for the attributes of a surface.
void add_writing(CLI::App& verb, WritingArguments& writing);

/// Adds options for reading a file; `of`: "" for the input, else "reference-" or the like.
void add_reading(CLI::App& verb, InputArguments& input, const std::string& of);

void add_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// The same for centerlines, which may consist of several files and may need a radius.
void add_centerline_input(CLI::App& verb, InputArguments& input, const std::string& help);

/// Adds the option for files that count in voxels, or do not tell how large these are; `of` as above.
void add_voxel_size(CLI::App& verb, InputArguments& input, const std::string& of);

/// Adds options for centerline files with missing information; `of` as above.
void add_centerline_reading(CLI::App& verb, InputArguments& input, const std::string& of);

/// Puts options under a heading of their own in the help.
void group(CLI::App& verb, const std::string& heading, std::initializer_list<const char*> options);

/// `count` finite numbers, separated by commas. Throws CLI::ValidationError for `option`.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t count);

void add_report(CLI::App& verb, ReportArguments& report);

using TakeText = std::function<void(const std::string&)>;

/// Adds an option that takes one of these words.
CLI::Option* add_choice(CLI::App& verb, const std::string& option, const std::vector<std::string>& choices,
                        const TakeText& take, const std::string& help);

/// Adds an option whose text `take` reads; an InvalidInput of it names the option, and is an error of usage.
CLI::Option& add_read_option(CLI::App& verb, const std::string& option, const TakeText& take, const std::string& help);

/// Adds --threads; the result must not depend on it.
void add_threads(CLI::App& verb, int& threads);

/// Adds --budget, see parse_budget().
CLI::Option& add_budget(CLI::App& verb, std::optional<Budget>& budget, const std::string& help);

/// Adds options for measuring a surface against another one.
void add_measuring(CLI::App& verb, double& tolerance_mm, std::size_t& samples);

}  // namespace vmesh::tool
