// Graphs of networkx and Gephi: GraphML, GEXF and node-link JSON.
#include "vmesh/io/centerline_io.h"

#include "io_support.h"

namespace vmesh {
namespace {

using testing::expect_contains;
using testing::message_of;

RawCenterline parse(const std::string& name, const std::string& text, const CenterlineReadOptions& options = {}) {
  return parse_centerline(text, centerline_format(name), name, options);
}

std::string error(const std::string& name, const std::string& text) {
  return message_of<InvalidInput>([&] { parse(name, text); });
}

/// Three nodes in a bend with text ids; radius 3, 2 and unknown.
void expect_is_the_bend(const RawCenterline& raw) {
  ASSERT_EQ(raw.nodes.size(), 3u);
  EXPECT_EQ(raw.nodes[0].position, Vec3(0, 0, 0));
  EXPECT_EQ(raw.nodes[1].position, Vec3(0, 0.5, 20));
  EXPECT_EQ(raw.nodes[2].position, Vec3(-8, 0, 33));
  EXPECT_EQ(raw.nodes[0].radius, 3);
  EXPECT_EQ(raw.nodes[1].radius, 2);
  EXPECT_EQ(raw.nodes[2].radius, 0);
  ASSERT_EQ(raw.segments.size(), 2u);
  EXPECT_EQ(raw.segments[1].a, 1u);
  EXPECT_EQ(raw.segments[1].b, 2u);
  EXPECT_EQ(raw.radius_arrays, std::vector<std::string>{"radius"});
  EXPECT_FALSE(raw.loose_branches);
}

std::string graphml(const std::string& nodes, const std::string& edges) {
  return R"(<?xml version='1.0' encoding='utf-8'?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns"><key id="d9" for="edge" attr.name="radius" attr.type="double"/>
<key id="d3" for="node" attr.name="radius" attr.type="double"/><key id="d2" for="node" attr.name="z" attr.type="double"/>
<key id="d1" for="node" attr.name="y" attr.type="double"/><key id="d0" for="node" attr.name="x" attr.type="long"/>
<key id="d4" for="node" attr.name="pos" attr.type="string"/><key id="d5" for="graph" attr.name="unit"/>
<graph edgedefault="undirected"><data key="d5">um</data>)" +
         nodes + edges + "</graph></graphml>";
}

const std::string kGraphMlNodes =
    R"(<node id="root"><data key="d0">0</data><data key="d1">0</data><data key="d2">0</data><data key="d3">3.0</data></node>
<node id="n &amp; 1"><data key="d4">[0.0, 0.5, 20.0]</data><data key="d3">2.0</data></node>
<node id="tip"><data key="d4">(-8. 0 33)</data><data key="label">a tip</data></node>)";
const std::string kGraphMlEdges = R"(<edge source="root" target="n &amp; 1"/><edge source="n &amp; 1" target="tip"/>)";

TEST(ReadGraphMl, ReadsPositionsOfBothKindsAndRadii) {
  const RawCenterline raw = parse("t.graphml", graphml(kGraphMlNodes, kGraphMlEdges));
  expect_is_the_bend(raw);
  EXPECT_EQ(raw.unit, LengthUnit::um);
  EXPECT_EQ(raw.name_of_node(2), "t.graphml: node 2");
}

TEST(ReadGraphMl, TakesRadiiOfEdgesWhereNodesHaveNone) {
  std::string nodes = kGraphMlNodes;
  for (const std::string radius : {"<data key=\"d3\">3.0</data>", "<data key=\"d3\">2.0</data>"})
    nodes.erase(nodes.find(radius), radius.size());
  const RawCenterline raw =
      parse("t.graphml", graphml(nodes,
                                 R"(<edge source="root" target="tip"><data key="d9">1.5</data></edge>
<edge target="tip" source="n &amp; 1"><data key="d9">1.5</data></edge>)"));
  ASSERT_EQ(raw.nodes.size(), 3u);
  for (const CenterlineNode& node : raw.nodes) EXPECT_EQ(node.radius, 1.5);
  expect_contains(error("t.graphml", graphml(nodes, kGraphMlEdges)), "--radius-array");
}

TEST(ReadGraphMl, NamesWhatIsWrong) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = graphml(kGraphMlNodes, kGraphMlEdges);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error("t.graphml", text.replace(at, from.size(), to));
  };
  expect_contains(with("\"tip\"><data", "\"root\"><data"), "t.graphml: node 2: the id \"root\" occurs twice");
  expect_contains(with("target=\"tip\"", "target=\"tap\""), "edge 1: there is no node \"tap\"");
  expect_contains(with("target=\"tip\"", "to=\"tip\""), "there is a <edge> without target");
  expect_contains(with("(-8. 0 33)", "(-8 33)"), "node 2: its pos \"(-8 33)\" is not three numbers");
  expect_contains(with("<data key=\"d2\">0</data>", ""), "node 0: it has no position; give nodes");
  expect_contains(with("<data key=\"d2\">0</data>", "<data key=\"d2\">low</data>"), "its z \"low\" is not a number");
  expect_contains(error("t.graphml", graphml(kGraphMlNodes, "")), "it contains no edge");
  expect_contains(error("t.graphml", "<gexf/>"), "this is not a GraphML file");
  expect_contains(error("t.graphml", "<graphml>"), "not valid XML");
}

