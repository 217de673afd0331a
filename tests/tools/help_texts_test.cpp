// What is generated from the help texts: completion and manual pages.
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

class HelpTexts : public CommandTest {
 protected:
  /// As an unknown one is answered: "... The verbs are generate, info, ..."
  std::vector<std::string> verbs() const {
    const std::string answer = vmesh({"nonsense"}).err, start = "The verbs are ";
    std::istringstream list(answer.substr(answer.find(start) + start.size()));
    std::vector<std::string> names;
    for (std::string name; list >> name; names.push_back(name)) {
      if (name.ends_with(',')) name.pop_back();
    }
    EXPECT_GE(names.size(), 18U) << answer;
    return names;
  }
  static bool can_run(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
  }
  /// What `shell` writes into the file "offered" when it runs the script, line by line.
  std::string ran(const std::string& shell, const std::string& script) const {
    write("try", script);
    EXPECT_EQ(std::system((shell + " '" + path("try").string() + "'").c_str()), 0) << script;
    return read("offered");
  }
  /// What bash offers after these words, the last of which is being typed; sorted.
  std::string offered(const std::string& words, int last) const {
    const std::string line = ran("bash", "source '" + path("vmesh").string() + "'; COMP_WORDS=(" + words +
                                             "); COMP_CWORD=" + std::to_string(last) +
                                             "; _vmesh; echo \"${COMPREPLY[*]}\" >'" + path("offered").string() + "'");
    std::istringstream list(line.substr(0, line.find('\n')));
    std::vector<std::string> words_offered{std::istream_iterator<std::string>(list), {}};
    std::sort(words_offered.begin(), words_offered.end());
    std::string sorted;
    for (const std::string& word : words_offered) sorted += (sorted.empty() ? "" : " ") + word;
    return sorted;
  }
  /// What fish offers to complete the line by, without the descriptions.
  std::vector<std::string> offered_by_fish(const std::string& line) const {
    std::istringstream all(ran("fish --no-config", "source '" + path("vmesh.fish").string() + "'; complete -C '" +
                                                       line + "' >'" + path("offered").string() + "'"));
    std::vector<std::string> words;
    for (std::string word; std::getline(all, word);) words.push_back(word.substr(0, word.find('\t')));
    std::sort(words.begin(), words.end());
    return words;
  }
  /// The line as zsh completes it.
  std::string completed_by_zsh(const std::string& line) const {
    const std::string offered = path("offered").string();
    const std::string started = "PROMPT= RPROMPT=; autoload -Uz compinit; compinit -u -D; source '" +
                                path("vmesh.zsh").string() + "'; show() { print -r -- $BUFFER >'" + offered +
                                "'; exit }; zle -N show; bindkey '^I' complete-word; bindkey '^X' show";
    write("offered", "");
    std::string text =
        ran("zsh -f", "zmodload zsh/zpty\nzpty shell zsh -f -i\nzpty -w shell " + quoted(started) +
                          "\nzpty -w -n shell " + quoted(line) + "$'\\t\\x18'\nfor i in {1..200}; do [[ -s '" +
                          offered + "' ]] && break; sleep .1; done\nzpty -d shell\n");
    return text.substr(0, text.find('\n'));
  }
  static std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
  }
  /// Writes files among which some have extensions that vmesh knows; returns their folder.
  std::string folder_of_files() const {
    std::filesystem::create_directories(path("data/deep"));
    for (const char* name : {"only.swc", "only.txt", "only.NII.GZ", "other.json"})
      write(std::string("data/") + name, "");
    return path("data").string() + "/";
  }
};

