// Graphs as networkx and Gephi store them: GraphML, GEXF and node-link JSON.
#include "graph_files.h"

#include "formats.h"
#include "graph_builder.h"
#include "text.h"
#include "xml.h"

namespace vmesh::io {
namespace {

/// Names of attributes by their ids in the file.
using AttributeNames = std::unordered_map<std::string, std::string>;

/// Adds the attributes of an element: its children of that name, with the id under `id` and the value under `value`, or
/// as text where that is null.
void add_attributes(GraphBuilder& graph, pugi::xml_node owner, const AttributeNames& names, const char* child,
                    const char* id, const char* value) {
  for (const pugi::xml_node data : owner.children(child)) {
    const std::string key = data.attribute(id).value();
    const auto named = names.find(key);
    const char* text = value != nullptr ? data.attribute(value).value() : data.text().get();
    graph.add(named == names.end() ? key : named->second, std::string_view(text));
  }
}

/// The end of an edge, or the id of a node.
std::string needed(const GraphBuilder& graph, pugi::xml_node element, const char* name) {
  const pugi::xml_attribute attribute = element.attribute(name);
  if (!attribute) graph.fail(std::string("there is a <") + element.name() + "> without " + name);
  return attribute.value();
}

}  // namespace

RawCenterline parse_graphml(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  const XmlFile file = parse_xml(content, source);
  GraphBuilder graph(source, options);
  const pugi::xml_node root = file.document.child("graphml");
  const pugi::xml_node first = root.child("graph");
  if (!first) graph.fail("this is not a GraphML file: it contains no <graphml> with a <graph>");
  AttributeNames names;
  for (const pugi::xml_node key : root.children("key")) {
    const std::string name = key.attribute("attr.name").value();
    if (!name.empty()) names[key.attribute("id").value()] = name;
  }
  add_attributes(graph, first, names, "data", "key", nullptr);
  for (const pugi::xml_node node : first.children("node")) {
    graph.begin_node(needed(graph, node, "id"));
    add_attributes(graph, node, names, "data", "key", nullptr);
  }
  for (const pugi::xml_node edge : first.children("edge")) {
    graph.begin_edge(needed(graph, edge, "source"), needed(graph, edge, "target"));
    add_attributes(graph, edge, names, "data", "key", nullptr);
  }
  return graph.finish();
}

RawCenterline parse_gexf(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  const XmlFile file = parse_xml(content, source);
  GraphBuilder graph(source, options);
  const pugi::xml_node root = file.document.child("gexf").child("graph");
  if (!root) graph.fail("this is not a GEXF file: it contains no <gexf> with a <graph>");
  AttributeNames of_nodes, of_edges;
  for (const pugi::xml_node list : root.children("attributes")) {
    AttributeNames& names = list.attribute("class").value() == std::string_view("edge") ? of_edges : of_nodes;
    for (const pugi::xml_node attribute : list.children("attribute"))
      names[attribute.attribute("id").value()] = attribute.attribute("title").value();
  }
  for (const pugi::xml_node node : root.child("nodes").children("node")) {
    graph.begin_node(needed(graph, node, "id"));
    const pugi::xml_node drawn = node.child("viz:position");  // x, y and z among the attributes override it
    for (const char* axis : {"x", "y", "z"}) {
      if (drawn.attribute(axis)) graph.add(axis, std::string_view(drawn.attribute(axis).value()));
    }
    add_attributes(graph, node.child("attvalues"), of_nodes, "attvalue", "for", "value");
  }
  for (const pugi::xml_node edge : root.child("edges").children("edge")) {
    graph.begin_edge(needed(graph, edge, "source"), needed(graph, edge, "target"));
    add_attributes(graph, edge.child("attvalues"), of_edges, "attvalue", "for", "value");
  }
  return graph.finish();
}

namespace {

class NodeLinkReader {
 public:
  NodeLinkReader(const std::string& source, const CenterlineReadOptions& options) : graph_(source, options) {}

  RawCenterline run(const nlohmann::json& document) {
    if (const auto about = document.find("graph"); about != document.end() && about->is_object()) add_members(*about);
    const char* links = document.contains("links") ? "links" : "edges";
    for (const auto& node : list(document, "nodes")) {
      place_ = "node " + std::to_string(count_++);
      graph_.begin_node(id(node, "id"));
      add_members(node);
    }
    count_ = 0;
    for (const auto& link : list(document, links)) {
      place_ = "edge " + std::to_string(count_++);
      const std::string from = id(link, "source");
      graph_.begin_edge(from, id(link, "target"));
      add_members(link);
    }
    return graph_.finish();
  }

 private:
  const nlohmann::json& list(const nlohmann::json& document, const char* key) const {
    const auto found = document.find(key);
    if (found == document.end() || !found->is_array()) graph_.fail(std::string("\"") + key + "\" must be an array");
    return *found;
  }

  std::string id(const nlohmann::json& element, const char* key) const {
    if (!element.is_object()) graph_.fail(place_ + ": it must be an object");
    const auto found = element.find(key);
    if (found == element.end() || !(found->is_string() || found->is_number()))
      graph_.fail(place_ + ": \"" + key + "\" must be a text or a number");
    return found->is_string() ? found->get<std::string>() : found->dump();
  }

  void add_members(const nlohmann::json& element) {
    for (const auto& [name, value] : element.items()) {
      if (value.is_number()) {
        graph_.add(name, value.get<double>());
      } else if (value.is_string()) {
        graph_.add(name, std::string_view(value.get_ref<const std::string&>()));
      } else if (value.is_array() && value.size() == 3 && value[0].is_number() && value[1].is_number() &&
                 value[2].is_number()) {
        graph_.add(name, "[" + value[0].dump() + " " + value[1].dump() + " " + value[2].dump() + "]");
      }
    }
  }

  GraphBuilder graph_;
  std::string place_;
  std::size_t count_ = 0;
};

}  // namespace

bool is_node_link(const nlohmann::json& document) {
  return document.is_object() && !document.contains("schema") && document.contains("nodes") &&
         (document.contains("links") || document.contains("edges"));
}

RawCenterline read_node_link(const nlohmann::json& document, const std::string& source,
                             const CenterlineReadOptions& options) {
  return NodeLinkReader(source, options).run(document);
}

}  // namespace vmesh::io
