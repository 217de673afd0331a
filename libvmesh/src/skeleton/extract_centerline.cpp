#include "vmesh/skeleton/extract_centerline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "vmesh/centerline/cleaning.h"
#include "vmesh/core/disjoint_sets.h"
#include "vmesh/core/error.h"
#include "vmesh/core/memory.h"

#include "closed_wall.h"
#include "cone_fit.h"
#include "coverage.h"
#include "end_joining.h"
#include "loop_necks.h"
#include "mask_content.h"
#include "ring_shape.h"
#include "skeleton_graph.h"
#include "voxel_cleaning.h"
#include "wall_samples.h"
#include "wall_voxels.h"

namespace vmesh {
namespace {

using skeleton::FitRounds;
using skeleton::FitSamples;
using skeleton::FitVoxels;
using skeleton::Graph;
using skeleton::MaskContent;
using skeleton::VoxelSkeleton;

constexpr double kSpacing = 1;  // of nodes while they are fitted, radii
// A wall that is rough is smoothed like one of larger voxels: larger by this times the distances beyond the slack.
constexpr double kNoise = 4;
// The same for voxels beside the wall, whose size counts by a share; they err by a share of a voxel at least.
constexpr double kVoxelNoise = 6, kVoxelShare = 0.5, kLeastBlur = 0.1;
constexpr int kFirstRounds = 6, kVoxelRounds = 10;
constexpr double kVoxelSmoothPosition = 0.003, kVoxelRough = 20;
constexpr double kLeastRadius = 1.5;  // voxels; thinner vessels have nodes as far apart as ones of that radius
// Measured: 70 to 230, and for every face of a voxel at the wall up to 450, of which vessels of a voxel have four.
constexpr double kBytesPerVoxel = 250, kBytesPerFace = 450;

void check(const ExtractOptions& options) {
  if (!(options.spacing >= 0.1 && options.spacing <= 10)) throw InvalidInput("the spacing of nodes is 0.1 to 10 radii");
  if (!(options.join >= 0)) throw InvalidInput("the gap up to which ends are joined is 0 or more radii");
  if (!(options.least_length >= 0)) throw InvalidInput("the least length of a component is 0 or more mm");
}

/// The vessels on their way to a centerline.
struct Work {
  Graph graph;
  struct Wall {
    FitSamples samples;
    std::vector<Index> component;  // of every sample
  };
  Wall wall;
  struct Voxels {
    FitVoxels beside_wall;
    std::vector<Index> component;  // of every voxel
  };
  Voxels voxels;                    // of a mask without grey values
  Wall reported;                    // denser, for the report; empty: the same
  std::vector<bool> kept;           // of every component
  std::vector<double> path_length;  // mm, likewise
  std::vector<EndSection> sections;
  double voxel = 0;       // mm, of the grid
  double wall_voxel = 0;  // mm, the longest side; 0 for a wall that is not made of voxels
  double mean_voxel = 0;  // mm, likewise
  StageClock clock;
  ExtractionReport report;
};

/// Total length of the paths of every component.
std::vector<double> path_lengths(const VoxelSkeleton& skeleton) {
  std::vector<double> lengths(skeleton.components.size(), 0);
  for (Index e = 0; e < skeleton.graph.edges.size(); ++e)
    lengths[skeleton.graph.nodes[skeleton.graph.edges[e][0]].component] += skeleton.graph.length(e);
  return lengths;
}

/// Takes components that are no vessels out of the graph.
void leave_out_others(VoxelSkeleton& skeleton, Work& work) {
  work.path_length = path_lengths(skeleton);
  for (const skeleton::VoxelComponent& component : skeleton.components) work.kept.push_back(component.kept);
  std::vector<bool> removed(skeleton.graph.edges.size(), false);
  for (Index e = 0; e < removed.size(); ++e)
    removed[e] = !work.kept[skeleton.graph.nodes[skeleton.graph.edges[e][0]].component];
  skeleton::remove_edges(skeleton.graph, removed);
}

/// Applies --largest and --least-length to the components of the graph, as they are after ends were joined.
void choose_components(Work& work, const ExtractOptions& options) {
  if (!options.largest && options.least_length == 0) return;
  Graph& graph = work.graph;
  DisjointSets sets(graph.nodes.size());
  for (const auto& [a, b] : graph.edges) sets.join(a, b);
  std::vector<double> length(graph.nodes.size(), 0);  // of the set that a node stands for
  for (Index e = 0; e < graph.edges.size(); ++e) length[sets.find(graph.edges[e][0])] += graph.length(e);
  const auto longest = static_cast<Index>(std::max_element(length.begin(), length.end()) - length.begin());
  const auto is_chosen = [&](Index n) {
    const Index set = sets.find(n);
    return options.largest ? set == longest : length[set] >= options.least_length;
  };
  if (!is_chosen(longest))
    throw InvalidInput("no component is as long as the least length of " + std::to_string(options.least_length) +
                       " mm");
  Graph chosen;
  std::vector<Index> number(graph.nodes.size(), kNone);
  std::fill(work.kept.begin(), work.kept.end(), false);
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    if (!is_chosen(n)) continue;
    number[n] = static_cast<Index>(chosen.nodes.size());
    chosen.nodes.push_back(graph.nodes[n]);
    work.kept[graph.nodes[n].component] = true;
  }
  for (const auto& [a, b] : graph.edges)
    if (number[a] != kNone) chosen.edges.push_back({number[a], number[b]});
  graph = std::move(chosen);
}

void count_components(Work& work) {
  double all = 0, left = 0;
  for (std::size_t c = 0; c < work.kept.size(); ++c) {
    all += work.path_length[c];
    left += work.kept[c] ? 0 : work.path_length[c];
    work.report.left_out += !work.kept[c];
  }
  work.report.components = work.kept.size();
  work.report.length_coverage = all > 0 ? 1 - left / all : 1;
}

/// Nodes without an edge that stand for a component: the one with the largest radius of each.
void drop_others(VoxelSkeleton& skeleton, std::vector<EndSection>& sections) {
  Graph& graph = skeleton.graph;
  const auto edges_at = skeleton::incidence(graph);
  std::vector<bool> has_edge(skeleton.components.size(), false);
  std::vector<Index> widest(skeleton.components.size(), kNone);
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    const Index c = graph.nodes[n].component;
    if (!edges_at[n].empty()) has_edge[c] = true;
    if (widest[c] == kNone || graph.nodes[n].radius > graph.nodes[widest[c]].radius) widest[c] = n;
  }
  Graph kept;
  std::vector<Index> number(graph.nodes.size(), kNone);
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    const Index c = graph.nodes[n].component;
    const bool stands_alone = skeleton.components[c].kept && !has_edge[c] && widest[c] == n;
    if (edges_at[n].empty() && !stands_alone) continue;
    number[n] = static_cast<Index>(kept.nodes.size());
    kept.nodes.push_back(graph.nodes[n]);
  }
  for (const auto& [a, b] : graph.edges) kept.edges.push_back({number[a], number[b]});
  for (EndSection& section : sections)
    if (section.node != kNone) section.node = number[section.node];
  std::erase_if(sections, [](const EndSection& section) { return section.node == kNone; });
  graph = std::move(kept);
}

