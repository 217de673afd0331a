#include "surface/junction/junction_growth.h"

#include <numbers>

#include "surface/junction/node_frame.h"
#include "surface/remesh/optimize.h"
#include "surface/remesh/sweep_state.h"

namespace vmesh {
namespace {

constexpr double kSpacing = 1;            // of the lattice, in the smallest radii ...
constexpr double kMostPoints = 300'000;   // in the lattice, about
constexpr int kSweeps = 5;                // from the lattice's triangles to those of the size field
constexpr double kHoleRadius = 1.6;       // of the hole for a thread, in radii
constexpr int kSpotSweeps = 20;           // towards a size field with fine spots: about a halving each
constexpr double kVerticesPerSpot = 300;  // for 1:1000, about
constexpr double kShortestRimEdge = 0.4;  // intended edges of the surface
constexpr double kRimStep = 0.3;          // radii that a rim's vertex may move onto the boundary
constexpr double kOwnReach = 1.5;         // radii along the branch from which a tip's vertices come

Index widest_node(const Centerline& centerline) {
  Index widest = 0;
  for (Index n = 1; n < centerline.nodes().size(); ++n) {
    if (centerline.node(n).radius > centerline.node(widest).radius) widest = n;
  }
  return widest;
}

// As fine as the thinnest vessel asks for and the number of points allows.
double lattice_spacing(const Centerline& centerline) {
  double thinnest = std::numeric_limits<double>::infinity(), volume = 0;
  for (const auto& node : centerline.nodes()) {
    thinnest = std::min(thinnest, node.radius);
    volume += 4.0 / 3 * std::numbers::pi * node.radius * node.radius * node.radius;
  }
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const double radius = centerline.radius_at(s, 0.5);
    volume += std::numbers::pi * radius * radius * centerline.length(s);
  }
  // In units near the radius: std::cbrt rounds otherwise below 1 than above, and scales would not be alike to the bit.
  const double unit = std::ldexp(1.0, std::ilogb(thinnest));
  const double most_points_spacing = unit * std::cbrt(2 * volume / (unit * unit * unit) / kMostPoints);
  return std::max(kSpacing * thinnest, most_points_spacing);  // two points to a cube
}

// The lattice's surface in a mesh that is bound to the field.
void fill(BoundSurface& surface, const LatticeSurface& lattice) {
  for (std::size_t i = 0; i < lattice.vertices.size(); ++i) {
    const Vertex v = surface.mesh.add_vertex(lattice.vertices[i]);
    surface.place(v, lattice.vertices[i], surface.field.sample(lattice.vertices[i], lattice.cones[i]));
  }
  for (const auto& [a, b, c] : lattice.faces) surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
}

std::vector<Thread> threads_of(const VesselField& field, const std::vector<BranchAxis>& axes,
                               const Junction& junction) {
  const JunctionCenterline local = make_junction_centerline(field.centerline(), axes, junction);
  const Centerline centerline(local.nodes, local.segments);
  const std::vector<Thread> narrow = narrow_openings(axes, junction, lattice_spacing(centerline));
  if (narrow.empty()) return narrow;
  return find_threads(narrow, VesselField(centerline, field.blend()), local, axes, junction);
}

LatticeSurface grow_lattice(const VesselField& field) {
  const Centerline& centerline = field.centerline();
  const Index start = widest_node(centerline);
  const Index hint = centerline.degree(start) > 0 ? centerline.incident_segments(start)[0] : 0;
  return grow_in_lattice(field, centerline.node(start).position, hint, lattice_spacing(centerline),
                         frame_at(centerline, start), centerline.cycle_rank());
}

}  // namespace

JunctionGrowth::JunctionGrowth(const VesselField& field, const std::vector<BranchAxis>& axes,
                               const GrowthSkeleton& skeleton, const Junction& junction, const GenerateOptions& options,
                               bool leave_out_threads)
    : field_(field),
      axes_(axes),
      skeleton_(skeleton),
      junction_(junction),
      options_(options),
      threads_(leave_out_threads ? threads_of(field, axes, junction) : std::vector<Thread>{}),
      local_(make_junction_centerline(field.centerline(), axes, without_threads(junction, threads_))),
      centerline_(local_.nodes, local_.segments),
      local_field_(centerline_, options.blend),
      lattice_(grow_lattice(local_field_)) {
  for (Thread& thread : threads_) {
    const Gap& gap = junction.gaps[thread.gap];
    thread.exit = find_exit(thread, axes[gap.branch], gap, local_field_, local_.end_segment(thread.gap, thread.at_end));
  }
}

