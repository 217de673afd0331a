#include "command_line/parse.h"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "vmesh/core/version.h"

#include "command_line/arguments_help.h"
#include "command_line/execution_model.h"
#include "command_line/outputs.h"

namespace vmesh::tool {

VerbRegistry& verb_registry() {
  static VerbRegistry verbs;  // in a function, as registrations of other files may come first
  return verbs;
}

namespace {

constexpr const char* kDescriptionFlag = "--xml";

/// --xml VERB; throws UsageError for what is none.
void print_execution_model(const CLI::App& app, const std::vector<std::unique_ptr<Verb>>& verbs,
                           const std::vector<std::string>& words) {
  if (words.size() != 3) throw UsageError("name one verb to describe: vmesh --xml generate");
  check_verb(app, words[2]);
  if (std::none_of(verbs.begin(), verbs.end(), [&](const auto& verb) { return verb->name() == words[2]; }))
    throw UsageError("--xml: " + words[2] + " makes nothing that 3D Slicer could use");
  write_text("-", execution_model(*app.get_subcommand(words[2])));
}

std::vector<const char*> pointers_to(const std::vector<std::string>& words) {
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  return pointers;
}

}  // namespace

std::unique_ptr<Verb> parse_arguments(int argc, const char* const* argv, int& exit_code) {
  CLI::App app("vmesh turns vessel centerlines into surfaces.", "vmesh");
  app.set_version_flag("--version", "vmesh " + std::string(version()));
  app.footer(
      "vmesh VERB --help lists the options of a verb with examples.\n"
      "Exit codes: 0 ok, 1 a requested check failed, 2 usage, 3 bad input, 4 unsupported or not built in,\n"
      "5 cannot write, 6 did not converge, 7 no sound surface was found, 130 interrupted.");
  app.require_subcommand(1);
  app.add_option(kDescriptionFlag, "describe a verb for 3D Slicer (execution model, XML), which makes a panel of it")
      ->type_name("VERB");

  std::vector<std::unique_ptr<Verb>> verbs;
  for (const auto& [rank, make] : verb_registry()) verbs.push_back(make());
  for (const auto& verb : verbs) verb->add_to(app);
  HelpArguments help;
  add_help(app, help);
  if (argc > 1 && argv[1][0] != '-') check_verb(app, argv[1]);
  const std::vector<std::string> words = without_defaults(app, {argv, argv + argc});
  if (argc > 1 && words[1] == kDescriptionFlag) {
    print_execution_model(app, verbs, words);
    exit_code = kOk;
    return nullptr;
  }
  try {
    app.parse(argc > 0 ? static_cast<int>(words.size()) : 0, pointers_to(words).data());
  } catch (const CLI::ParseError& error) {
    std::ostringstream complaint;  // may quote what was typed
    // CLI11's own codes run from 100 to 127.
    exit_code = app.exit(error, std::cout, complaint) == 0 ? kOk : kUsage;
    std::istringstream lines(complaint.str());
    for (std::string line; std::getline(lines, line);) std::cerr << printable(line) << "\n";
    return nullptr;
  }
  exit_code = kOk;
  if (ran_help(app, help)) return nullptr;
  auto called =
      std::find_if(verbs.begin(), verbs.end(), [&](const auto& verb) { return app.got_subcommand(verb->name()); });
  (*called)->settle();
  return std::move(*called);
}

}  // namespace vmesh::tool
