#include "command_line/completion.h"

#include <algorithm>
#include <sstream>

#include "vmesh/image/image_io.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/parts/part_files.h"

#include "command_line/file_types.h"

namespace vmesh::tool {
namespace {

bool takes_value(const CLI::Option& option) { return option.get_type_size() != 0; }

std::string joined(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// What can follow an option, or stand for an argument without one.
struct Values {
  enum class Kind { none, words, files, folders };
  Kind kind = Kind::none;
  std::vector<std::string> words;  // or the extensions of the files
};

template <class Wanted>
std::vector<std::string> known_extensions(Wanted wanted) {
  std::vector<std::string> all;
  const auto add = [&](const auto& formats) {
    for (const std::string& extension : extensions_of(formats, wanted)) {
      if (std::ranges::find(all, extension) == all.end()) all.push_back(extension);
    }
  };
  add(centerline_formats());
  add(surface_formats());
  add(image_formats());
  return all;
}

/// ".txt", ".md" of "FILE.txt|.md".
std::vector<std::string> listed_extensions(const std::string& type) {
  std::istringstream list(type.substr(std::string(kFile).size()));
  std::vector<std::string> extensions;
  for (std::string extension; std::getline(list, extension, '|');) extensions.push_back(extension);
  return extensions;
}

std::vector<std::string> extensions_of_type(const std::string& type) {
  const auto is_written = [](const auto& format) { return format.is_written(); };
  if (type == kVolumeFile) return extensions_of(volume_formats(), is_written);
  if (type == kSurfaceFile) return extensions_of(surface_formats(), is_written);
  if (type == kCenterlineFile) return extensions_of(centerline_formats(), is_written);
  std::vector<std::string> extensions = listed_extensions(type);
  if (!extensions.empty()) return extensions;
  extensions = known_extensions([](const auto&) { return true; });
  extensions.push_back(kPartExtension);
  return extensions;
}

Values values_of(const CLI::Option& option) {
  if (!takes_value(option)) return {};
  if (std::vector<std::string> choices = choices_of(option); !choices.empty())
    return {Values::Kind::words, std::move(choices)};
  std::string type = option.get_type_name();
  if (type == "TEXT") type = kFile;  // as of paths by default; other options have other names
  if (type == kFolder) return {Values::Kind::folders, {}};
  if (type.starts_with(kFile) || type == kSurfaceFile || type == kCenterlineFile || type == kVolumeFile)
    return {Values::Kind::files, extensions_of_type(type)};
  return {};
}

/// Of all arguments without an option.
Values values_of_positionals(const CLI::App& verb) {
  Values all;
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) continue;
    Values values = values_of(*option);
    if (all.kind == Values::Kind::none || all.kind == Values::Kind::folders) all.kind = values.kind;
    for (std::string& word : values.words) {
      if (std::ranges::find(all.words, word) == all.words.end()) all.words.push_back(std::move(word));
    }
  }
  return all;
}

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> all;
  for (const CLI::Option* option : verb.get_options()) {
    for (std::string& name : names_of(*option)) all.push_back(std::move(name));
  }
  return all;
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  return verbs;
}

/// The first line of a help text.
std::string summary_of(const std::string& help) { return help.substr(0, help.find_first_of(";\n")); }

/// Sets one of the variables of the script for bash.
std::string bash_assignment(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return "words=\"" + joined(values.words, " ") + "\"";
    case Values::Kind::files:
      return "files=\"" + joined(values.words, " ") + "\"";
    case Values::Kind::folders:
      return "folders=1";
    case Values::Kind::none:
      break;
  }
  return "return";
}

/// "    generate:--unit) words=\"um mm cm m\" ;;": the values of an option.
std::string bash_case(const CLI::App& verb, const CLI::Option& option) {
  if (!option.nonpositional() || !takes_value(option)) return {};
  std::vector<std::string> patterns;
  for (const std::string& name : names_of(option)) patterns.push_back(verb.get_name() + ":" + name);
  return "    " + joined(patterns, "|") + ") " + bash_assignment(values_of(option)) + " ;;\n";
}

