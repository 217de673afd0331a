#include "vmesh/fit/fit_capped_surface.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "vmesh/core/error.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/flat_reference.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

std::string cap_text(Index patch) { return "the cap with ModelFaceID " + std::to_string(patch); }

/// A surface without its caps, as generate_surface() leaves it open, and the caps' patches by the nodes of their ends.
struct OpenedSurface {
  GenerateResult wall;
  std::vector<Index> wall_patch;       ///< of every face
  std::vector<Index> original_vertex;  ///< of every vertex
  std::map<Index, Index> cap_of_node;
  std::vector<Index> left_open;  ///< nodes of ends that had no cap
};

bool is_cap(const CappedPatches& patches, Index patch) {
  return std::binary_search(patches.caps.begin(), patches.caps.end(), patch);
}

/// The faces that are no caps, and the vertices that these need.
void take_wall(const VesselSurface& surface, const CappedPatches& patches, const Centerline& centerline,
               OpenedSurface& opened) {
  const VesselField field(centerline);
  std::vector<Index> number(surface.mesh.vertices.size(), kNone);
  GenerateResult& wall = opened.wall;
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    if (is_cap(patches, patches.patch[f])) continue;
    Triangle face = surface.mesh.faces[f];
    for (Index& v : face) {
      if (number[v] == kNone) {
        number[v] = static_cast<Index>(wall.mesh.vertices.size());
        wall.mesh.vertices.push_back(surface.mesh.vertices[v]);
        const CenterlineBinding& place = surface.binding[v];
        wall.binding.push_back(place);
        wall.radius.push_back(field.relations().radius_at(place.segment, place.t));
        opened.original_vertex.push_back(v);
      }
      v = number[v];
    }
    wall.mesh.faces.push_back(face);
    opened.wall_patch.push_back(patches.patch[f]);
  }
}

/// The patches of caps by the directed edges of their faces, in vertices of the whole surface.
using CapEdges = std::map<std::pair<Index, Index>, Index>;

CapEdges edges_of_caps(const VesselSurface& surface, const CappedPatches& patches) {
  CapEdges edges;
  for (Index f = 0; f < surface.mesh.faces.size(); ++f) {
    if (!is_cap(patches, patches.patch[f])) continue;
    const Triangle& face = surface.mesh.faces[f];
    for (std::size_t i = 0; i < 3; ++i) edges[{face[i], face[(i + 1) % 3]}] = patches.patch[f];
  }
  return edges;
}

/// The cap that closes an opening, or kNone.
Index cap_of(const Opening& opening, const OpenedSurface& opened, const CapEdges& edges) {
  std::set<Index> caps;
  for (std::size_t i = 0; i < opening.ring.size(); ++i) {
    const Index from = opened.original_vertex[opening.ring[i]];
    const Index to = opened.original_vertex[opening.ring[(i + 1) % opening.ring.size()]];
    const auto found = edges.find({from, to});
    caps.insert(found == edges.end() ? kNone : found->second);
  }
  if (caps.size() == 1) return *caps.begin();
  throw InvalidInput(cap_text(*caps.begin()) + ", at " + point_text(opening.center) +
                     ", touches another cap or an open end; caps must be apart");
}

void check_discs(const VesselSurface& surface, const CappedPatches& patches) {
  for (const Index cap : patches.caps) {
    TriMesh disc{surface.mesh.vertices, {}};
    for (Index f = 0; f < patches.patch.size(); ++f) {
      if (patches.patch[f] == cap) disc.faces.push_back(surface.mesh.faces[f]);
    }
    const Topology topology = measure_topology(disc);
    if (topology.components == 1 && topology.euler_characteristic == 1 && topology.boundary_loops == 1) continue;
    throw InvalidInput(cap_text(cap) + " is not one disc, as a cap over the end of a vessel is; number the wall 1");
  }
}

/// Rings of openings must not touch, or what is left of the surface is not manifold there.
void check_rings(const OpenedSurface& opened) {
  std::vector<char> begins(opened.wall.mesh.vertices.size(), 0);
  for (const auto& [from, to] : boundary_edges(opened.wall.mesh)) {
    if (begins[from]++ == 0) continue;
    throw InvalidInput("two caps touch each other at " + point_text(opened.wall.mesh.vertices[from]) +
                       "; caps must be apart");
  }
}

/// The end of a vessel to which most vertices of a ring belong.
Index end_of_ring(const Opening& opening, const std::vector<CenterlineBinding>& binding, const Centerline& centerline) {
  std::map<Index, std::size_t> votes;
  for (const Index v : opening.ring) {
    const auto& [segment, t] = binding[v];
    if (segment >= centerline.segments().size()) continue;
    const auto& [a, b] = centerline.segment(segment);
    const bool at_a = centerline.degree(a) == 1, at_b = centerline.degree(b) == 1;
    if (at_a || at_b) ++votes[at_a && (!at_b || t < 0.5) ? a : b];
  }
  const auto most =
      std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == votes.end())
    throw InvalidInput("the end at " + point_text(opening.center) +
                       " is at no end of the centerline; is it the one around which the surface was grown?");
  return most->first;
}

