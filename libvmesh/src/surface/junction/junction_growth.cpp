#include "surface/junction/junction_growth.h"

#include <algorithm>
#include <numbers>

#include "surface/finish/optimize.h"
#include "surface/junction/docked_junction.h"
#include "surface/junction/node_frame.h"
#include "surface/junction/thinning.h"
#include "surface/remesh/sweep_state.h"

namespace vmesh {
namespace {

// Lattice spacing, in radii of the junction's thinnest vessel, but no finer than kFiner radii of the local vessel.
// Measured on 14 liver and synthetic trees: at 0.5 to 1 for kFiner vertices, skewness and mean error are the same to 2
// %; kSpacing 1.3 is unsafe. kSpacing: safe 0.85 to 1.4, below slower; kFiner: safe 0.51 to 0.84, below
// slower.
constexpr double kSpacing = 1, kFiner = 0.7;
// Balls in which the lattice is that fine: their distance along the axis and their radius, in vessel radii. Derived:
// between two balls they reach 1.25 radii from the axis, enough for the boundary with the default rounding.
constexpr double kBallStep = 1, kReach = 1.35;  // kBallStep: safe 0.7 to 1.4; kReach: safe 0.94 to 1.9
constexpr double kFinestPlace = 0.1;  // radii: where the lattice is to be fine; memory grows as its inverse cube
// Radii below a thicker vessel's wall from which on no balls are laid. Not 0: without rounding, an axis lies exactly at
// its own vessel's depth, up to the last bits, which differ between machines.
constexpr double kBeneath = 0.1;          // safe 0.07 to 0.14
constexpr int kSweeps = 5;                // from the lattice's triangles to those of the size field; safe 4 to 7
constexpr double kShortestRimEdge = 0.4;  // of the target edge length; safe 0.28 to 0.56
constexpr double kRimStep = 0.3;          // radii that a rim's vertex may move to reach the boundary; safe 0.21 to 0.42
// Resolution up to which a junction is docked at the one asked for, and edges that are to fit between two docks.
// Measured on hepatic trees at 96 around: cones that the junction's own field lacks move its boundary by more than an
// edge, and vertices stay behind. Of six random trees with docks so close, one takes 1.4 times as long without the
// second.
constexpr int kMostDocked = 24;
constexpr double kEdgesBetweenDocks = 3;
constexpr double kOwnReach = 1.5;  // radii along the branch from which a tip's vertices come; safe 1 to 2.1

Index widest_node(const Centerline& centerline) {
  Index widest = 0;
  for (Index n = 1; n < centerline.nodes().size(); ++n) {
    if (centerline.node(n).radius > centerline.node(widest).radius) widest = n;
  }
  return widest;
}

// How far the axis runs below the depth under the walls of thicker vessels at which neither the vessel nor its blend
// reaches them.
double depth_at(const VesselField& field, const Vec3& p, Index cone, double radius) {
  return -field.sample_fast(p, cone).distance - (1 + kBeneath + 2 * field.relations().blend()) * radius;
}

// Balls along the vessels in which the lattice must be finer than its cubes, except where a vessel runs deep within
// thicker ones.
std::vector<LatticeBall> balls_along(const VesselField& field, double cube, double thinnest) {
  std::vector<LatticeBall> balls;
  for (Index cone = 0; cone < field.relations().cone_count(); ++cone) {
    const double length = (field.relations().axis_point(cone, 1) - field.relations().axis_point(cone, 0)).norm();
    for (double t = 0;;) {
      const double radius = field.relations().radius_at(cone, t),
                   finest = std::max(kSpacing * thinnest, kFiner * radius);
      const Vec3 p = field.relations().axis_point(cone, t);
      const double depth = finest < cube ? depth_at(field, p, cone, radius) : 0;
      const bool known = t == 0 && !balls.empty() && balls.back().center == p;  // the end of the previous cone
      if (depth <= 0 && !known) balls.push_back({p, kReach * radius, finest});
      if (t == 1) break;
      t = length > 0 ? std::min(1.0, t + std::max(kBallStep * radius, 0.5 * depth) / length) : 1;
    }
  }
  return balls;
}

// Cubes as large as the widest vessel allows: the thinnest vessel's cubes, doubled repeatedly. Finer at fine places.
GradedLattice lattice_around(const VesselField& field, Index start, const std::vector<FinePlace>& fine_places) {
  const Centerline& centerline = field.relations().centerline();
  double thinnest = std::numeric_limits<double>::infinity(), widest = 0;
  for (const auto& node : centerline.nodes()) {
    thinnest = std::min(thinnest, node.radius);
    widest = std::max(widest, node.radius);
  }
  double spacing = kSpacing * thinnest;
  while (2 * spacing <= kFiner * widest) spacing *= 2;
  std::vector<LatticeBall> balls = balls_along(field, spacing, thinnest);
  for (const FinePlace& place : fine_places) {
    const FieldSample s = field.sample_global(place.center);
    if (s.distance > place.reach) continue;
    const double finest = kFinestPlace * field.relations().radius_at(s.cone, s.t);
    balls.push_back({place.center, place.reach, std::max(place.edge, finest)});
  }
  return {centerline.node(start).position, frame_at(centerline, start), spacing, balls};
}

// The lattice's surface in a mesh that is bound to the field.
void fill(BoundSurface& surface, const LatticeSurface& lattice) {
  for (std::size_t i = 0; i < lattice.vertices.size(); ++i) {
    const Vertex v = surface.mesh.add_vertex(lattice.vertices[i]);
    surface.place(v, lattice.vertices[i], surface.field.sample_fast(lattice.vertices[i], lattice.cones[i]));
  }
  for (const auto& [a, b, c] : lattice.faces) surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
}

LatticeSurface grow_lattice(const VesselField& field, const std::vector<FinePlace>& fine_places) {
  const Centerline& centerline = field.relations().centerline();
  const Index start = widest_node(centerline);
  const Index hint = centerline.degree(start) > 0 ? centerline.incident_segments(start)[0] : 0;
  return grow_in_lattice(field, lattice_around(field, start, fine_places), hint, centerline.cycle_rank());
}

// Fine enough for edges between two docks of one vessel.
int resolution_at_docks(const std::vector<BranchAxis>& axes, const Junction& junction, int around) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const BareStretch& bare : junction.bare_stretches) {
    if (bare.docks[0].tube == kNone || bare.docks[1].tube == kNone) continue;
    const double radius = axes[bare.branch].at(0.5 * (bare.begin + bare.end)).radius;
    shortest = std::min(shortest, (bare.end - bare.begin) / radius);
  }
  int docked = std::min(around, kMostDocked);
  while (docked < around && kEdgesBetweenDocks * edge_length_per_radius(docked) > shortest) ++docked;
  return docked;
}

}  // namespace