/// The vertices of a wall's ring lie on the vessel's boundary, as those of the wall do.
double radius_at(const EndSection& section, bool balanced_wall) {
  const double arcs = balanced_wall ? 0 : skeleton::area_of_arcs(section.ring, section.normal);
  return std::sqrt((section.area + arcs) / std::numbers::pi);
}

/// Places the nodes at flat ends in their middle. The depth of the voxels near a flat end tells nothing of the radius.
void place_sections(Graph& graph, const std::vector<EndSection>& sections, bool balanced_wall) {
  const auto edges_at = skeleton::incidence(graph);
  for (const EndSection& section : sections) {
    const double radius = radius_at(section, balanced_wall);
    graph.nodes[section.node] = {section.center, radius, radius, graph.nodes[section.node].component, true};
    Index n = section.node, before = kNone;
    while (edges_at[n].size() == (n == section.node ? 1u : 2u)) {
      before = edges_at[n][edges_at[n].front() == before ? edges_at[n].size() - 1 : 0];
      n = skeleton::other_end(graph, before, n);
      if (graph.nodes[n].fixed || (graph.nodes[n].position - section.center).norm() > radius) break;
      graph.nodes[n].radius = std::max(graph.nodes[n].radius, radius);
    }
  }
}

/// The samples of components that are kept.
FitSamples kept_samples(const Work& work) {
  FitSamples samples;
  const FitSamples& wall = work.wall.samples;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    if (!work.kept[work.wall.component[i]]) continue;
    samples.points.push_back(wall.points[i]);
    samples.areas.push_back(wall.areas[i]);
    samples.slack.push_back(wall.slack[i]);
  }
  return samples;
}

