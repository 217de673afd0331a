// What the command line and the verbs know of each other. A verb registers itself; nothing lists all of them.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "command_line/arguments_common.h"
#include "command_line/console.h"
#include "command_line/exit_code.h"
#include "command_line/inputs.h"

namespace vmesh::tool {

/// A verb with the arguments of one call.
class Verb {
 public:
  virtual ~Verb() = default;
  virtual const char* name() const = 0;
  /// Adds it with its options, help and examples.
  virtual void add_to(CLI::App& app) = 0;
  /// Completes what was parsed, and replaces folders of files with one branch each. Throws UsageError and ReadError.
  virtual void settle() = 0;
  virtual CommonArguments& common() = 0;
  /// How many may work at most; 0: all.
  virtual int threads() const = 0;
  /// Returns the exit code; throws like the library, and UsageError.
  virtual int run(Console& console) const = 0;
};

/// All of a verb. Its arguments have a member `common`; for other members see settle_output(), expand_all_folders().
template <class Arguments>
struct VerbDefinition {
  int rank;  ///< in the list of all verbs
  const char* name;
  const char* help;
  const char* examples;
  bool with_json = true;  ///< whether it writes summaries
  void (*add_options)(CLI::App& verb, Arguments& arguments);
  void (*settle)(Arguments& arguments) = [](Arguments&) {};
  int (*threads)(const Arguments& arguments) = [](const Arguments&) { return 0; };
  int (*run)(const Arguments& arguments, Console& console);
};

template <class Arguments>
class DefinedVerb : public Verb {
 public:
  explicit DefinedVerb(const VerbDefinition<Arguments>& definition) : definition_(definition) {}

  const char* name() const override { return definition_.name; }
  void add_to(CLI::App& app) override {
    CLI::App& verb = *app.add_subcommand(definition_.name, definition_.help);
    definition_.add_options(verb, arguments_);
    add_common(verb, arguments_.common, definition_.with_json);
    verb.footer(definition_.examples);
  }
  void settle() override {
    definition_.settle(arguments_);
    expand_all_folders(arguments_);
  }
  CommonArguments& common() override { return arguments_.common; }
  int threads() const override { return definition_.threads(arguments_); }
  int run(Console& console) const override { return definition_.run(arguments_, console); }

 private:
  VerbDefinition<Arguments> definition_;
  Arguments arguments_;
};

/// Makes every verb, by its rank.
using VerbRegistry = std::multimap<int, std::function<std::unique_ptr<Verb>()>>;
VerbRegistry& verb_registry();

/// A static object of this in a verb's file makes the verb known.
template <class Arguments>
struct VerbRegistration {
  explicit VerbRegistration(const VerbDefinition<Arguments>& definition) {
    verb_registry().emplace(definition.rank,
                            [definition] { return std::make_unique<DefinedVerb<Arguments>>(definition); });
  }
};

}  // namespace vmesh::tool
