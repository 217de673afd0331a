#include "command_line/parse.h"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "vmesh/core/version.h"

#include "command_line/arguments_help.h"

namespace vmesh::tool {

VerbRegistry& verb_registry() {
  static VerbRegistry verbs;  // in a function, as registrations of other files may come first
  return verbs;
}

std::unique_ptr<Verb> parse_arguments(int argc, const char* const* argv, int& exit_code) {
  CLI::App app("vmesh turns vessel centerlines into surfaces.", "vmesh");
  app.set_version_flag("--version", "vmesh " + std::string(version()));
  app.footer(
      "vmesh VERB --help lists the options of a verb with examples.\n"
      "Exit codes: 0 ok, 1 a requested check failed, 2 usage, 3 bad input, 4 unsupported or not built in,\n"
      "5 cannot write, 6 did not converge, 7 no sound surface was found, 130 interrupted.");
  app.require_subcommand(1);

  std::vector<std::unique_ptr<Verb>> verbs;
  for (const auto& [rank, make] : verb_registry()) verbs.push_back(make());
  for (const auto& verb : verbs) verb->add_to(app);
  HelpArguments help;
  add_help(app, help);
  if (argc > 1 && argv[1][0] != '-') check_verb(app, argv[1]);
  try {
    app.parse(argc, argv);
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