JunctionSurface JunctionGrowth::make(double finer, bool smooth_rims, bool guarded) const {
  const GenerateResult piece = onto_boundary(finer, guarded);
  JunctionSurface result;
  DiscCutter cutter(piece.mesh.vertices, piece.mesh.faces);
  for (Index g = 0; g < junction_.gaps.size(); ++g) {
    for (const bool at_end : {false, true}) {
      if (junction_.gaps[g].openings[at_end].tube != kNone)
        result.rims.push_back(cut_opening(cutter, piece, g, at_end, smooth_rims));
    }
  }
  result.patch.faces = cutter.rest();
  for (Index v = 0; v < cutter.vertices().size(); ++v) {
    result.patch.vertices.push_back({cutter.vertices()[v], original_cone(piece.binding[cutter.source(v)].segment)});
  }
  return result;
}

const Thread* JunctionGrowth::thread_at(Index gap, bool at_end) const {
  const auto it = std::find_if(threads_.begin(), threads_.end(),
                               [&](const Thread& thread) { return thread.gap == gap && thread.at_end == at_end; });
  return it == threads_.end() ? nullptr : &*it;
}

GenerateResult JunctionGrowth::onto_boundary(double finer, bool guarded) const {
  BoundSurface surface(local_field_);
  fill(surface, lattice_);
  if (guarded) surface.guard_crossings();
  GenerateOptions options = options_;
  options.sweeps = kSweeps;
  options.max_error = {};
  options.around = std::max(3, static_cast<int>(finer * options_.around));
  const double expected = expected_vertices(centerline_, options.around);
  optimize(surface, options,
           {std::min<double>(finer * kGrownAround, options.around), expected, GrownMesh::Stage::piece}, {});
  if (!threads_.empty()) {
    for (const Thread& thread : threads_) surface.fine_spots.push_back({thread.exit.center, thread.exit.radius});
    options.sweeps = kSpotSweeps;
    const double around_spots = kVerticesPerSpot * static_cast<double>(threads_.size());
    optimize(surface, options, {static_cast<double>(options.around), expected + around_spots, GrownMesh::Stage::piece},
             {});
  }
  GenerateResult piece;
  surface.export_to(piece);
  return piece;
}

// The cross-section at which the junction ends, half a step before its tube.
CrossSection JunctionGrowth::way_out(const TubeEnd& opening) const {
  const Tube& tube = skeleton_.tubes[opening.tube];
  CrossSection section = (opening.at_end ? tube.rings.back() : tube.rings.front()).beside[opening.at_end];
  if (opening.at_end) section.normal = -section.normal;
  return section;
}

// Returns the rim; moved onto the boundary and rid of short edges, or as it was cut.
std::vector<Index> JunctionGrowth::cut_opening(DiscCutter& cutter, const GenerateResult& piece, Index gap, bool at_end,
                                               bool smooth) const {
  const Thread* thread = thread_at(gap, at_end);
  const auto [place, center, normal, radius] = thread ? thread->exit : way_out(junction_.gaps[gap].openings[at_end]);
  const double shortest = smooth ? kShortestRimEdge * edge_length_per_radius(options_.around) * radius : 0;
  std::vector<Index> rim =
      thread ? cutter.cut_around(center, normal, kHoleRadius * radius, shortest)
             : cutter.cut(center, normal, vertices_near_end(piece, gap, at_end, kOwnReach * radius), shortest);
  if (smooth) move_onto_boundary(cutter, rim, piece, kRimStep * radius);
  return rim;
}

void JunctionGrowth::move_onto_boundary(DiscCutter& cutter, const std::vector<Index>& rim, const GenerateResult& piece,
                                        double longest) const {
  for (const Index v : rim) {
    const Vec3 p = cutter.vertices()[v];
    const Vec3 target = project_to_boundary(local_field_, p, piece.binding[cutter.source(v)].segment).position;
    if ((target - p).norm() < longest) cutter.move(v, target);
  }
}

// The cone of the whole field that a cone of the junction's field is part of.
Index JunctionGrowth::original_cone(Index cone) const {
  if (local_.origins.empty()) {
    Index ball = static_cast<Index>(field_.centerline().segments().size());
    while (field_.first_node(ball) != junction_.nodes.front()) ++ball;
    return ball;
  }
  const auto& origin = local_.origins[cone];
  const BranchAxis& axis = axes_[junction_.gaps[origin.gap].branch];
  return axis.branch().segments[axis.at(0.5 * (origin.begin + origin.end)).piece];
}

// The vertices bound to a gap, near one of its ends and nearer than to the other.
std::vector<Index> JunctionGrowth::vertices_near_end(const GenerateResult& piece, Index gap, bool at_end,
                                                     double reach) const {
  const double begin = junction_.gaps[gap].begin, end = junction_.gaps[gap].end;
  std::vector<Index> near;
  for (Index v = 0; v < piece.binding.size(); ++v) {
    const auto& [segment, t] = piece.binding[v];
    const auto& origin = local_.origins[segment];
    const double place = origin.begin + t * (origin.end - origin.begin);
    const double away = at_end ? end - place : place - begin;
    if (origin.gap == gap && away < reach && away < 0.5 * (end - begin)) near.push_back(v);
  }
  return near;
}

}  // namespace vmesh