std::string zsh_quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

std::string zsh_help(const CLI::Option& option) {
  std::string text = summary_of(option.get_description());
  for (const char* special : {"\\", "[", "]", ":"}) text = replaced(text, special, std::string("\\") + special);
  return text;
}

/// ":FILE:_files ...": what `_arguments` completes a value by.
std::string zsh_action(const Values& values) {
  std::vector<std::string> names;
  switch (values.kind) {
    case Values::Kind::words:
      return ":word:(" + joined(values.words, " ") + ")";
    case Values::Kind::files:
      for (const std::string& extension : values.words) names.push_back(extension.substr(1));
      // In parentheses alone, a name would be taken for qualifiers.
      return ":file:_files -g \"*.(#i)" + (names.size() == 1 ? names[0] : "(" + joined(names, "|") + ")") + "\"";
    case Values::Kind::folders:
      return ":folder:_files -/";
    case Values::Kind::none:
      break;
  }
  return ":value: ";
}

/// "      '(-o --output)'{-o,--output=}'[surface]:file:_files ...' \".
std::string zsh_option(const CLI::Option& option) {
  std::vector<std::string> names = names_of(option), patterns;
  if (names.empty()) return {};
  const bool has_value = takes_value(option);
  for (const std::string& name : names) patterns.push_back(name + (has_value && name.starts_with("--") ? "=" : ""));
  const std::string pattern = patterns.size() == 1 ? patterns.front() : "{" + joined(patterns, ",") + "}";
  return "        " + zsh_quoted("(" + joined(names, " ") + ")") + pattern +
         zsh_quoted("[" + zsh_help(option) + "]" + (has_value ? zsh_action(values_of(option)) : "")) + " \\\n";
}

std::string zsh_case(const CLI::App& verb) {
  std::string text = "    " + verb.get_name() + ")\n      _arguments -s \\\n";
  for (const CLI::Option* option : verb.get_options()) text += zsh_option(*option);
  const Values values = values_of_positionals(verb);
  return text + "        " + (values.kind == Values::Kind::none ? "" : zsh_quoted("*" + zsh_action(values))) + " ;;\n";
}

std::string fish_quoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// The options of fish's `complete` for a value.
std::string fish_values(const Values& values) {
  switch (values.kind) {
    case Values::Kind::words:
      return " -x -a " + fish_quoted(joined(values.words, " "));
    case Values::Kind::files:
      return " -x -a " + fish_quoted("(__vmesh_files " + joined(values.words, " ") + ")");
    case Values::Kind::folders:
      return " -x -a '(__fish_complete_directories (commandline -ct))'";
    case Values::Kind::none:
      break;
  }
  return " -x";
}