TEST(ReadGraphMl, AMillionAttributeNamesAreNoTroubleNorNumbersOfEveryNode) {
  std::string nodes;
  constexpr int kCount = 100000;
  for (int n = 0; n < kCount; ++n) {
    const std::string number = std::to_string(n);
    nodes += "<node id=\"" + number + "\"><data key=\"pos\">1 2 " + number + "</data><data key=\"area" + number +
             "\">1</data><data key=\"r\">2</data></node>";
  }
  const RawCenterline raw = parse("t.graphml", graphml(nodes, "<edge source=\"0\" target=\"99999\"/>"));
  EXPECT_EQ(raw.nodes.size(), 2u);
  EXPECT_EQ(raw.nodes[1].radius, 2);
}

const std::string kGexf = R"(<?xml version='1.0' encoding='utf-8'?>
<gexf xmlns="http://www.gexf.net/1.2draft" xmlns:viz="http://www.gexf.net/1.2draft/viz" version="1.2">
<graph defaultedgetype="undirected" mode="static">
<attributes mode="static" class="edge"><attribute id="0" title="length" type="double"/></attributes>
<attributes mode="static" class="node"><attribute id="0" title="x" type="double"/><attribute id="1" title="y" type="double"/>
<attribute id="2" title="z" type="double"/><attribute id="3" title="radius" type="double"/></attributes>
<nodes><node id="a" label="a"><attvalues><attvalue for="0" value="0"/><attvalue for="1" value="0"/>
<attvalue for="2" value="0"/><attvalue for="3" value="3"/></attvalues></node>
<node id="b" label="b"><attvalues><attvalue for="3" value="2"/></attvalues><viz:position x="0" y="0.5" z="20"/></node>
<node id="c" label="c"><viz:position x="-8" y="0" z="33"/></node></nodes>
<edges><edge source="a" target="b" id="0"><attvalues><attvalue for="0" value="20"/></attvalues></edge>
<edge source="b" target="c" id="1"/></edges></graph></gexf>)";

TEST(ReadGexf, ReadsAttributesAndPlacesOfDrawing) {
  expect_is_the_bend(parse("t.gexf", kGexf));
  expect_contains(error("t.gexf", "<graphml/>"), "this is not a GEXF file");
}

const std::string kNodeLink = R"({"directed": false, "multigraph": false, "graph": {"unit": "cm", "space": "RAS"},
 "nodes": [{"x": 0, "y": 0, "z": 0, "radius": 3, "id": 7}, {"pos": [0, 0.5, 20], "radius": "2.0", "id": "b"},
  {"pos": "[-8, 0, 33]", "color": [1, 0, 0], "id": "tip"}, {"x": 9, "y": 9, "z": 9, "radius": 1, "id": "alone"}],
 "links": [{"source": 7, "target": "b"}, {"length": 3.5, "source": "b", "target": "tip"}]})";

TEST(ReadNodeLink, ReadsTheJsonOfNetworkx) {
  const RawCenterline raw = parse("t.json", kNodeLink);
  expect_is_the_bend(raw);
  EXPECT_EQ(raw.unit, LengthUnit::cm);
  EXPECT_EQ(raw.space, Space::ras);
  expect_contains(raw.warnings.at(0), "1 points belong to no line or vertex");
  std::string newer = kNodeLink;
  expect_is_the_bend(parse("t.json", newer.replace(newer.find("links"), 5, "edges")));
  CenterlineReadOptions options;
  options.radius_array = "width";
  EXPECT_THROW(parse("t.json", kNodeLink, options), InvalidInput);
}

TEST(ReadNodeLink, NamesTheEntryThatIsWrong) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kNodeLink;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return error("t.json", text.replace(at, from.size(), to));
  };
  expect_contains(with("\"id\": 7", "\"id\": [7]"), "node 0: \"id\" must be a text or a number");
  expect_contains(with("\"source\": \"b\"", "\"from\": \"b\""), "edge 1: \"source\" must be");
  expect_contains(with("\"source\": 7", "\"source\": 8"), "edge 0: there is no node \"8\"");
  expect_contains(with("[0, 0.5, 20]", "[0, 0.5]"), "node 1: it has no position");
  expect_contains(with("{\"source\": 7, \"target\": \"b\"}", "5"), "edge 0: it must be an object");
  expect_contains(error("t.json", R"({"nodes": 5, "links": []})"), "\"nodes\" must be an array");
}

}  // namespace
}  // namespace vmesh
