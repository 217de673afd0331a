#include "command_line/execution_model.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "vmesh/core/text.h"
#include "vmesh/core/version.h"

#include "command_line/completion.h"
#include "command_line/file_types.h"

namespace vmesh::tool {
namespace {

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

/// One parameter of the model, its children in the order that the schema demands.
struct Parameter {
  std::string element;
  std::string attributes;  // with a blank before each
  std::string name;        // an identifier
  std::string place;       // <longflag> or <index>
  std::string description;
  std::optional<std::string> default_value;
  std::string channel;      // of files
  std::string constraints;  // or the elements of an enumeration
};

constexpr std::string_view kXml = "&<>\"";

std::string tagged(const std::string& tag, const std::string& text) {
  return "<" + tag + ">" + xml_escaped(text, kXml) + "</" + tag + ">";
}

std::string with_replaced(std::string text, char from, char to) {
  std::replace(text.begin(), text.end(), from, to);
  return text;
}

/// "Max error" of "max_error".
std::string label_of(const std::string& name) {
  std::string label = with_replaced(name, '_', ' ');
  if (!label.empty()) label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

/// The ends of ":in [3, 200]" in a type's name.
std::optional<std::array<std::string, 2>> limits_in(const std::string& type) {
  const std::string start = ":in [";
  const std::size_t begin = type.find(start);
  if (begin == std::string::npos) return {};
  const std::size_t comma = type.find(", ", begin), end = type.find(']', begin);
  if (comma == std::string::npos || end == std::string::npos) return {};
  return std::array{type.substr(begin + start.size(), comma - begin - start.size()),
                    type.substr(comma + 2, end - comma - 2)};
}

/// Numbers without limits of their own have those of the ints that Slicer keeps them in.
std::string constraints_of(const std::string& type, bool is_whole) {
  auto limits = limits_in(type);
  if (!limits && type.starts_with("UINT")) limits = std::array<std::string, 2>{"0", "2147483647"};
  return "<constraints>" +
         (limits ? tagged("minimum", (*limits)[0]) + tagged("maximum", (*limits)[1]) : std::string()) +
         tagged("step", is_whole ? "1" : "0.01") + "</constraints>";
}

void describe_choice(const std::vector<std::string>& choices, const std::string& default_value, Parameter& parameter) {
  parameter.element = "string-enumeration";
  parameter.default_value = default_value;
  for (const std::string& choice : choices) parameter.constraints += tagged("element", choice);
}

/// False if it is none with a default, which Slicer would have no value for.
bool described_as_number(const CLI::Option& option, Parameter& parameter) {
  const std::string type = option.get_type_name(), number = type.substr(0, type.find(':'));
  const bool is_whole = number == "INT" || number == "UINT";
  if (option.get_default_str().empty() || (!is_whole && number != "FLOAT")) return false;
  parameter.element = is_whole ? "integer" : "double";
  parameter.default_value = option.get_default_str();
  parameter.constraints = constraints_of(type, is_whole);
  return true;
}

/// Surfaces become models of the scene, by way of a .vtp; other files are named.
bool described_as_file(const CLI::Option& option, Parameter& parameter) {
  const std::string type = option.get_type_name();
  const bool is_surface = type == kSurfaceFile;
  const bool is_written = is_surface || type == kCenterlineFile || type == kVolumeFile;
  const bool is_output = is_written || (option.check_lname("output") || type.starts_with("FILE."));
  if (type == kFolder) {
    parameter.element = "directory";
  } else if (is_surface) {
    parameter.element = "geometry";
    parameter.attributes = " type=\"model\" fileExtensions=\".vtp\"";
  } else if (is_written || type.starts_with(kFile) || type == "TEXT") {
    parameter.element = "file";
  } else {
    return false;
  }
  parameter.channel = is_output ? "output" : "input";
  return true;
}

void describe_value(const CLI::Option& option, Parameter& parameter) {
  const std::vector<std::string> choices = choices_of(option);
  if (is_flag(option)) {
    parameter.element = "boolean";
    parameter.default_value = "false";
  } else if (!choices.empty() && !option.get_default_str().empty()) {
    describe_choice(choices, option.get_default_str(), parameter);
  } else if (!choices.empty()) {
    parameter.element = "string";
    parameter.description += " (";
    for (const std::string& choice : choices) parameter.description += (&choice == &choices[0] ? "" : ", ") + choice;
    parameter.description += "; empty: not given)";
  } else if (!described_as_number(option, parameter) && !described_as_file(option, parameter)) {
    parameter.element = "string";
    if (!option.get_default_str().empty()) parameter.description += " (default " + option.get_default_str() + ")";
  }
}

/// None for what Slicer has no use for, or could not leave out: words that may be missing.
std::optional<Parameter> parameter_of(const CLI::Option& option, int& next_index) {
  const std::vector<std::string>& names = option.get_lnames();
  const std::string flag = names.empty() ? "" : "--" + names.front();
  if (flag == "--help" || flag == "--quiet" || flag == kSlicerFlag) return {};
  if (names.empty() && !option.get_required()) return {};
  Parameter parameter;
  parameter.description = option.get_description();
  if (names.empty()) {
    std::string word = option.get_name(true);
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    parameter.name = word;
    parameter.place = tagged("index", std::to_string(next_index++));
  } else {
    parameter.name = with_replaced(names.front(), '-', '_');
    parameter.place = tagged("longflag", "--" + parameter.name);
  }
  describe_value(option, parameter);
  return parameter;
}

std::string element_of(const Parameter& parameter) {
  std::string text = "    <" + parameter.element + parameter.attributes + ">\n";
  const auto add = [&text](const std::string& line) {
    if (!line.empty()) text += "      " + line + "\n";
  };
  add(tagged("name", parameter.name));
  add(parameter.place);
  add(tagged("description", parameter.description));
  add(tagged("label", label_of(parameter.name)));
  add(parameter.default_value ? tagged("default", *parameter.default_value) : "");
  add(parameter.channel.empty() ? "" : tagged("channel", parameter.channel));
  add(parameter.constraints);
  return text + "    </" + parameter.element + ">\n";
}

/// A group of the help, or the words without options; empty if there is nothing in it.
std::string group_of(const std::string& title, const std::string& elements, bool is_advanced) {
  if (elements.empty()) return {};
  return std::string("  <parameters") + (is_advanced ? " advanced=\"true\"" : "") + ">\n    " + tagged("label", title) +
         "\n    " + tagged("description", title) + "\n" + elements + "  </parameters>\n";
}

std::string all_groups(const CLI::App& verb) {
  int next_index = 0;
  std::string files, groups;
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_lnames().empty()) continue;
    if (const auto parameter = parameter_of(*option, next_index)) files += element_of(*parameter);
  }
  for (const std::string& group : verb.get_groups()) {
    std::string elements;
    for (const CLI::Option* option : verb.get_options()) {
      if (option->get_group() != group || option->get_lnames().empty()) continue;
      if (const auto parameter = parameter_of(*option, next_index)) elements += element_of(*parameter);
    }
    groups += group_of(group, elements, group != "Options");
  }
  return group_of("Files", files, false) + groups;
}

bool is_same_value(const std::string& a, const std::string& b) {
  if (a == b) return true;
  double x = 0, y = 0;
  return CLI::detail::lexical_cast(a, x) && CLI::detail::lexical_cast(b, y) && x == y;
}

/// "--max-error" of "--max_error"; other words as they are.
std::string option_name(const std::string& word) {
  if (!word.starts_with("--")) return word;
  const std::size_t end = std::min(word.find('='), word.size());
  return with_replaced(word.substr(0, end), '_', '-') + word.substr(end);
}

}  // namespace