std::string fish_lines(const CLI::App& verb) {
  const std::string start = "complete -c vmesh -n '__vmesh_verb_is " + verb.get_name() + "'";
  std::string text;
  for (const CLI::Option* option : verb.get_options()) {
    std::string names;
    for (const std::string& name : option->get_snames()) names += " -s " + name;
    for (const std::string& name : option->get_lnames()) names += " -l " + name;
    if (names.empty()) continue;
    text += start + names + (takes_value(*option) ? fish_values(values_of(*option)) : "") + " -d " +
            fish_quoted(summary_of(option->get_description())) + "\n";
  }
  const Values values = values_of_positionals(verb);
  return text + (values.kind == Values::Kind::none ? "" : start + fish_values(values) + "\n");
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
  std::string values, options, positionals;
  for (const CLI::App* verb : app.get_subcommands({})) {
    const std::string start = "        " + verb->get_name() + ") ";
    for (const CLI::Option* option : verb->get_options()) values += bash_case(*verb, *option);
    options += start + "words=\"" + joined(options_of(*verb), " ") + "\" ;;\n";
    positionals += start + bash_assignment(values_of_positionals(*verb)) + " ;;\n";
  }
  return R"(# Completion of vmesh for bash, as "vmesh completion bash" prints it.

# Completes folders, and files with these extensions; all files if there is none.
_vmesh_files() {
  local names name extension fits=
  mapfile -t names < <(compgen -f -- "$1")
  COMPREPLY=()
  for name in "${names[@]}"; do
    if [[ -d ${name/#\~/$HOME} ]]; then
      COMPREPLY+=("$name")
      continue
    fi
    for extension in $2; do
      if [[ ${name,,} == *"$extension" ]]; then
        COMPREPLY+=("$name")
        fits=1
        break
      fi
    done
  done
  [[ -n $fits ]] || COMPREPLY=("${names[@]}")
}

_vmesh() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words= files= folders=
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W ")" +
         joined(verbs_of(app), " ") + " " + joined(options_of(app), " ") + R"(" -- "$word")
    return
  fi
  # --unit=mm comes as three words.
  [[ $word == "=" ]] && word=
  [[ $before == "=" ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  case ${COMP_WORDS[1]}:$before in
)" + values +
         R"(  esac
  if [[ -z $words$files$folders ]]; then
    if [[ $word == -* ]]; then
      case ${COMP_WORDS[1]} in
)" + options +
         R"(      esac
    else
      case ${COMP_WORDS[1]} in
)" + positionals +
         R"(      esac
    fi
  fi
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    return
  fi
  compopt -o filenames 2>/dev/null
  if [[ -n $folders ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
  else
    _vmesh_files "$word" "$files"
  fi
}
complete -F _vmesh vmesh
)";
}

std::string zsh_completion(const CLI::App& app) {
  std::string verbs, options, cases;
  for (const CLI::Option* option : app.get_options()) options += zsh_option(*option);
  for (const CLI::App* verb : app.get_subcommands({})) {
    verbs += "        " + zsh_quoted(verb->get_name() + ":" + replaced(verb->get_description(), ":", "\\:")) + "\n";
    cases += zsh_case(*verb);
  }
  return R"(#compdef vmesh
# Completion of vmesh for zsh, as "vmesh completion zsh" prints it.

_vmesh() {
  if ((CURRENT == 2)); then
    if [[ $words[2] == -* ]]; then
      _arguments \
)" + options +
         R"(        && return
    fi
    local -a verbs
    verbs=(
)" + verbs +
         R"(    )
    _describe verb verbs
    return
  fi
  shift words
  ((CURRENT--))
  case $words[1] in
)" + cases +
         R"(  esac
}

# Read by compinit, or by source.
if [[ $funcstack[1] == _vmesh ]]; then
  _vmesh "$@"
else
  compdef _vmesh vmesh
fi
)";
}

std::string fish_completion(const CLI::App& app) {
  std::string text = R"(# Completion of vmesh for fish, as "vmesh completion fish" prints it.

function __vmesh_files --description 'Folders, and files with these extensions; all files if there is none'
    set -l all (__fish_complete_path (commandline -ct))
    set -l ends (string escape --style=regex -- $argv)
    set -l fitting (string match -r -i '^[^\t]*(?:/|'(string join '|' -- $ends)')(?:\t.*)?$' -- $all)
    if test (count (string match -v -r '/(?:\t.*)?$' -- $fitting)) -gt 0
        string join \n -- $fitting
    else
        string join \n -- $all
    end
end

function __vmesh_verb_is
    set -l words (commandline -opc)
    test "$words[2]" = "$argv[1]"
end

function __vmesh_needs_verb
    test (count (commandline -opc)) -eq 1
end

complete -c vmesh -f
)";
  for (const CLI::App* verb : app.get_subcommands({})) {
    text += "complete -c vmesh -n __vmesh_needs_verb -a " + verb->get_name() + " -d " +
            fish_quoted(verb->get_description()) + "\n";
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      text += "complete -c vmesh -n __vmesh_needs_verb -l " + name + " -d " +
              fish_quoted(summary_of(option->get_description())) + "\n";
    }
  }
  for (const CLI::App* verb : app.get_subcommands({})) text += fish_lines(*verb);
  return text;
}

}  // namespace vmesh::tool
