#include "voxel_skeleton.h"

#include <algorithm>
#include <cmath>

#include "voxel_depth.h"
#include "voxel_graph.h"

namespace vmesh::skeleton {
namespace {

constexpr int kSmoothings = 4;
// A component is a vessel if it is longer than this times its width, and than this number of voxels, both measured from
// outside to outside.
constexpr double kLongerThanWide = 1.4, kLeastVoxels = 6;

// A sphere counts as reaching an end if its radius and a voxel are this share of the way; the fit does the rest.
constexpr double kReachesEnd = 0.8;

void smooth(Graph& graph, const std::vector<std::vector<Index>>& edges_at) {
  for (int round = 0; round < kSmoothings; ++round) {
    const std::vector<Node> before = graph.nodes;
    for (Index n = 0; n < graph.nodes.size(); ++n) {
      if (edges_at[n].size() != 2) continue;
      const Node &a = before[other_end(graph, edges_at[n][0], n)], &b = before[other_end(graph, edges_at[n][1], n)];
      graph.nodes[n].position = 0.5 * before[n].position + 0.25 * (a.position + b.position);
      graph.nodes[n].radius = 0.5 * before[n].radius + 0.25 * (a.radius + b.radius);
    }
  }
}

/// Cuts free ends back to where the sphere still reaches the end, and takes away what is within its parent.
void trim_ends(Graph& graph, double voxel) {
  const auto edges_at = incidence(graph);
  std::vector<bool> removed(graph.edges.size(), false);
  for (const Chain& chain : chains_of(graph)) {
    for (const bool backwards : {false, true}) {
      const auto node = [&](std::size_t i) { return chain.nodes[backwards ? chain.nodes.size() - 1 - i : i]; };
      const auto edge = [&](std::size_t i) { return chain.edges[backwards ? chain.edges.size() - 1 - i : i]; };
      const Index end = node(0);
      if (edges_at[end].size() != 1 || graph.nodes[end].fixed) continue;
      const bool free_chain = edges_at[node(chain.nodes.size() - 1)].size() == 1;
      for (std::size_t i = 0; i < chain.edges.size(); ++i) {
        const Node& next = graph.nodes[node(i + 1)];
        if (next.radius + voxel < kReachesEnd * (next.position - graph.nodes[end].position).norm()) break;
        if (free_chain && (i + 1 == chain.edges.size() || removed[edge(i + 1)])) break;  // one edge stays
        removed[edge(i)] = true;
      }
    }
  }
  remove_edges(graph, removed);
}

void judge(std::vector<VoxelComponent>& components, const std::vector<Index>& component, const VoxelGraph& graph,
           const std::vector<float>& depth, const std::vector<Index>& roots) {
  const double voxel = graph.finest();
  std::vector<std::size_t> count;
  for (Index n = 0; n < graph.size(); ++n) {
    if (component[n] >= components.size()) components.resize(component[n] + 1), count.resize(component[n] + 1, 0);
    VoxelComponent& c = components[component[n]];
    c.length = std::max(c.length, graph.distance(roots[component[n]], n) + 2 * voxel);
    c.width = std::max(c.width, 2.0 * depth[n]);
    const Voxel& v = graph.voxel(n);
    c.place += Vec3(v[0], v[1], v[2]);
    ++count[component[n]];
  }
  Index longest = 0;
  for (Index c = 0; c < components.size(); ++c) {
    components[c].place /= static_cast<double>(count[c]);
    components[c].kept = components[c].length >= std::max(kLongerThanWide * components[c].width, kLeastVoxels * voxel);
    if (components[c].length > components[longest].length) longest = c;
  }
  if (!components.empty()) components[longest].kept = true;
}

}  // namespace

VoxelSkeleton skeleton_of(const VoxelSet& voxels, const VoxelFrame& frame, std::span<const KnownEnd> ends,
                          const Progress& progress) {
  VoxelSkeleton result;
  VoxelGraph graph(voxels, frame.spacing());
  {
    const std::vector<VoxelGraph::Bridge> bridges = bridges_to_fragments(graph, components_of(graph));
    graph.add_bridges(bridges);
    for (const VoxelGraph::Bridge& bridge : bridges)
      result.bridges.push_back({frame.position(graph.voxel(bridge.a)), frame.position(graph.voxel(bridge.b)),
                                bridge.length - graph.finest()});
  }
  const std::vector<float> depth = boundary_distances(graph);
  const std::vector<float> occupancy = smoothed_occupancy(voxels);
  VesselPaths paths = find_paths(graph, depth, occupancy, ends, progress);
  judge(result.components, paths.component, graph, depth, paths.roots);
  for (VoxelComponent& component : result.components) component.place = frame.origin + frame.steps * component.place;

  std::vector<Index> number(paths.voxels.size(), kNone);
  for (std::size_t p = 0; p < paths.voxels.size(); ++p) {
    const Index n = paths.voxels[p];
    number[p] = static_cast<Index>(result.graph.nodes.size());
    const double voxel = graph.finest();
    result.graph.nodes.push_back({frame.position(graph.voxel(n)), depth[n] - 0.5 * voxel,
                                  depth[n] + (occupancy[n] - 1) * voxel, paths.component[n]});
  }
  for (const auto& [a, b] : paths.edges) result.graph.edges.push_back({number[a], number[b]});
  for (const Index place : paths.known_ends) result.node_of_end.push_back(place == kNone ? kNone : number[place]);
  for (const Index n : result.node_of_end)
    if (n != kNone) result.graph.nodes[n].fixed = true;
  result.loops = paths.loops;
  break_loops(result.graph, result.loops);  // none but where two paths run side by side
  trim_ends(result.graph, graph.finest());
  smooth(result.graph, incidence(result.graph));
  result.component_of_voxel = std::move(paths.component);
  result.frame = frame;
  return result;
}

}  // namespace vmesh::skeleton
