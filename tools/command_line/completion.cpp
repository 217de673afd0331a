#include "command_line/completion.h"

#include <sstream>

namespace vmesh::tool {
namespace {

bool takes_value(const CLI::Option& option) { return option.get_type_size() != 0; }

/// A plain TEXT type is a path; numbers and choices have other type names.
bool takes_file(const CLI::Option& option) { return takes_value(option) && option.get_type_name() == "TEXT"; }

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// "    generate:--unit) words=\"um mm cm m\" ;;": the values of an option.
std::string case_of(const CLI::App& verb, const CLI::Option& option) {
  if (!option.nonpositional() || !takes_value(option) || takes_file(option)) return {};
  std::vector<std::string> patterns;
  for (const std::string& name : names_of(option)) patterns.push_back(verb.get_name() + ":" + name);
  const std::vector<std::string> choices = choices_of(option);
  const std::string action = choices.empty() ? "return" : "words=\"" + joined(choices, " ") + "\"";
  return "    " + joined(patterns, "|") + ") " + action + " ;;\n";
}

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> all;
  for (const CLI::Option* option : verb.get_options()) {
    for (std::string& name : names_of(*option)) all.push_back(std::move(name));
  }
  return all;
}

/// The choices of a verb's positional argument, where others take a file.
std::vector<std::string> words_of(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional()) return choices_of(*option);
  }
  return {};
}

}  // namespace

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> choices;
  if (begin == std::string::npos || end == std::string::npos) return choices;
  std::istringstream list(type.substr(begin + 1, end - begin - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> verbs;
  std::string values, options, words;
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs.push_back(verb->get_name());
    for (const CLI::Option* option : verb->get_options()) values += case_of(*verb, *option);
    options += "      " + verb->get_name() + ") words=\"" + joined(options_of(*verb), " ") + "\" ;;\n";
    if (const auto choices = words_of(*verb); !choices.empty())
      words += "      " + verb->get_name() + ") words=\"" + joined(choices, " ") + "\" ;;\n";
  }
  return R"(# Completion of vmesh for bash, as "vmesh completion bash" prints it.
_vmesh() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W ")" +
         joined(verbs, " ") + " " + joined(options_of(app), " ") + R"(" -- "$word")
    return
  fi
  # --unit=mm comes as three words.
  [[ $word == "=" ]] && word=
  [[ $before == "=" ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  case ${COMP_WORDS[1]}:$before in
)" + values +
         R"(  esac
  if [[ -z $words && $word == -* ]]; then
    case ${COMP_WORDS[1]} in
)" + options +
         R"(    esac
  elif [[ -z $words ]]; then
    case ${COMP_WORDS[1]} in
)" + words +
         R"(    esac
  fi
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -F _vmesh vmesh
)";
}

}  // namespace vmesh::tool