JunctionGrowth::JunctionGrowth(const VesselField& field, const std::vector<BranchAxis>& axes,
                               const GrowthSkeleton& skeleton, const Junction& junction, const GenerateOptions& options,
                               const std::vector<FinePlace>& fine_places, const Progress& progress)
    : field_(field),
      axes_(axes),
      skeleton_(skeleton),
      junction_(junction),
      options_(options),
      fine_places_(fine_places),
      progress_(progress),
      docked_around_(resolution_at_docks(axes, junction, options.around)),
      local_(make_junction_centerline(field.relations().centerline(), axes, junction)),
      centerline_(local_.nodes, local_.segments),
      local_field_(centerline_, options.blend),
      lattice_(grow_lattice(local_field_, fine_places)) {}

JunctionSurface JunctionGrowth::make(double finer, bool smooth_rims, bool guarded) const {
  const GenerateResult closed = onto_boundary(finer, guarded);
  JunctionSurface result;
  DiscCutter cutter(closed.mesh.vertices, closed.mesh.faces);
  const std::vector<std::vector<Index>> bound = vertices_by_bare_stretch(closed);
  for (Index g = 0; g < junction_.bare_stretches.size(); ++g) {
    for (const bool at_end : {false, true}) {
      if (junction_.bare_stretches[g].docks[at_end].tube != kNone)
        result.rims.push_back(cut_at_dock(cutter, closed, bound[g], g, at_end, smooth_rims));
    }
  }
  result.patch.faces = cutter.rest().faces;
  for (Index v = 0; v < cutter.vertices().size(); ++v) {
    const auto& [position, source] = cutter.vertices()[v];
    result.patch.vertices.push_back({position, original_cone(closed.binding[source].segment)});
  }
  return result;
}

bool JunctionGrowth::is_crowded() const {
  const Centerline& whole = field_.relations().centerline();
  return std::any_of(junction_.nodes.begin(), junction_.nodes.end(),
                     [&](Index n) { return whole.degree(n) > kUncrowded; });
}

