#include "vmesh/skeleton/extract_centerline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "vmesh/centerline/branches.h"
#include "vmesh/centerline/cleaning.h"
#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"
#include "vmesh/mesh/components.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/volume/vessel_field.h"

#include "cone_fit.h"
#include "mean_curvature.h"
#include "shared_lumen.h"
#include "skeleton_graph.h"

namespace vmesh {
namespace {

using skeleton::Graph;

// A component with less than this share of the largest one's volume is debris.
constexpr double kLeastVolume = 1e-5;
constexpr int kFitRounds = 20;
constexpr int kRefinements = 2;  // the second works on the result of the first
constexpr int kMerges = 3;       // each may enable further ones; the portal and hepatic veins need two or three
// Memory per vertex of the surface, measured.
constexpr double kBytesPerVertex = 4000;

/// A component of the surface on its way to a centerline.
struct Part {
  TriMesh mesh;
  double volume = 0;
  Graph graph;
};

void check(const ExtractOptions& options) {
  if (!(options.spacing >= 0.1 && options.spacing <= 10)) throw InvalidInput("the spacing of nodes is 0.1 to 10 radii");
  if (!(options.join >= 0)) throw InvalidInput("the gap up to which parts are joined is 0 or more radii");
}

void check(const TriMesh& surface) {
  const Topology topology = measure_topology(surface);
  if (surface.faces.empty()) throw InvalidInput("the surface has no face");
  if (!topology.closed)
    throw InvalidInput("the surface is open: " + std::to_string(topology.boundary_edges) +
                       " edges have one face; close it, or give the image it was made from");
  if (!topology.manifold)
    throw InvalidInput("the surface is not manifold; repair it, or give the image it was made from");
  if (!topology.oriented) throw InvalidInput("neighbouring faces of the surface face opposite sides; orient it");
}

void turn(TriMesh& mesh) {
  for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
}

/// The components that enclose a volume, largest first.
std::vector<Part> parts_of(TriMesh surface) {
  if (enclosed_volume(surface) < 0) turn(surface);
  std::vector<Part> parts;
  for (TriMesh& mesh : split_components(surface)) {
    const double volume = enclosed_volume(mesh);
    parts.push_back({std::move(mesh), volume, {}});
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.volume > b.volume; });
  const double least = kLeastVolume * parts.front().volume;
  std::erase_if(parts, [&](const Part& part) { return !(part.volume > least); });
  if (parts.empty()) throw InvalidInput("the surface encloses no volume");
  return parts;
}

/// Removes excess loops and branches that are too short.
void tidy(Graph& graph, std::size_t loops, ExtractionReport& report) {
  report.loops_broken += skeleton::break_loops(graph, loops);
  report.spurs += skeleton::prune_spurs(graph);
  skeleton::compact(graph);
}

void extract(Part& part, const ExtractOptions& options, ExtractionReport& report, const Progress& progress) {
  Graph& graph = part.graph;
  graph = skeleton::mean_curvature_skeleton(part.mesh, progress);
  skeleton::connect(graph);
  const std::size_t loops = options.tree ? 0 : static_cast<std::size_t>(measure_topology(part.mesh).genus);
  const skeleton::SurfaceSamples samples = skeleton::samples_of(part.mesh);
  for (int i = 0; i < kRefinements; ++i) {
    report_progress(progress, "skeleton", 0);
    tidy(graph, loops, report);
    graph = skeleton::resampled(graph, options.spacing);
    skeleton::fit_cones(graph, samples, kFitRounds);
  }
  for (int i = 0; i < kMerges; ++i) {
    report_progress(progress, "skeleton", 0);
    const std::size_t merged = skeleton::merge_in_one_lumen(graph, samples);
    if (merged == 0) break;
    report.merged += merged;
    tidy(graph, loops, report);
    skeleton::fit_merged_cones(graph, samples, kFitRounds);
  }
}

/// The closest approach of two parts, node to node.
struct Gap {
  std::size_t first, second;  // parts
  Index a, b;                 // nodes of them
  double relative;            // gap between their spheres, in smaller radii
};

Gap gap_between(const std::vector<Part>& parts, std::size_t first, std::size_t second) {
  Gap gap{first, second, 0, 0, std::numeric_limits<double>::infinity()};
  const auto &from = parts[first].graph.nodes, &to = parts[second].graph.nodes;
  for (Index a = 0; a < from.size(); ++a) {
    for (Index b = 0; b < to.size(); ++b) {
      const double free = (from[a].position - to[b].position).norm() - from[a].radius - to[b].radius;
      const double relative = free / std::min(from[a].radius, to[b].radius);
      if (relative < gap.relative) gap.a = a, gap.b = b, gap.relative = relative;
    }
  }
  return gap;
}

/// Groups of parts; the edges between them are appended to `joints`, never enough to close a loop.
std::vector<std::size_t> join(const std::vector<Part>& parts, double limit, std::vector<Gap>& joints) {
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) gaps.push_back(gap_between(parts, i, j));
  std::stable_sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.relative < b.relative; });
  std::vector<std::size_t> group(parts.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const Gap& gap : gaps) {
    if (gap.relative > limit || group[gap.first] == group[gap.second]) continue;
    const auto [low, high] = std::minmax(group[gap.first], group[gap.second]);
    std::replace(group.begin(), group.end(), std::size_t{high}, std::size_t{low});
    joints.push_back(gap);
  }
  return group;
}