FitVoxels kept_voxels(const Work& work) {
  const FitVoxels& all = work.voxels.beside_wall;
  FitVoxels voxels;
  voxels.volume = all.volume;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!work.kept[work.voxels.component[i]]) continue;
    voxels.points.push_back(all.points[i]);
    voxels.inside.push_back(all.inside[i]);
  }
  return voxels;
}

/// First by the wall, which reaches far and tells how rough it is. Then, on the result, by the voxels if there are
/// any, else by the wall again. Nodes get their spacing last: the fit and what it prunes depend on that.
void fit(Work& work, const ExtractOptions& options, const Progress& progress) {
  const FitSamples samples = kept_samples(work);
  FitVoxels voxels = kept_voxels(work);
  const auto resample = [&](double spacing) {
    work.graph = skeleton::resampled(work.graph, spacing, kLeastRadius * work.voxel);
  };
  const auto prune = [&] {
    work.report.spurs += skeleton::prune_spurs(work.graph) + skeleton::prune_contained(work.graph);
  };
  resample(kSpacing);
  FitRounds first{.voxel = work.wall_voxel};
  if (voxels.size() > 0) first.most = kFirstRounds;
  const double noise = skeleton::fit_cones(work.graph, samples, first, progress);
  prune();
  voxels.blur = std::max(kLeastBlur * work.mean_voxel, noise);
  const auto refit = [&](double spacing) {
    FitRounds rounds{.spacing = spacing, .voxel = work.wall_voxel + kNoise * noise};
    if (voxels.size() == 0) {
      skeleton::fit_cones(work.graph, samples, rounds, progress);
      return;
    }
    rounds.voxel = kVoxelShare * work.wall_voxel + kVoxelNoise * noise;
    rounds.smooth_position = kVoxelSmoothPosition;
    rounds.rough = kVoxelRough;
    rounds.most = kVoxelRounds;
    skeleton::fit_cones(work.graph, voxels, rounds, progress);
  };
  resample(kSpacing);
  refit(kSpacing);
  prune();
  if (options.spacing == kSpacing) return;
  resample(options.spacing);
  refit(options.spacing);
}

/// As a valid centerline; the sections refer to its nodes.
Centerline cleaned(const Graph& graph, std::vector<EndSection>& sections) {
  RawCenterline raw;
  raw.unit = LengthUnit::mm;
  raw.space = Space::lps;
  raw.source = "the skeleton";
  for (const skeleton::Node& node : graph.nodes) raw.nodes.push_back({node.position, node.radius});
  for (const auto& [a, b] : graph.edges) raw.segments.push_back({a, b});
  CleanedCenterline result = clean(raw);
  std::vector<Index> number(graph.nodes.size(), kNone);
  for (Index n = 0; n < result.raw_node.size(); ++n) number[result.raw_node[n]] = n;
  for (EndSection& section : sections) section.node = number[section.node];
  std::erase_if(sections, [](const EndSection& section) { return section.node == kNone; });
  std::sort(sections.begin(), sections.end(), [](const EndSection& a, const EndSection& b) { return a.node < b.node; });
  return std::move(result.centerline);
}

/// The node of every section in a graph that was resampled: nodes at sections are fixed and stay where they are.
void find_sections(const Graph& graph, std::vector<EndSection>& sections) {
  for (EndSection& section : sections) {
    section.node = kNone;
    for (Index n = 0; n < graph.nodes.size(); ++n)
      if (graph.nodes[n].fixed && graph.nodes[n].position == section.center) section.node = n;
  }
  std::erase_if(sections, [](const EndSection& section) { return section.node == kNone; });
}

ExtractedCenterline finish(VoxelSkeleton skeleton, Work work, const ExtractOptions& options, const Progress& progress) {
  leave_out_others(skeleton, work);
  drop_others(skeleton, work.sections);
  work.graph = std::move(skeleton.graph);
  work.report.joined = std::move(skeleton.bridges);
  place_sections(work.graph, work.sections, options.balanced_wall);
  work.report.loops = skeleton::find_loops(work.graph, work.voxel, options.tree);
  work.clock.lap("skeleton", work.report.stages);
  fit(work, options, progress);
  for (const JoinedGap& gap : skeleton::join_ends(work.graph, options.join, work.voxel))
    work.report.joined.push_back(gap);
  choose_components(work, options);
  count_components(work);
  find_sections(work.graph, work.sections);
  Centerline centerline = cleaned(work.graph, work.sections);
  work.clock.lap("cones", work.report.stages);
  std::vector<bool> left_out;
  const Work::Wall& wall = work.reported.component.empty() ? work.wall : work.reported;
  for (const Index c : wall.component) left_out.push_back(!work.kept[c]);
  skeleton::measure_coverage(centerline, wall.samples, left_out, work.mean_voxel, work.report);
  work.clock.lap("coverage", work.report.stages);
  return {std::move(centerline), std::move(work.sections), std::move(work.report)};
}

