#include "surface/junction_growth.h"

#include <map>
#include <numbers>

#include "surface/node_frame.h"
#include "surface/optimize.h"
#include "surface/sweep_state.h"

namespace vmesh {
namespace {

constexpr double kSpacing = 1;            // of the lattice, in the smallest radii ...
constexpr double kMostPoints = 300'000;   // in the lattice, about
constexpr int kSweeps = 5;                // from the lattice's triangles to those of the size field
constexpr double kShortestPiece = 0.3;    // radii between nodes of a junction's centerline: finer ones do not matter
constexpr double kShortestRimEdge = 0.4;  // intended edges of the surface
constexpr double kRimStep = 0.3;          // radii that a rim's vertex may move onto the boundary
constexpr double kOwnReach = 1.5;         // radii along the branch from which a tip's vertices come

class JunctionCenterlineMaker {
 public:
  JunctionCenterlineMaker(const Centerline& centerline, const std::vector<BranchAxis>& axes)
      : centerline_(centerline), axes_(axes) {}

  JunctionCenterline make(const Junction& junction) {
    for (const Index n : junction.nodes) node_of(n);
    for (Index g = 0; g < junction.gaps.size(); ++g) add(junction.gaps[g], g);
    return std::move(result_);
  }

 private:
  Index add_node(const Vec3& position, double radius) {
    result_.nodes.push_back({position, radius});
    return static_cast<Index>(result_.nodes.size() - 1);
  }

  Index node_of(Index n) {
    const auto [it, is_new] = nodes_.emplace(n, kNone);
    if (is_new) it->second = add_node(centerline_.node(n).position, centerline_.node(n).radius);
    return it->second;
  }

  Index end_node(const Gap& gap, int end) {
    const BranchAxis& axis = axes_[gap.branch];
    if (gap.openings[end].tube == kNone) return node_of(end ? axis.branch().nodes.back() : axis.branch().nodes.front());
    const auto point = axis.at(end ? gap.end : gap.begin);
    return add_node(point.position, point.radius);
  }

  void add(const Gap& gap, Index number) {
    const BranchAxis& axis = axes_[gap.branch];
    std::vector<double> places = {gap.begin};
    const auto pass = [&](double place) {
      const double shortest = kShortestPiece * axis.at(place).radius;
      if (place > gap.begin + shortest && place < gap.end - shortest && place > places.back() + shortest)
        places.push_back(place);
    };
    for (double lap = 0; lap <= (axis.periodic() ? axis.length() : 0); lap += axis.length()) {
      for (std::size_t i = 0; i < axis.branch().nodes.size(); ++i) pass(lap + axis.node_place(i));
    }
    places.push_back(gap.end);
    Index last = end_node(gap, 0);
    const Index end = end_node(gap, 1);
    for (std::size_t i = 1; i < places.size(); ++i) {
      const auto point = axis.at(places[i]);
      const Index next = i + 1 == places.size() ? end : add_node(point.position, point.radius);
      result_.segments.push_back({last, next});
      result_.origins.push_back({number, places[i - 1], places[i]});
      last = next;
    }
  }

  const Centerline& centerline_;
  const std::vector<BranchAxis>& axes_;
  JunctionCenterline result_;
  std::map<Index, Index> nodes_;
};

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
    volume += 4.0 / 3 * std::numbers::pi * std::pow(node.radius, 3);
  }
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    volume += std::numbers::pi * std::pow(centerline.radius_at(s, 0.5), 2) * centerline.length(s);
  }
  return std::max(kSpacing * thinnest, std::cbrt(2 * volume / kMostPoints));  // two points to a cube
}

// The lattice's surface in a mesh that is bound to the field.
void fill(BoundSurface& surface, const LatticeSurface& lattice) {
  for (std::size_t i = 0; i < lattice.vertices.size(); ++i) {
    const Vertex v = surface.mesh.add_vertex(lattice.vertices[i]);
    surface.place(v, lattice.vertices[i], surface.field.sample(lattice.vertices[i], lattice.cones[i]));
  }
  for (const auto& [a, b, c] : lattice.faces) surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
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
                               const GrowthSkeleton& skeleton, const Junction& junction, const GenerateOptions& options)
    : field_(field),
      axes_(axes),
      skeleton_(skeleton),
      junction_(junction),
      options_(options),
      local_(JunctionCenterlineMaker(field.centerline(), axes).make(junction)),
      centerline_(local_.nodes, local_.segments),
      local_field_(centerline_, options.blend),
      lattice_(grow_lattice(local_field_)) {}

JunctionSurface JunctionGrowth::make(double finer, bool smooth_rims) const {
  const GenerateResult piece = onto_boundary(finer);
  const double edge = edge_length_per_radius(options_.around);
  JunctionSurface result;
  DiscCutter cutter(piece.mesh.vertices, piece.mesh.faces);
  for (Index g = 0; g < junction_.gaps.size(); ++g) {
    for (const bool at_end : {false, true}) {
      const TubeEnd& opening = junction_.gaps[g].openings[at_end];
      if (opening.tube == kNone) continue;
      const Tube& tube = skeleton_.tubes[opening.tube];
      const CrossSection& section = (opening.at_end ? tube.rings.back() : tube.rings.front()).beside[opening.at_end];
      result.rims.push_back(cutter.cut(section.center, opening.at_end ? Vec3(-section.normal) : section.normal,
                                       vertices_near_end(piece, g, at_end, kOwnReach * section.radius),
                                       smooth_rims ? kShortestRimEdge * edge * section.radius : 0));
      if (smooth_rims) move_onto_boundary(cutter, result.rims.back(), piece, kRimStep * section.radius);
    }
  }
  result.patch.faces = cutter.rest();
  for (Index v = 0; v < cutter.vertices().size(); ++v) {
    result.patch.vertices.push_back({cutter.vertices()[v], original_cone(piece.binding[cutter.source(v)].segment)});
  }
  return result;
}

GenerateResult JunctionGrowth::onto_boundary(double finer) const {
  BoundSurface surface(local_field_);
  fill(surface, lattice_);
  GenerateOptions options = options_;
  options.sweeps = kSweeps;
  options.max_error = {};
  options.around = std::max(3, static_cast<int>(finer * options_.around));
  optimize(surface, options,
           {std::min<double>(finer * kGrownAround, options.around), expected_vertices(centerline_, options.around),
            GrownMesh::Stage::piece},
           {});
  GenerateResult piece;
  surface.export_to(piece);
  return piece;
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
