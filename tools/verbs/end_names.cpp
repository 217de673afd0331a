#include "verbs/end_names.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "vmesh/core/error.h"
#include "vmesh/core/file_format.h"
#include "vmesh/core/input_file.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/patch_names.h"

#include "command_line/arguments_common.h"

namespace vmesh::tool {
namespace {

/// A position names the nearest end, if that is no farther than this many of its radii: about where an extension of
/// moderate length ends.
constexpr double kFarthestEnd = 10;

std::vector<Index> ends_of(const Centerline& centerline) {
  std::vector<Index> ends;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) == 1) ends.push_back(n);
  }
  return ends;
}

Index end_at_node(const std::string& text, const Centerline& centerline) {
  Index node = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), node);
  if (error != std::errc() || end != text.data() + text.size())
    throw InvalidInput("\"" + text + "\" is not a node number");
  if (node >= centerline.nodes().size())
    throw InvalidInput("there is no node " + text + "; the nodes are 0 to " +
                       std::to_string(centerline.nodes().size() - 1));
  if (centerline.degree(node) != 1)
    throw InvalidInput("node " + text + " is no end of the centerline; the ends are listed in the summary (--json)");
  return node;
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) throw InvalidInput("\"" + text + "\" is not a number");
  return value;
}

Index end_near(const Vec3& position, const Centerline& centerline) {
  const auto distance = [&](Index n) { return (centerline.node(n).position - position).norm(); };
  const std::vector<Index> ends = ends_of(centerline);
  const auto nearest =
      std::min_element(ends.begin(), ends.end(), [&](Index a, Index b) { return distance(a) < distance(b); });
  if (nearest == ends.end()) throw InvalidInput("the centerline has no ends");
  if (distance(*nearest) > kFarthestEnd * centerline.node(*nearest).radius)
    throw InvalidInput(
        formatted("no end is near (%g, %g, %g) mm: the nearest, at node %u, is %.3g mm away, more than %g of its "
                  "radii; positions "
                  "are in LPS",
                  position.x(), position.y(), position.z(), *nearest, distance(*nearest), kFarthestEnd));
  return *nearest;
}

/// A table of comma-separated values whose header is "node,name" or "x,y,z,name".
class NameTable {
 public:
  NameTable(const std::filesystem::path& path, const Centerline& centerline) : path_(path), centerline_(centerline) {}

  std::vector<EndName> read() {
    std::istringstream lines(read_file(path_));
    std::vector<EndName> names;
    std::vector<std::string> header;
    for (std::string line; std::getline(lines, line);) {
      ++number_;
      const std::vector<std::string> fields = fields_of(line);
      if (fields.empty()) continue;
      if (header.empty()) {
        header = fields;
        for (std::string& name : header) name = lower(name);
        check_header(header);
      } else if (fields.size() != header.size()) {
        fail("there are " + std::to_string(header.size()) + " columns in the header, " + std::to_string(fields.size()) +
             " here");
      } else {
        names.push_back(row(fields));
      }
    }
    if (names.empty()) throw InvalidInput(path_.string() + ": it names no ends; " + kColumns);
    return names;
  }

 private:
  static constexpr const char* kColumns = "the columns are node,name or x,y,z,name (mm, LPS)";

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(path_.string() + ": line " + std::to_string(number_) + ": " + what);
  }

  static std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream all(line.substr(0, line.find('#')));
    for (std::string field; std::getline(all, field, ',');) fields.emplace_back(trimmed(field));
    if (fields.size() == 1 && fields[0].empty()) fields.clear();
    return fields;
  }

  void check_header(const std::vector<std::string>& header) const {
    const std::vector<std::string> by_node = {"node", "name"}, by_position = {"x", "y", "z", "name"};
    if (header != by_node && header != by_position) fail(kColumns);
  }

  EndName row(const std::vector<std::string>& fields) const {
    try {
      if (fields.size() == 2) return {end_at_node(fields[0], centerline_), fields[1]};
      return {end_near({number(fields[0]), number(fields[1]), number(fields[2])}, centerline_), fields[3]};
    } catch (const InvalidInput& error) {
      fail(error.what());
    }
  }

  const std::filesystem::path& path_;
  const Centerline& centerline_;
  std::size_t number_ = 0;
};

EndName parse_end_name(const std::string& text, const Centerline& centerline) {
  const std::size_t equal = text.find('=');
  if (equal == std::string::npos) throw InvalidInput("--name " + text + ": give a node and a name: 3=inlet");
  try {
    return {end_at_node(text.substr(0, equal), centerline), text.substr(equal + 1)};
  } catch (const InvalidInput& error) {
    throw InvalidInput("--name " + text + ": " + error.what());
  }
}

/// Also those that have the default name of another one.
void check_end_names(const std::vector<EndName>& names, const Centerline& centerline) {
  std::vector<Index> nodes;
  for (const EndName& given : names) {
    if (std::find(nodes.begin(), nodes.end(), given.node) != nodes.end())
      throw InvalidInput("the end at node " + std::to_string(given.node) + " is named twice");
    nodes.push_back(given.node);
    if (is_wall_name(given.name))
      throw InvalidInput("the end at node " + std::to_string(given.node) + " cannot be called \"" + given.name +
                         "\": patches whose names begin with \"wall\" are walls; choose another name");
  }
  std::vector<std::string> all = {"wall"};
  for (const Index node : ends_of(centerline)) {
    FlatEnd end;
    end.node = node;
    end.label = static_cast<Index>(all.size());
    all.push_back(name_of_end(end, names));
  }
  check_patch_names(all, "patch", "patches");
}

}  // namespace

void add_end_names(CLI::App& verb, EndNameArguments& arguments) {
  verb.add_option("--name", arguments.given,
                  "what to call the flat end at a node, in files that have room for names: 3=inlet; more than once for "
                  "more ends")
      ->type_name("NODE=NAME")
      ->allow_extra_args(false);
  verb.add_option("--names", arguments.table,
                  "the same from a table: CSV with the columns node,name, or x,y,z,name for the end nearest to a "
                  "position (mm, LPS)")
      ->type_name("FILE.csv");
}

void add_regions(CLI::App& verb, const std::function<void()>& take, const std::string& help) {
  add_choice(
      verb, "--regions", {"branches"}, [take](const std::string&) { take(); }, help);
}

std::vector<EndName> read_end_names(const EndNameArguments& arguments, const Centerline& centerline) {
  std::vector<EndName> names;
  if (!arguments.table.empty()) names = NameTable(arguments.table, centerline).read();
  for (const std::string& text : arguments.given) names.push_back(parse_end_name(text, centerline));
  check_end_names(names, centerline);
  return names;
}

}  // namespace vmesh::tool