std::string execution_model(const CLI::App& verb) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<executable>\n  " + tagged("category", "vmesh") + "\n  " +
         tagged("title", "vmesh " + verb.get_name()) + "\n  " + tagged("description", verb.get_description()) + "\n  " +
         tagged("version", std::string(version())) + "\n  " + tagged("license", "GPL-3.0-or-later") + "\n" +
         all_groups(verb) + "</executable>\n";
}

std::vector<std::string> without_defaults(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.size() < 2 || words[1].starts_with('-') ||
      std::find(words.begin(), words.end(), kSlicerFlag) == words.end())
    return words;
  const CLI::App* verb = app.get_subcommand(words[1]);
  std::vector<std::string> kept(words.begin(), words.begin() + 2);
  for (std::size_t i = 2; i < words.size(); ++i) {
    const std::string name = option_name(words[i]);
    const CLI::Option* option = name.starts_with("--") ? verb->get_option_no_throw(name) : nullptr;
    const bool has_default = option != nullptr && !is_flag(*option) && !option->get_default_str().empty();
    if (has_default && i + 1 < words.size() && is_same_value(words[i + 1], option->get_default_str())) {
      ++i;
    } else {
      kept.push_back(name);
    }
  }
  return kept;
}

}  // namespace vmesh::tool
