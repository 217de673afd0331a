#include "command_line/manual.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "vmesh/core/version.h"

#include "command_line/completion.h"
#include "command_line/outputs.h"

namespace vmesh::tool {
namespace {

/// Text escaped for roff: copyable hyphens, no accidental requests.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fP"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fP"; }

/// In capitals, for section titles.
std::string capitals(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string header(const std::string& name, const std::string& description) {
  return ".TH " + escaped(capitals(name)) + " 1 \"\" \"vmesh " + std::string(version()) +
         "\" \"vmesh manual\"\n.SH NAME\n" + escaped(name) + " \\- " + escaped(description) + "\n";
}

/// What follows an option on the command line: "{um,mm,cm,m}", "INT", "X,Y,Z".
std::string value_of(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  std::string type = option.get_type_name();
  if (const std::size_t brace = type.find('{'); brace != std::string::npos) return type.substr(brace);
  return type == "TEXT" ? "FILE" : type.substr(0, type.find(':'));
}

/// The range and the default of an option, in brackets.
std::string limits_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::string text;
  if (const std::size_t range = type.find(":in ["); range != std::string::npos) text = type.substr(range + 1);
  if (option.get_type_size() != 0 && !option.get_default_str().empty())
    text += (text.empty() ? "" : "; ") + ("default " + option.get_default_str());
  return text.empty() ? "" : " (" + text + ")";
}

std::string entry_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : names_of(option)) names += (names.empty() ? "" : ", ") + bold(name);
  const std::string value = value_of(option);
  return ".TP\n" + names + (value.empty() ? "" : " " + italic(value)) + "\n" +
         escaped(option.get_description() + limits_of(option)) + "\n";
}

std::string positionals_of(const CLI::App& verb) {
  std::string text;
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional() || option->nonpositional()) continue;
    text += ".TP\n" + italic(option->get_name(true)) + "\n" + escaped(option->get_description()) + "\n";
  }
  return text;
}

/// A section for each group of the help.
std::string option_paragraphs(const CLI::App& verb) {
  std::string text;
  for (const std::string& group : verb.get_groups()) {
    std::string entries;
    for (const CLI::Option* option : verb.get_options()) {
      if (option->get_group() == group && option->nonpositional()) entries += entry_of(*option);
    }
    if (!entries.empty()) text += ".SH " + escaped(capitals(group)) + "\n" + entries;
  }
  return text;
}

/// The "Examples:" of a verb, with lines kept as they are.
std::string examples_of(const CLI::App& verb) {
  std::istringstream footer(verb.get_footer());
  std::string text, line;
  std::getline(footer, line);
  while (std::getline(footer, line)) {
    line.erase(0, line.find_first_not_of(' '));
    text += escaped(line) + "\n";
  }
  return text.empty() ? "" : ".SH EXAMPLES\n.nf\n" + text + ".fi\n";
}

std::string synopsis_of(const CLI::App& verb) {
  std::string text = ".SH SYNOPSIS\n" + bold("vmesh " + verb.get_name()) + " [" + italic("OPTIONS") + "]";
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = italic(option->get_name(true)) + (option->get_expected_max() > 1 ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + "\n";
}

std::string exit_status() {
  constexpr std::pair<const char*, const char*> kCodes[] = {
      {"0", "done"},
      {"1", "a requested check failed (--check, --require)"},
      {"2", "the command line is wrong"},
      {"3", "an input is missing or wrong"},
      {"4", "unsupported, not built in, or not enough memory"},
      {"5", "an output cannot be written"},
      {"6", "--max-error is not proven everywhere, or the --budget cannot be met"},
      {"7", "no sound surface was found; nothing was written"},
      {"70", "a defect of vmesh"},
      {"130", "interrupted; nothing was written"}};
  std::string text = ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kCodes) text += ".TP\n" + bold(code) + "\n" + escaped(meaning) + "\n";
  return text;
}

std::string page_of_verb(const CLI::App& verb) {
  return header("vmesh-" + verb.get_name(), verb.get_description()) + synopsis_of(verb) + ".SH DESCRIPTION\n" +
         escaped(verb.get_description()) + ".\n" + positionals_of(verb) + option_paragraphs(verb) + examples_of(verb) +
         exit_status() + ".SH SEE ALSO\n.BR vmesh (1)\n";
}

std::string page_of_command(const CLI::App& app) {
  std::string verbs, pages;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs += ".TP\n" + bold(verb->get_name()) + "\n" + escaped(verb->get_description()) + "\n";
    pages += std::string(pages.empty() ? "" : " ,\n") + ".BR vmesh\\-" + escaped(verb->get_name()) + " (1)";
  }
  return header("vmesh", "vessel centerlines to surfaces") + ".SH SYNOPSIS\n" + bold("vmesh") + " " + italic("VERB") +
         " [" + italic("OPTIONS") + "]\n.SH DESCRIPTION\n" + escaped(app.get_description()) + "\n.SH VERBS\n" + verbs +
         option_paragraphs(app) + exit_status() + ".SH SEE ALSO\n" + pages + "\n";
}

}  // namespace

std::string manual_page(const CLI::App& app, const CLI::App* verb) {
  return verb == nullptr ? page_of_command(app) : page_of_verb(*verb);
}

void write_manual_pages(const CLI::App& app, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw WriteError(folder.string() + ": the folder cannot be made: " + error.message());
  write_text(folder / "vmesh.1", manual_page(app));
  for (const CLI::App* verb : app.get_subcommands({}))
    write_text(folder / ("vmesh-" + verb->get_name() + ".1"), manual_page(app, verb));
}

}  // namespace vmesh::tool