/// The group with the largest volume.
std::size_t largest(const std::vector<Part>& parts, const std::vector<std::size_t>& group) {
  std::vector<double> volumes(parts.size(), 0);
  for (std::size_t p = 0; p < parts.size(); ++p) volumes[group[p]] += parts[p].volume;
  return static_cast<std::size_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
}

/// All kept parts and their joints in one graph.
Graph combined(const std::vector<Part>& parts, const std::vector<bool>& kept, const std::vector<Gap>& joints) {
  Graph all;
  std::vector<Index> offset(parts.size(), kNone);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!kept[p]) continue;
    offset[p] = static_cast<Index>(all.nodes.size());
    all.nodes.insert(all.nodes.end(), parts[p].graph.nodes.begin(), parts[p].graph.nodes.end());
    for (const auto& [a, b] : parts[p].graph.edges) all.edges.push_back({a + offset[p], b + offset[p]});
  }
  for (const Gap& joint : joints)
    if (kept[joint.first]) all.edges.push_back({joint.a + offset[joint.first], joint.b + offset[joint.second]});
  return all;
}

Centerline cleaned(const Graph& graph) {
  RawCenterline raw;
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  raw.source = "the skeleton";
  for (const skeleton::Node& node : graph.nodes) raw.nodes.push_back({node.position, node.radius});
  for (const auto& [a, b] : graph.edges) raw.segments.push_back({a, b});
  return clean(raw).centerline;
}

/// A point of the surface and how far it is from the vessels' boundary.
struct Deviation {
  double distance, area;
  Vec3 point;
};

Coverage summarized(std::vector<Deviation> deviations) {
  Coverage coverage;
  if (deviations.empty()) return coverage;
  std::sort(deviations.begin(), deviations.end(),
            [](const Deviation& a, const Deviation& b) { return a.distance < b.distance; });
  for (const Deviation& d : deviations) {
    coverage.area += d.area;
    coverage.mean += d.area * d.distance;
  }
  if (coverage.area > 0) coverage.mean /= coverage.area;
  coverage.max = deviations.back().distance;
  coverage.max_at = deviations.back().point;
  double below = 0;
  for (const Deviation& d : deviations) {
    coverage.percentile_95 = d.distance;
    if ((below += d.area) >= 0.95 * coverage.area) break;
  }
  return coverage;
}

void measure(ExtractionReport& report, const Centerline& centerline, const std::vector<Part>& parts,
             const std::vector<bool>& kept) {
  const VesselField field(centerline);
  const std::vector<Branch> branches = find_branches(centerline);
  std::vector<std::size_t> branch_of(field.cone_count(), branches.size());  // isolated nodes have none
  for (std::size_t b = 0; b < branches.size(); ++b) {
    for (const Index segment : branches[b].segments) branch_of[segment] = b;
  }
  std::vector<Deviation> all;
  std::vector<std::vector<Deviation>> of_branch(branches.size() + 1);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!kept[p]) continue;
    const skeleton::SurfaceSamples samples = skeleton::samples_of(parts[p].mesh);
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      const FieldSample sample = field.sample_global(samples.points[i]);
      all.push_back({std::abs(sample.distance), samples.areas[i], samples.points[i]});
      of_branch[branch_of[sample.cone]].push_back(all.back());
    }
  }
  of_branch.pop_back();
  for (std::vector<Deviation>& deviations : of_branch) report.branches.push_back(summarized(std::move(deviations)));
  report.coverage = summarized(std::move(all));
}

}  // namespace

ExtractedCenterline extract_centerline(const TriMesh& surface, const ExtractOptions& options,
                                       const Progress& progress) {
  check(options);
  check(surface);
  require_memory(kBytesPerVertex * static_cast<double>(surface.vertices.size()),
                 "the centerline of a surface of " + std::to_string(surface.vertices.size()) + " vertices",
                 "make the surface coarser");
  std::vector<Part> parts = parts_of(surface);
  ExtractionReport report;
  report.parts = parts.size();
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Progress ask = [&](std::string_view stage, double) {
      return !progress || progress(stage, static_cast<double>(p) / static_cast<double>(parts.size()));
    };
    extract(parts[p], options, report, ask);
  }
  std::vector<Gap> joints;
  const std::vector<std::size_t> group = join(parts, options.join, joints);
  const std::size_t best = largest(parts, group);
  std::vector<bool> kept(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) kept[p] = options.all_components || group[p] == best;
  report.left_out = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), false));
  report.joined = static_cast<std::size_t>(
      std::count_if(joints.begin(), joints.end(), [&](const Gap& joint) { return kept[joint.first]; }));
  Centerline centerline = cleaned(combined(parts, kept, joints));
  measure(report, centerline, parts, kept);
  return {std::move(centerline), report};
}

}  // namespace vmesh
