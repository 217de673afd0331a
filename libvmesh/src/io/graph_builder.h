// Graphs whose nodes and edges have ids and named attributes, as centerlines; internal to the module.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vmesh/core/error.h"

#include "poly_lines.h"

namespace vmesh::io {

/// Positions are the attributes x, y and z of nodes, or one of three numbers ("pos", "position" ...); radii those of
/// nodes, or else of edges, under the name in the options or a usual one.
class GraphBuilder {
 public:
  GraphBuilder(std::string source, const CenterlineReadOptions& options)
      : source_(std::move(source)), options_(options) {}

  [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(source_ + ": " + what); }

  /// Begin an element, whose attributes follow. Throw InvalidInput if the id occurred before.
  void begin_node(const std::string& id);
  void begin_edge(std::string from, std::string to);

  /// Of the element begun last, or of the graph. Throws InvalidInput for coordinates that are no numbers.
  void add(const std::string& name, std::string_view text);
  void add(const std::string& name, double value);
  void add_position(const Vec3& position);

  /// Throws InvalidInput for an edge to a node that is not there, a node without position, and if there is no radius.
  RawCenterline finish();

 private:
  /// Values by the elements that have one. A list for each name: names may be as many as elements.
  using Values = std::map<std::string, std::vector<std::pair<std::size_t, double>>>;

  std::string place() const;
  void end_node();
  Index node(const std::string& id, std::size_t edge) const;
  ScalarArrays arrays(const Values& values, std::size_t count) const;

  enum class Element { graph, node, edge };

  const std::string source_;
  const CenterlineReadOptions& options_;
  Element element_ = Element::graph;
  std::array<std::optional<double>, 3> position_;  ///< of the node begun last
  std::vector<CenterlineNode> nodes_;
  std::unordered_map<std::string, Index> node_of_;
  std::vector<std::pair<std::string, std::string>> edges_;
  Values of_nodes_, of_edges_;
  LengthUnit unit_ = LengthUnit::unknown;
  Space space_ = Space::unknown;
};

}  // namespace vmesh::io