GenerateResult JunctionGrowth::onto_boundary(double finer, bool guarded) const {
  BoundSurface surface(local_field_);
  // A thinned surface converges sooner, but may intersect itself.
  fill(surface, guarded || finer > 1 ? lattice_ : thinned(lattice_));
  if (guarded) surface.guard_crossings();
  surface.crowded = is_crowded();
  surface.fine_places = fine_places_;
  GenerateOptions options = options_;
  options.sweeps = kSweeps;
  options.max_error = {};
  options.around = std::max(3, static_cast<int>(finer * docked_around_));
  const double expected = expected_vertices(centerline_, options.around);
  const double around = std::min<double>(finer * kGrownAround, options.around);
  optimize(surface, options, {around, expected, GrownMesh::Stage::piece, options_.max_error.is_set()}, progress_);
  GenerateResult closed;
  surface.export_to(closed);
  return closed;
}

// The cross-section at which the junction ends, half a step before its tube.
CrossSection JunctionGrowth::way_out(const TubeEnd& dock) const {
  const Tube& tube = skeleton_.tubes[dock.tube];
  const Ring& ring = dock.at_end ? tube.rings.back() : tube.rings.front();
  CrossSection section = section_beside(axes_[tube.branch], ring, dock.at_end);
  if (dock.at_end) section.normal = -section.normal;
  return section;
}

// Returns the rim: moved onto the boundary and without short edges, or as it was cut.
std::vector<Index> JunctionGrowth::cut_at_dock(DiscCutter& cutter, const GenerateResult& closed,
                                               const std::vector<Index>& own, Index bare, bool at_end,
                                               bool smooth) const {
  const auto [place, center, normal, radius] = way_out(junction_.bare_stretches[bare].docks[at_end]);
  const double shortest = smooth ? kShortestRimEdge * edge_length_per_radius(docked_around_) * radius : 0;
  std::vector<Index> rim =
      cutter.cut(center, normal, vertices_near_end(closed, own, bare, at_end, kOwnReach * radius), shortest);
  if (smooth) move_onto_boundary(cutter, rim, closed, kRimStep * radius);
  return rim;
}

void JunctionGrowth::move_onto_boundary(DiscCutter& cutter, const std::vector<Index>& rim, const GenerateResult& closed,
                                        double longest) const {
  for (const Index v : rim) {
    const auto [p, source] = cutter.vertices()[v];
    const Vec3 target = project_to_boundary(local_field_, p, closed.binding[source].segment).position;
    if ((target - p).norm() < longest) cutter.move(v, target);
  }
}

// The cone of the whole field that a cone of the junction's field is part of.
Index JunctionGrowth::original_cone(Index cone) const {
  if (local_.origins.empty()) {
    Index ball = static_cast<Index>(field_.relations().centerline().segments().size());
    while (field_.relations().first_node(ball) != junction_.nodes.front()) ++ball;
    return ball;
  }
  const auto& origin = local_.origins[cone];
  const BranchAxis& axis = axes_[junction_.bare_stretches[origin.bare].branch];
  return axis.branch().segments[axis.at(0.5 * (origin.begin + origin.end)).nth];
}

std::vector<std::vector<Index>> JunctionGrowth::vertices_by_bare_stretch(const GenerateResult& closed) const {
  std::vector<std::vector<Index>> bound(junction_.bare_stretches.size());
  for (Index v = 0; v < closed.binding.size() && !local_.origins.empty(); ++v)
    bound[local_.origins[closed.binding[v].segment].bare].push_back(v);
  return bound;
}

// The vertices bound to a bare stretch (`own`) that are near one of its ends, and nearer to it than to the other.
std::vector<Index> JunctionGrowth::vertices_near_end(const GenerateResult& closed, const std::vector<Index>& own,
                                                     Index bare, bool at_end, double reach) const {
  const double begin = junction_.bare_stretches[bare].begin, end = junction_.bare_stretches[bare].end;
  std::vector<Index> near;
  for (const Index v : own) {
    const auto& [segment, t] = closed.binding[v];
    const auto& origin = local_.origins[segment];
    const double place = origin.begin + t * (origin.end - origin.begin);
    const double away = at_end ? end - place : place - begin;
    if (away < reach && away < 0.5 * (end - begin)) near.push_back(v);
  }
  return near;
}

}  // namespace vmesh