EndSection section_of(const skeleton::BorderEnd& end, const skeleton::VoxelFrame& frame, Index node) {
  EndSection section;
  section.node = node;
  section.normal = end.way * frame.steps.col(end.axis).normalized();
  section.center = frame.position(end.middle) + 0.5 * end.way * frame.steps.col(end.axis);
  section.area = end.area;
  return section;
}

void note_filled(const skeleton::FilledHoles& filled, std::vector<std::string>& notes) {
  if (filled.cavities > 0) notes.push_back(std::to_string(filled.cavities) + " voxels of cavities were filled");
  if (filled.pinholes > 0) notes.push_back(std::to_string(filled.pinholes) + " voxels of pinholes were filled");
}

/// The voxel inside that is nearest to the middle of a flat end.
Index voxel_at(const skeleton::VoxelVolume& volume, const skeleton::FlatWallEnd& end) {
  constexpr int kReach = 4;  // voxels
  const double voxel = volume.frame.steps(0, 0);
  const Vec3 middle = (end.center - 0.5 * voxel * end.normal - volume.frame.origin) / voxel;
  const Vec3 rounded = middle.array().round();
  Index nearest = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (int k = -kReach; k <= kReach; ++k)
    for (int j = -kReach; j <= kReach; ++j)
      for (int i = -kReach; i <= kReach; ++i) {
        const Vec3 at = rounded + Vec3(i, j, k);
        if ((at.array() < -4).any()) continue;
        const double distance = (at - middle).squaredNorm();
        if (!(distance < least)) continue;
        const skeleton::Voxel v = {static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2])};
        bool within = true;
        for (std::size_t a = 0; a < 3; ++a) within = within && v[a] < static_cast<int>(volume.voxels.grid_size()[a]);
        if (const Index n = within ? volume.voxels.number(v) : kNone; n != kNone) least = distance, nearest = n;
      }
  return nearest;
}

// Radii between samples: for the fit, and for the report, whose figures have to hold between the samples as well.
constexpr double kFitSpacing = 0.3, kReportSpacing = 0.1;

/// Samples of the wall, without what closes its ends: on the faces, or for the fit where these have their vertices.
void add_samples(const skeleton::WallPart& part, const std::vector<double>& radius, double spacing, bool smooth,
                 Index component, Work::Wall& wall) {
  const auto is_wall = [&](Index f) { return part.is_wall(f); };
  skeleton::WallSamples samples =
      skeleton::samples_by_area(part.mesh, [&](Index f) { return is_wall(f) ? spacing * radius[f] : 0.0; });
  if (smooth) skeleton::move_onto_smooth_wall(samples, part.mesh, is_wall);
  wall.samples.points.insert(wall.samples.points.end(), samples.points.begin(), samples.points.end());
  wall.samples.areas.insert(wall.samples.areas.end(), samples.areas.begin(), samples.areas.end());
  wall.samples.slack.resize(wall.samples.size(), 0);
  wall.component.resize(wall.samples.size(), component);
}

/// The radius of the vessel at every face.
std::vector<double> radii_at(const TriMesh& mesh, const Graph& graph) {
  const skeleton::GraphCones cones(graph);
  std::vector<Vec3> middles;
  for (const auto& [a, b, c] : mesh.faces)
    middles.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  std::vector<double> radii;
  for (const skeleton::GraphCones::Place& place : cones.closest(middles)) radii.push_back(cones.radius_at(place));
  return radii;
}

void append(VoxelSkeleton&& part, VoxelSkeleton& all) {
  const auto nodes = static_cast<Index>(all.graph.nodes.size()), components = static_cast<Index>(all.components.size());
  for (skeleton::Node& node : part.graph.nodes) {
    node.component += components;
    all.graph.nodes.push_back(node);
  }
  for (const auto& [a, b] : part.graph.edges) all.graph.edges.push_back({a + nodes, b + nodes});
  all.components.insert(all.components.end(), part.components.begin(), part.components.end());
}

/// Of a part's components, the one with the longest path stands for its wall.
Index main_component(const VoxelSkeleton& part) {
  const auto longer = [](const auto& a, const auto& b) { return a.length < b.length; };
  return static_cast<Index>(std::max_element(part.components.begin(), part.components.end(), longer) -
                            part.components.begin());
}

}  // namespace

