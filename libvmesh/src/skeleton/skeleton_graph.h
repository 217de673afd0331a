// The raw skeleton of a surface and its cleaning, internal to the module.
#pragma once

#include <array>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

struct Node {
  Vec3 position = Vec3::Zero();
  double radius = 0;    ///< mm
  double bore = 0;      ///< how wide the voxels are open there, mm; 0: unknown
  Index component = 0;  ///< of the segmentation
  bool fixed = false;   ///< stays where it is: in the middle of an opening or a flat end
};

/// A graph without multiple edges. Removals may leave nodes without an edge.
struct Graph {
  std::vector<Node> nodes;
  std::vector<std::array<Index, 2>> edges;

  double length(std::size_t e) const { return (nodes[edges[e][0]].position - nodes[edges[e][1]].position).norm(); }
};

/// Edges at every node.
std::vector<std::vector<Index>> incidence(const Graph& graph);

/// The other end of edge `e`.
inline Index other_end(const Graph& graph, Index e, Index n) {
  return graph.edges[e][0] == n ? graph.edges[e][1] : graph.edges[e][0];
}

/// A stretch between nodes that branch or end. A closed one without such a node begins and ends at the same node.
struct Chain {
  std::vector<Index> nodes;
  std::vector<Index> edges;  ///< edges[i] joins nodes[i] and nodes[i + 1]
};
std::vector<Chain> chains_of(const Graph& graph);

void remove_edges(Graph& graph, const std::vector<bool>& removed);

/// The same with nodes that have no edge then, but had one.
void remove_with_nodes(Graph& graph, const std::vector<bool>& removed);

/// Removes edges until the graph has at most `loops` independent loops, starting with the shortest loop; the longest
/// edge of a loop is removed. Returns the number of edges removed.
std::size_t break_loops(Graph& graph, std::size_t loops);

/// Removes end chains shorter than the radius at the node where they branch off, with their nodes, at every node the
/// relatively shortest first, until there are none. Returns the number removed.
std::size_t prune_spurs(Graph& graph);

/// The graph with every chain resampled at about `spacing` radii, after smoothing the curve and its radii over about a
/// radius.
/// Radii below `least` (mm) count as that.
Graph resampled(const Graph& graph, double spacing, double least = 0);

}  // namespace vmesh::skeleton
