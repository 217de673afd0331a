// What 3D Slicer is told of verbs, and how it calls them. The order of elements is that of CTK's schema for command
// line modules (ctkCmdLineModule.xsd).
#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <pugixml.hpp>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

const std::map<std::string, std::string> kAttributes{{"boolean", ""},
                                                     {"integer", ""},
                                                     {"double", ""},
                                                     {"string", ""},
                                                     {"string-enumeration", ""},
                                                     {"file", ""},
                                                     {"directory", ""},
                                                     {"geometry", "fileExtensions type"}};

std::vector<std::string> child_names(const pugi::xml_node& node) {
  std::vector<std::string> names;
  for (const pugi::xml_node& child : node.children()) names.emplace_back(child.name());
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += word + " ";
  return text;
}

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_match(text, std::regex(pattern));
}

class ExecutionModel : public CommandTest {
 protected:
  /// All that Slicer can call: those of the list whose description is not refused.
  std::vector<std::string> verbs() const {
    const std::string answer = vmesh({"nonsense"}).err, start = "The verbs are ";
    std::istringstream list(answer.substr(answer.find(start) + start.size()));
    std::vector<std::string> names;
    for (std::string name; list >> name;) {
      if (name.ends_with(',')) name.pop_back();
      if (name != "completion" && name != "man") names.push_back(name);
    }
    EXPECT_GE(names.size(), 18U) << answer;
    return names;
  }
  pugi::xml_document described(const std::string& verb) const {
    const Outcome outcome = vmesh({"--xml", verb});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(outcome.out.c_str())) << outcome.out;
    return document;
  }
  static std::vector<pugi::xml_node> parameters_of(const pugi::xml_document& document) {
    std::vector<pugi::xml_node> all;
    for (const pugi::xml_node& group : document.child("executable").children("parameters")) {
      for (const pugi::xml_node& child : group.children()) {
        if (child.child("name")) all.push_back(child);
      }
    }
    return all;
  }
  /// The words that Slicer adds for all values that nobody changed: those of numbers and choices.
  static std::vector<std::string> untouched(const pugi::xml_document& document) {
    std::vector<std::string> words;
    for (const pugi::xml_node& parameter : parameters_of(document)) {
      const std::string kind = parameter.name();
      if (kind != "integer" && kind != "double" && kind != "string-enumeration") continue;
      words.emplace_back(parameter.child_value("longflag"));
      words.emplace_back(parameter.child_value("default"));
    }
    return words;
  }
};

TEST_F(ExecutionModel, EveryVerbIsDescribedAsTheSchemaHasIt) {
  for (const std::string& verb : verbs()) {
    const pugi::xml_document document = described(verb);
    const pugi::xml_node root = document.child("executable");
    EXPECT_TRUE(matches(joined(child_names(root)), "category title description version license (parameters )+"))
        << verb;
    for (const pugi::xml_node& group : root.children("parameters")) {
      EXPECT_TRUE(matches(joined(child_names(group)), "label description ([a-z-]+ )+")) << verb;
    }
    for (const pugi::xml_node& parameter : parameters_of(document)) {
      const std::string kind = parameter.name(), children = joined(child_names(parameter));
      EXPECT_TRUE(kAttributes.contains(kind)) << verb << ": " << kind;
      EXPECT_TRUE(matches(children,
                          "name (longflag|index) description label (default )?(channel )?(constraints |(element )+)?"))
          << verb << ": " << children;
      EXPECT_EQ(kind == "string-enumeration", parameter.child("element") != nullptr) << verb;
      for (const pugi::xml_attribute& attribute : parameter.attributes())
        EXPECT_NE(kAttributes.at(kind).find(attribute.name()), std::string::npos) << verb << ": " << attribute.name();
    }
  }
}

TEST_F(ExecutionModel, NamesAreIdentifiersAndDifferAndIndicesCountUp) {
  for (const std::string& verb : verbs()) {
    std::set<std::string> names;
    int next_index = 0;
    for (const pugi::xml_node& parameter : parameters_of(described(verb))) {
      const std::string name = parameter.child_value("name");
      EXPECT_TRUE(matches(name, "[_a-zA-Z][_a-zA-Z0-9]*")) << verb << ": " << name;
      EXPECT_TRUE(names.insert(name).second) << verb << ": " << name << " occurs twice";
      if (parameter.child("longflag")) {
        EXPECT_EQ(parameter.child_value("longflag"), "--" + name) << verb;
      } else {
        EXPECT_EQ(parameter.child_value("index"), std::to_string(next_index++)) << verb;
      }
    }
  }
}

