#include "command_line/arguments_help.h"

#include <algorithm>
#include <vector>

#include "command_line/completion.h"
#include "command_line/file_types.h"
#include "command_line/manual.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

constexpr const char* kCompletionExamples = R"(Examples:
  source <(vmesh completion bash)
  source <(vmesh completion zsh)
  vmesh completion fish | source)";
constexpr const char* kManualExamples = R"(Examples:
  vmesh man generate | man -l -
  vmesh man -o ~/.local/share/man/man1)";

/// How many letters must be inserted, removed or replaced to turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

void add_help(CLI::App& app, HelpArguments& arguments) {
  CLI::App& completion = *app.add_subcommand("completion", "Print a script that lets a shell complete vmesh's words");
  completion.add_option("SHELL", arguments.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion.footer(kCompletionExamples);
  CLI::App& manual = *app.add_subcommand("man", "Print a manual page");
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  manual.add_option("VERB", arguments.verb, "of this verb; without, of vmesh itself")->check(CLI::IsMember(verbs));
  manual
      .add_option("-o,--output", arguments.folder, "write all pages into this folder instead, which is made if need be")
      ->type_name(kFolder);
  manual.footer(kManualExamples);
}

void check_verb(const CLI::App& app, std::string_view word) {
  std::string nearest, all;
  std::size_t least = word.size() / 2 + 1;  // beyond that, no suggestion
  for (const CLI::App* verb : app.get_subcommands({})) {
    const std::string& name = verb->get_name();
    if (name == word) return;
    const std::size_t distance = name.starts_with(word) ? 0 : edit_distance(word, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
    all += (all.empty() ? "" : ", ") + name;
  }
  throw UsageError("there is no verb " + std::string(word) +
                   (nearest.empty() ? "" : "; did you mean " + nearest + "?") + (nearest.empty() ? "; " : " ") +
                   "The verbs are " + all);
}

bool ran_help(const CLI::App& app, const HelpArguments& arguments) {
  if (app.got_subcommand("completion")) {
    write_text("-", arguments.shell == "zsh"    ? zsh_completion(app)
                    : arguments.shell == "fish" ? fish_completion(app)
                                                : bash_completion(app));
  } else if (app.got_subcommand("man")) {
    if (!arguments.folder.empty()) {
      write_manual_pages(app, arguments.folder);
    } else {
      write_text("-", manual_page(app, arguments.verb.empty() ? nullptr : app.get_subcommand(arguments.verb)));
    }
  } else {
    return false;
  }
  return true;
}

}  // namespace vmesh::tool