TEST_F(HelpTexts, BashCompletesVerbsOptionsAndWords) {
  const Outcome run = vmesh({"completion", "bash"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  write("vmesh", run.out);
  EXPECT_EQ(offered("vmesh gen", 1), "generate");
  EXPECT_EQ(offered("vmesh generate --uni", 2), "--unit");
  EXPECT_EQ(offered("vmesh generate --unit m", 3), "m mm");
  EXPECT_EQ(offered("vmesh generate --unit = c", 4), "cm");
  EXPECT_EQ(offered("vmesh completion f", 2), "fish");
}

TEST_F(HelpTexts, BashOffersTheFilesThatAnOptionTakes) {
  write("vmesh", vmesh({"completion", "bash"}).out);
  const std::string data = folder_of_files();
  EXPECT_EQ(offered("vmesh generate " + data + "onl", 2), data + "only.NII.GZ " + data + "only.swc");
  EXPECT_EQ(offered("vmesh generate --json " + data + "o", 3), data + "other.json");
  EXPECT_EQ(offered("vmesh evaluate --report " + data + "o", 3), data + "only.txt " + data + "other.json");
  EXPECT_EQ(offered("vmesh generate --html " + data + "only.", 3),  // there is none
            data + "only.NII.GZ " + data + "only.swc " + data + "only.txt");
  EXPECT_EQ(offered("vmesh split --output " + data, 3), data + "deep");
  EXPECT_EQ(offered("vmesh generate --threads " + data, 3), "");
  EXPECT_EQ(offered("vmesh render --color " + data, 3), "");
}

TEST_F(HelpTexts, FishCompletesVerbsOptionsWordsAndFiles) {
  const Outcome run = vmesh({"completion", "fish"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  write("vmesh.fish", run.out);
  if (!can_run("fish"))
    GTEST_SKIP() << "no fish here: scripts/test installs it (scripts/install-dependencies --with-shells)";
  using Words = std::vector<std::string>;
  EXPECT_EQ(offered_by_fish("vmesh gen"), Words{"generate"});
  EXPECT_EQ(offered_by_fish("vmesh generate --uni"), Words{"--unit"});
  EXPECT_EQ(offered_by_fish("vmesh generate --unit m"), (Words{"m", "mm"}));
  EXPECT_EQ(offered_by_fish("vmesh completion f"), Words{"fish"});
  const std::string data = folder_of_files();
  EXPECT_EQ(offered_by_fish("vmesh generate " + data + "onl"), (Words{data + "only.NII.GZ", data + "only.swc"}));
  EXPECT_EQ(offered_by_fish("vmesh generate --json " + data + "o"), Words{data + "other.json"});
  EXPECT_EQ(offered_by_fish("vmesh generate --html " + data + "only.").size(), 3u);
  EXPECT_EQ(offered_by_fish("vmesh split --output " + data), Words{data + "deep/"});
  EXPECT_EQ(offered_by_fish("vmesh generate --threads "), Words{});
}

TEST_F(HelpTexts, ZshCompletesVerbsOptionsWordsAndFiles) {
  const Outcome run = vmesh({"completion", "zsh"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  write("vmesh.zsh", run.out);
  if (!can_run("zsh"))
    GTEST_SKIP() << "no zsh here: scripts/test installs it (scripts/install-dependencies --with-shells)";
  EXPECT_EQ(completed_by_zsh("vmesh gen"), "vmesh generate ");
  EXPECT_EQ(completed_by_zsh("vmesh generate --output-un"), "vmesh generate --output-unit=");
  EXPECT_EQ(completed_by_zsh("vmesh generate --unit c"), "vmesh generate --unit cm ");
  EXPECT_EQ(completed_by_zsh("vmesh completion f"), "vmesh completion fish ");
  const std::string data = folder_of_files();
  EXPECT_EQ(completed_by_zsh("vmesh generate " + data + "only.s"), "vmesh generate " + data + "only.swc ");
  EXPECT_EQ(completed_by_zsh("vmesh generate --json " + data + "o"), "vmesh generate --json " + data + "other.json ");
  EXPECT_EQ(completed_by_zsh("vmesh split --output " + data), "vmesh split --output " + data + "deep/");
}

TEST_F(HelpTexts, OtherShellsAreAUsageError) { EXPECT_EQ(vmesh({"completion", "tcsh"}).exit_code, 2); }

/// The lines of README.md's section on completion that are commands.
std::string commands_of_readme() {
  std::istringstream lines(read_file(VMESH_TOOLS_README));
  std::string commands;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) inside = line == "## Completion and manual pages";
    if (inside && line.starts_with("    ")) commands += line.substr(4) + "\n";
  }
  return commands;
}

TEST_F(HelpTexts, TheCommandsOfTheReadmeWorkInAnEmptyHome) {
  const std::string commands = commands_of_readme();
  ASSERT_NE(commands.find("vmesh completion bash"), std::string::npos);
  std::filesystem::create_directory(path("home"));
  const std::string folder = std::filesystem::path(VMESH_COMMAND).parent_path().string();
  write("run.bash",
        "set -eu\nexport HOME='" + path("home").string() + "' PATH='" + folder + "':\"$PATH\"\n" + commands);
  EXPECT_EQ(std::system(("env -u XDG_DATA_HOME bash '" + path("run.bash").string() + "'").c_str()), 0) << commands;
  for (const char* made : {"bash-completion/completions/vmesh", "zsh/site-functions/_vmesh", "man/man1/vmesh.1"})
    EXPECT_TRUE(exists(std::string("home/.local/share/") + made)) << made;
  EXPECT_TRUE(exists("home/.config/fish/completions/vmesh.fish"));
}

TEST_F(HelpTexts, EveryVerbHasAPageWithItsOptions) {
  ASSERT_EQ(vmesh({"man", "-o", "@man1"}).exit_code, 0);  // makes the folder
  EXPECT_EQ(vmesh({"man"}).out, read("man1/vmesh.1"));
  for (const std::string& verb : verbs()) {
    const std::string name = "man1/vmesh-" + verb + ".1";
    ASSERT_TRUE(exists(name)) << verb;
    const std::string page = read(name);
    EXPECT_EQ(page, vmesh({"man", verb}).out);
    for (const char* part : {".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION", "\\-\\-help", ".SH EXIT STATUS"})
      EXPECT_NE(page.find(part), std::string::npos) << verb << ' ' << part;
  }
  EXPECT_NE(read("man1/vmesh-generate.1").find("\\-\\-flow\\-extensions"), std::string::npos);
  EXPECT_EQ(vmesh({"man", "nonsense"}).exit_code, 2);
  if (!can_run("groff")) return;
  for (const std::string& verb : verbs()) {
    const std::string page = path("man1/vmesh-" + verb + ".1").string(), said = path("said").string();
    EXPECT_EQ(std::system(("groff -man -ww -Tascii -z '" + page + "' 2>'" + said + "'").c_str()), 0);
    EXPECT_EQ(read("said"), "") << verb;
  }
}

}  // namespace
}  // namespace vmesh::testing