ExtractedCenterline extract_centerline(const TriMesh& surface, const ExtractOptions& options,
                                       const Progress& progress) {
  check(options);
  report_progress(progress, "wall", 0);
  const skeleton::ClosedWall wall = skeleton::close_wall(surface, progress);
  Work work;
  work.report.notes = wall.notes;
  work.clock.lap("wall", work.report.stages);
  work.voxel = std::numeric_limits<double>::infinity();
  VoxelSkeleton all;
  for (std::size_t p = 0; p < wall.parts.size(); ++p) {
    const skeleton::WallPart& part = wall.parts[p];
    const double voxel = skeleton::voxel_size_for(part.mesh, part.volume);
    work.voxel = std::min(work.voxel, voxel);
    skeleton::VoxelVolume volume = skeleton::voxels_inside(part.mesh, voxel);
    skeleton::fill_holes(volume.voxels);
    if (volume.voxels.size() == 0) continue;
    std::vector<skeleton::KnownEnd> known;
    std::vector<EndSection> sections;
    for (const skeleton::FlatWallEnd& end : wall.ends) {
      if (end.part != p) continue;
      known.push_back({voxel_at(volume, end), std::sqrt(end.area / std::numbers::pi)});
      sections.push_back({kNone, end.center, end.normal, end.area, end.ring, end.was_open});
    }
    const Progress of_part = [&](std::string_view stage, double fraction) {
      return !progress || progress(stage, (static_cast<double>(p) + fraction) / static_cast<double>(wall.parts.size()));
    };
    VoxelSkeleton skeleton = skeleton::skeleton_of(volume.voxels, volume.frame, known, of_part);
    const auto offset = static_cast<Index>(all.graph.nodes.size());
    for (std::size_t e = 0; e < sections.size(); ++e) {
      if (skeleton.node_of_end[e] == kNone) continue;
      sections[e].node = skeleton.node_of_end[e] + offset;
      work.sections.push_back(std::move(sections[e]));
    }
    const Index component = static_cast<Index>(all.components.size()) + main_component(skeleton);
    const std::vector<double> radius = radii_at(part.mesh, skeleton.graph);
    add_samples(part, radius, kFitSpacing, !options.balanced_wall, component, work.wall);
    add_samples(part, radius, kReportSpacing, false, component, work.reported);
    append(std::move(skeleton), all);
  }
  if (all.graph.nodes.empty()) throw InvalidInput("the surface encloses no volume");
  return finish(std::move(all), std::move(work), options, progress);
}

ExtractedCenterline extract_centerline(VesselMask vessels, const ExtractOptions& options, const Progress& progress) {
  check(options);
  MaskContent& mask = vessels.content();
  require_memory(kBytesPerVoxel * static_cast<double>(mask.voxels.size()),
                 "the centerline of " + std::to_string(mask.voxels.size()) + " voxels", "use larger voxels");
  Work work;
  mask.as_given = mask.voxels;
  note_filled(skeleton::fill_holes(mask.voxels), work.report.notes);
  work.clock.lap("voxels", work.report.stages);
  work.voxel = mask.frame.spacing().minCoeff();
  work.wall_voxel = mask.frame.spacing().maxCoeff();
  work.mean_voxel = std::cbrt(mask.frame.spacing().prod());
  const std::vector<skeleton::BorderEnd> ends = skeleton::border_ends(mask.voxels, mask.frame);
  std::vector<skeleton::KnownEnd> known;
  for (const skeleton::BorderEnd& end : ends) known.push_back(end.end);
  VoxelSkeleton skeleton = skeleton::skeleton_of(mask.voxels, mask.frame, known, progress);
  work.wall.samples = skeleton::wall_of(mask, ends, skeleton.component_of_voxel, work.wall.component);
  require_memory(kBytesPerFace * static_cast<double>(work.wall.samples.size()),
                 "fitting cones to " + std::to_string(work.wall.samples.size()) + " faces of voxels",
                 "use larger voxels");
  if (!mask.options.threshold)
    work.voxels.beside_wall = skeleton::voxels_beside_wall(mask, skeleton.component_of_voxel, work.voxels.component);
  mask = {};
  for (std::size_t e = 0; e < ends.size(); ++e)
    if (skeleton.node_of_end[e] != kNone)
      work.sections.push_back(section_of(ends[e], skeleton.frame, skeleton.node_of_end[e]));
  return finish(std::move(skeleton), std::move(work), options, progress);
}

}  // namespace vmesh
