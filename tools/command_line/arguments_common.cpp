#include "command_line/arguments_common.h"

namespace vmesh::tool {

void add_common(CLI::App& verb, CommonArguments& common, bool with_json) {
  verb.add_flag("-q,--quiet", common.quiet, "only warnings and errors on stderr");
  if (with_json) verb.add_option("--json", common.json, "write a summary to this file; - for stdout");
}

void add_output(CLI::App& verb, std::filesystem::path& output, const std::string& help) {
  verb.add_option("-o,--output", output, help)->required();
}

void add_reading(CLI::App& verb, InputArguments& input, const std::string& of) {
  verb.add_option_function<std::string>(
          "--" + of + "unit", [&input](const std::string& text) { input.unit = parse_length_unit(text); },
          "unit of the numbers in the file; overrides what the file says")
      ->check(CLI::IsMember({"um", "mm", "cm", "m"}));
  verb.add_option_function<std::string>(
          "--" + of + "space", [&input](const std::string& text) { input.space = parse_space(text); },
          "patient frame of the file; overrides what the file says")
      ->check(CLI::IsMember({"LPS", "RAS"}));
}

void add_input(CLI::App& verb, InputArguments& input, const std::string& help) {
  verb.add_option("IN", input.path, help)->required();
  add_reading(verb, input, "");
}

void add_report(CLI::App& verb, std::filesystem::path& report, std::string& format) {
  verb.add_option("--report", report, "write the report to this file too (.txt, .md, .csv, .json)");
  verb.add_option("--format", format, "of the report on stdout")
      ->check(CLI::IsMember({"text", "markdown", "csv"}))
      ->capture_default_str();
}

void add_measuring(CLI::App& verb, double& tolerance_mm, std::size_t& samples) {
  verb.add_option("--tolerance", tolerance_mm, "width of the interval that holds a Hausdorff distance, mm")
      ->check(in_range(1e-12, 1e6))
      ->capture_default_str();
  verb.add_option("--samples", samples, "points on each surface for mean, RMS and percentiles")
      ->check(in_range<std::size_t>(1, 10'000'000))
      ->capture_default_str();
}

}  // namespace vmesh::tool
