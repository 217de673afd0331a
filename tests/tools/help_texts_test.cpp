// What is generated from the help texts: completion and manual pages.
#include <cstdlib>
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
  /// What bash offers after these words, the last of which is being typed.
  std::string offered(const std::string& words, int last) const {
    const std::string script = "source '" + path("vmesh").string() + "'; COMP_WORDS=(" + words +
                               "); COMP_CWORD=" + std::to_string(last) + "; _vmesh; echo \"${COMPREPLY[*]}\" >'" +
                               path("offered").string() + "'";
    write("try.bash", script);
    EXPECT_EQ(std::system(("bash '" + path("try.bash").string() + "'").c_str()), 0) << words;
    const std::string line = read("offered");
    return line.substr(0, line.find('\n'));
  }
};

TEST_F(HelpTexts, BashCompletesVerbsOptionsAndWords) {
  const Outcome run = vmesh({"completion", "bash"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  write("vmesh", run.out);
  EXPECT_EQ(offered("vmesh gen", 1), "generate");
  EXPECT_EQ(offered("vmesh generate --uni", 2), "--unit");
  EXPECT_EQ(offered("vmesh generate --unit m", 3), "mm m");
  EXPECT_EQ(offered("vmesh generate --unit = c", 4), "cm");
  write_y("only.swc");
  EXPECT_EQ(offered("vmesh generate " + path("onl").string(), 2), path("only.swc").string());
}

TEST_F(HelpTexts, OtherShellsAreAUsageError) { EXPECT_EQ(vmesh({"completion", "tcsh"}).exit_code, 2); }

TEST_F(HelpTexts, EveryVerbHasAPageWithItsOptions) {
  std::filesystem::create_directory(path("man1"));
  ASSERT_EQ(vmesh({"man", "-o", "@man1"}).exit_code, 0);
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