TEST_F(ExecutionModel, DefaultsAreAmongWhatIsAllowed) {
  int limited = 0;
  for (const std::string& verb : verbs()) {
    for (const pugi::xml_node& parameter : parameters_of(described(verb))) {
      const std::string name = verb + ": " + parameter.child_value("name"), value = parameter.child_value("default");
      if (parameter.child("element")) {
        std::vector<std::string> choices;
        for (const pugi::xml_node& element : parameter.children("element")) choices.emplace_back(element.child_value());
        EXPECT_NE(std::find(choices.begin(), choices.end(), value), choices.end()) << name << " " << value;
      }
      if (const pugi::xml_node constraints = parameter.child("constraints"); constraints.child("minimum")) {
        const double number = parameter.child("default").text().as_double();
        EXPECT_LE(constraints.child("minimum").text().as_double(), number) << name;
        EXPECT_GE(constraints.child("maximum").text().as_double(), number) << name;
        ++limited;
      }
    }
  }
  EXPECT_GT(limited, 20);
}

TEST_F(ExecutionModel, EveryOptionOfTheHelpIsInIt) {
  for (const std::string& verb : verbs()) {
    std::set<std::string> described_flags{"--help", "--quiet", "--slicer"}, known;
    for (const pugi::xml_node& parameter : parameters_of(described(verb))) {
      std::string flag = parameter.child_value("longflag");
      std::replace(flag.begin(), flag.end(), '_', '-');
      described_flags.insert(flag);
    }
    std::istringstream help(vmesh({verb, "--help"}).out);
    for (std::string line; std::getline(help, line);) {
      std::smatch found;
      // "  -o,--output SURFACE  ..."; the first long name of each.
      if (std::regex_search(line, found, std::regex("^  (?:-\\w,)*(--[a-z0-9-]+)"))) known.insert(found[1]);
    }
    EXPECT_GE(known.size(), 2U) << verb;
    for (const std::string& flag : known) EXPECT_TRUE(described_flags.contains(flag)) << verb << " " << flag;
  }
}

TEST_F(ExecutionModel, CalledAsSlicerDoesWithoutChangesItIsTheSame) {
  vmesh({"synth", "--vertices", "40", "-o", "@tree.swc"});
  ASSERT_EQ(vmesh({"generate", "@tree.swc", "-o", "@typed.vtp"}).exit_code, 0);
  std::vector<std::string> call{"generate", "--slicer"};
  const std::vector<std::string> words = untouched(described("generate"));
  EXPECT_GT(words.size(), 20U);
  call.insert(call.end(), words.begin(), words.end());
  for (const char* word : {"--output", "@called.vtp", "@tree.swc"}) call.emplace_back(word);
  const Outcome outcome = vmesh(call);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read("called.vtp"), read("typed.vtp"));
}

TEST_F(ExecutionModel, WhatIsChangedInThePanelActs) {
  vmesh({"synth", "--vertices", "40", "-o", "@tree.swc"});
  ASSERT_EQ(vmesh({"generate", "@tree.swc", "-o", "@typed.vtp", "--around", "9", "--max-error", "5%"}).exit_code, 0);
  const Outcome outcome = vmesh({"generate", "--slicer", "--around", "9", "--blend", "0.50", "--max_error", "5%",
                                 "--output", "@called.vtp", "@tree.swc"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read("called.vtp"), read("typed.vtp"));
  // Not without the flag: there is no such option.
  EXPECT_EQ(vmesh({"generate", "--max_error", "5%", "-o", "@called.vtp", "@tree.swc"}).exit_code, 2);
}

TEST_F(ExecutionModel, ProgressIsToldByTags) {
  vmesh({"synth", "--vertices", "300", "-o", "@tree.swc"});
  const Outcome outcome = vmesh({"generate", "--slicer", "--output", "@tree.vtp", "@tree.swc"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(("<module-root>" + outcome.out + "</module-root>").c_str())) << outcome.out;
  const std::string tags = joined(child_names(document.child("module-root")));
  EXPECT_TRUE(matches(tags, "(filter-start (filter-progress )+filter-end )+")) << tags;
  for (const pugi::xml_node& progress : document.child("module-root").children("filter-progress")) {
    EXPECT_TRUE(matches(progress.child_value(), "[01]\\.[0-9]+")) << progress.child_value();
    EXPECT_LE(progress.text().as_double(), 1) << progress.child_value();
  }
  EXPECT_EQ(vmesh({"generate", "@tree.swc", "-o", "@tree.vtp"}).out, "");
}

TEST_F(ExecutionModel, WhatCannotBeDescribedIsToldWhy) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--xml"}, {"--xml", "nonsense"}, {"--xml", "man"}, {"--xml", "generate", "more"}}) {
    const Outcome outcome = vmesh(words);
    EXPECT_EQ(outcome.exit_code, 2) << joined(words);
    EXPECT_EQ(outcome.out, "") << joined(words);
  }
  EXPECT_NE(vmesh({"--xml", "generat"}).err.find("did you mean generate?"), std::string::npos);
  const Outcome both = vmesh({"generate", "--slicer", "--json", "-", "--output", "@t.vtp", "@t.swc"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_NE(both.err.find("--json FILE"), std::string::npos) << both.err;
}

}  // namespace
}  // namespace vmesh::testing
