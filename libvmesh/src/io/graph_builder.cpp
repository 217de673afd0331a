#include "graph_builder.h"

#include <algorithm>

#include "radius_array.h"
#include "text.h"

namespace vmesh::io {
namespace {

const std::vector<std::string> kRadiiOfGraphs = {
    "MaximumInscribedSphereRadius", "Radius", "radius", "r", "R", "Diameter", "diameter"};

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// Three numbers between brackets, separated by commas or blanks.
std::optional<Vec3> parse_point(std::string_view text) {
  std::string plain(text);
  std::ranges::replace_if(
      plain, [](char c) { return std::string_view("[](),\n").find(c) != std::string_view::npos; }, ' ');
  std::vector<std::string_view> words;
  split_blank(plain, words);
  if (words.size() != 3) return std::nullopt;
  Vec3 point;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto value = parse_double(words[a]);
    if (!value) return std::nullopt;
    point[static_cast<Eigen::Index>(a)] = *value;
  }
  return point;
}

/// Which coordinate the name is that of; 3: none.
std::size_t axis_of(const std::string& name) {
  constexpr std::string_view kAxes = "xyz";
  return name.size() == 1 ? std::min<std::size_t>(kAxes.find(lower(name)), 3) : 3;
}

}  // namespace

std::string GraphBuilder::place() const {
  return element_ == Element::node ? "node " + std::to_string(nodes_.size())
                                   : "edge " + std::to_string(edges_.size() - 1);
}

void GraphBuilder::begin_node(const std::string& id) {
  end_node();
  element_ = Element::node;
  if (!node_of_.try_emplace(id, static_cast<Index>(nodes_.size())).second)
    fail(place() + ": the id " + cite(id) + " occurs twice");
}

void GraphBuilder::end_node() {
  if (element_ != Element::node) return;
  if (!std::ranges::all_of(position_, [](const auto& x) { return x.has_value(); }))
    fail(place() + ": it has no position; give nodes the attributes x, y and z, or pos with three numbers");
  nodes_.push_back({{*position_[0], *position_[1], *position_[2]}, 0});
  position_ = {};
  element_ = Element::graph;
}

void GraphBuilder::begin_edge(std::string from, std::string to) {
  end_node();
  element_ = Element::edge;
  edges_.emplace_back(std::move(from), std::move(to));
}

void GraphBuilder::add(const std::string& name, std::string_view text) {
  if (element_ == Element::graph) return read_tags(name + "=" + std::string(trim(text)), unit_, space_);
  if (element_ == Element::node &&
      is_one_of(lower(name), {"pos", "position", "coord", "coords", "coordinates", "xyz"})) {
    const auto point = parse_point(text);
    if (!point) fail(place() + ": its " + one_line(name) + " " + cite(text) + " is not three numbers");
    return add_position(*point);
  }
  if (const auto value = parse_double(trim(text))) return add(name, *value);
  if (element_ == Element::node && axis_of(name) < 3)
    fail(place() + ": its " + name + " " + cite(text) + " is not a number");
}

void GraphBuilder::add(const std::string& name, double value) {
  if (element_ == Element::graph) return;
  if (element_ == Element::edge) {
    of_edges_[name].emplace_back(edges_.size() - 1, value);
  } else if (const std::size_t axis = axis_of(name); axis < 3) {
    position_[axis] = value;
  } else {
    of_nodes_[name].emplace_back(nodes_.size(), value);
  }
}

void GraphBuilder::add_position(const Vec3& position) {
  if (element_ == Element::node) position_ = {position.x(), position.y(), position.z()};
}

Index GraphBuilder::node(const std::string& id, std::size_t edge) const {
  const auto found = node_of_.find(id);
  if (found == node_of_.end()) fail("edge " + std::to_string(edge) + ": there is no node " + cite(id));
  return found->second;
}

/// Those that may hold radii; the others only have their names.
ScalarArrays GraphBuilder::arrays(const Values& values, std::size_t count) const {
  ScalarArrays arrays;
  std::vector<std::string> names;
  for (const auto& [name, list] : values) names.push_back(name);
  const auto area = only_area(names);
  for (const auto& [name, list] : values) {
    std::vector<double>& all = arrays[name];
    if (name != options_.radius_array && name != area &&
        std::ranges::find(kRadiiOfGraphs, name) == kRadiiOfGraphs.end())
      continue;
    all.resize(count, 0);
    for (const auto& [element, value] : list) all[element] = value;
  }
  return arrays;
}

RawCenterline GraphBuilder::finish() {
  end_node();
  if (edges_.empty()) fail("it contains no edge; vessels are edges");
  PolyLines lines;
  const ScalarArrays of_nodes = arrays(of_nodes_, nodes_.size()), of_edges = arrays(of_edges_, edges_.size());
  lines.points = std::move(nodes_);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    lines.lines.push_back({node(edges_[e].first, e), node(edges_[e].second, e)});
  RawCenterline raw = to_raw_centerline(std::move(lines), source_, {of_nodes, of_edges}, options_, kRadiiOfGraphs);
  raw.node_word = "node";
  raw.segment_word = "edge";
  raw.loose_branches = false;  // what is joined has an edge
  raw.path_starts.clear();
  raw.unit = unit_;
  raw.space = space_;
  return raw;
}

}  // namespace vmesh::io