void find_ends(const Centerline& centerline, const CapEdges& edges, OpenedSurface& opened) {
  GenerateResult& wall = opened.wall;
  wall.openings = find_openings(wall.mesh);
  for (Opening& opening : wall.openings) {
    opening.node = end_of_ring(opening, wall.binding, centerline);
    opening.radius = centerline.node(opening.node).radius;
    const Index cap = cap_of(opening, opened, edges);
    if (cap == kNone) {
      opened.left_open.push_back(opening.node);
      continue;
    }
    const auto [other, is_new] = opened.cap_of_node.emplace(opening.node, cap);
    if (!is_new)
      throw InvalidInput(cap_text(cap) + " and that with " + std::to_string(other->second) +
                         " are both at the end of the centerline at node " + std::to_string(opening.node) +
                         "; is it the one around which the surface was grown?");
  }
  std::stable_sort(wall.openings.begin(), wall.openings.end(),
                   [](const Opening& a, const Opening& b) { return a.node < b.node; });
}

OpenedSurface without_caps(const VesselSurface& surface, const CappedPatches& patches, const Centerline& centerline) {
  check_discs(surface, patches);
  OpenedSurface opened;
  take_wall(surface, patches, centerline, opened);
  if (opened.wall.mesh.faces.empty()) throw InvalidInput("the surface has caps, but no wall");
  check_rings(opened);
  find_ends(centerline, edges_of_caps(surface, patches), opened);
  return opened;
}

/// Fits the wall and closes it again; returns the ends.
FlatEnds fit_and_close(OpenedSurface& opened, const Centerline& centerline, const TriMesh& reference,
                       const FitOptions& options, const Progress& progress, FitReport& report) {
  GenerateResult& wall = opened.wall;
  const FlatReference flat = end_at_caps(wall, reference);
  report = fit_surface(wall, centerline, flat.mesh, options, progress);
  match_cap_areas(wall, centerline, flat.caps);
  if (options.max_error > 0 && !flat.caps.empty())
    find_far_parts(report, {wall.mesh, wall.binding, wall.openings}, centerline, flat.mesh, options.max_error);
  FlatEndOptions closing;
  closing.fitted = true;
  closing.left_open = opened.left_open;
  return finish_ends(wall, centerline, closing);
}

/// The nodes of ends by their labels.
std::map<Index, Index> nodes_by_label(const FlatEnds& ends) {
  std::map<Index, Index> nodes;
  for (const FlatEnd& end : ends.ends) nodes[end.label] = end.node;
  return nodes;
}

}  // namespace

std::vector<Index> patches_by_branch(const VesselSurface& before, const std::vector<Index>& patch_before,
                                     const VesselSurface& after, const Centerline& centerline) {
  std::map<Index, std::map<Index, std::size_t>> faces;  // of a branch, by patch
  const std::vector<Index> branch_before = label_branches(before.mesh, before.binding, centerline).face;
  for (Index f = 0; f < branch_before.size(); ++f) ++faces[branch_before[f]][patch_before[f]];
  std::map<Index, Index> patch_of_branch;
  for (const auto& [branch, count] : faces)
    patch_of_branch[branch] = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                              })->first;
  std::vector<Index> patch;
  const Index first = *std::min_element(patch_before.begin(), patch_before.end());
  for (const Index branch : label_branches(after.mesh, after.binding, centerline).face) {
    const auto found = patch_of_branch.find(branch);
    patch.push_back(found == patch_of_branch.end() ? first : found->second);
  }
  return patch;
}

CappedFit fit_capped_surface(const VesselSurface& surface, const CappedPatches& patches, const Centerline& centerline,
                             const TriMesh& reference, const FitOptions& options, const Progress& progress) {
  OpenedSurface opened = without_caps(surface, patches, centerline);
  const VesselSurface before{opened.wall.mesh, opened.wall.binding, {}};
  CappedFit result;
  const FlatEnds ends = fit_and_close(opened, centerline, reference, options, progress, result.fit.report);
  result.fit.report.vertices_before = surface.mesh.vertices.size();
  GenerateResult& closed = opened.wall;
  result.fit.surface = {std::move(closed.mesh), std::move(closed.binding), std::move(closed.openings)};
  result.fit.radius = std::move(closed.radius);
  result.fit.elongation = std::move(closed.elongation);
  result.patch = patches_by_branch(before, opened.wall_patch, result.fit.surface, centerline);
  const std::map<Index, Index> node_of = nodes_by_label(ends);
  for (Index f = 0; f < ends.cap_label.size(); ++f) {
    if (ends.cap_label[f] > 0) result.patch[f] = opened.cap_of_node.at(node_of.at(ends.cap_label[f]));
  }
  return result;
}

}  // namespace vmesh
