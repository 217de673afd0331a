#include "surface/junction_growth.h"

#include <map>

#include "surface/docking.h"
#include "surface/lattice_growth.h"
#include "surface/relocation.h"
#include "surface/remesher.h"

namespace vmesh {
namespace {

constexpr double kSpacing = 0.6;         // of the lattice, in the smallest radii ...
constexpr double kFinestSpacing = 0.08;  // ... but at least in the largest
constexpr int kSweeps = 8;               // from the lattice's triangles to those of the size field
constexpr double kOwnReach = 1.5;        // radii along the branch from which a tip's vertices come

// The part of a centerline that belongs to a junction, cut at its openings. Segments know the place they come from.
struct JunctionCenterline {
  struct Origin {
    Index branch;
    double begin, end;
  };
  struct Tip {
    Opening opening;
    Index node;
  };

  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Origin> origins;  // of the segments
  std::vector<Tip> tips;
};

class JunctionCenterlineMaker {
 public:
  JunctionCenterlineMaker(const Centerline& centerline, const std::vector<BranchAxis>& axes)
      : centerline_(centerline), axes_(axes) {}

  JunctionCenterline make(const Junction& junction) {
    for (const Index n : junction.nodes) node_of(n);
    for (const Gap& gap : junction.gaps) add(gap);
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
    const Index node = add_node(point.position, point.radius);
    result_.tips.push_back({gap.openings[end], node});
    return node;
  }

  void add(const Gap& gap) {
    const BranchAxis& axis = axes_[gap.branch];
    std::vector<double> places = {gap.begin};
    const auto pass = [&](double place) {
      const double shortest = 1e-6 * axis.at(place).radius;
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
      result_.origins.push_back({gap.branch, places[i - 1], places[i]});
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

double lattice_spacing(const Centerline& centerline) {
  double thinnest = std::numeric_limits<double>::infinity(), widest = 0;
  for (const auto& node : centerline.nodes()) {
    thinnest = std::min(thinnest, node.radius);
    widest = std::max(widest, node.radius);
  }
  return std::max(kSpacing * thinnest, kFinestSpacing * widest);
}

// The lattice's surface in a mesh that is bound to the field.
void fill(BoundSurface& surface, const LatticeSurface& lattice) {
  for (std::size_t i = 0; i < lattice.vertices.size(); ++i) {
    const Vertex v = surface.mesh.add_vertex(lattice.vertices[i]);
    surface.place(v, lattice.vertices[i], surface.field.sample(lattice.vertices[i], lattice.cones[i]));
  }
  for (const auto& [a, b, c] : lattice.faces) surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
}

// Onto the boundary, and from the lattice's many triangles to those of the size field.
void coarsen(BoundSurface& surface, int around) {
  SweepState state(surface);
  Remesher remesher(state);
  remesher.limit_vertices(2 * surface.mesh.number_of_vertices() + 100);
  state.stir_all();
  for (int sweep = 0; sweep < kSweeps && state.next_sweep() > 0; ++sweep) {
    state.update_sizes(edge_length_per_radius(around));
    remesher.repair_strays();
    remesher.split_long_edges();
    remesher.collapse_short_edges();
    remesher.flip_edges(1);
    relocate_vertices(state);
  }
}

// The cone of the whole field that a cone of the junction's field is part of.
Index original_cone(const VesselField& field, const std::vector<BranchAxis>& axes, const Junction& junction,
                    const JunctionCenterline& local, Index cone) {
  if (local.origins.empty()) {
    Index ball = static_cast<Index>(field.centerline().segments().size());
    while (field.first_node(ball) != junction.nodes.front()) ++ball;
    return ball;
  }
  const auto& origin = local.origins[cone];
  const BranchAxis& axis = axes[origin.branch];
  return axis.branch().segments[axis.at(0.5 * (origin.begin + origin.end)).piece];
}

}  // namespace

JunctionSurface grow_junction(const VesselField& field, const std::vector<BranchAxis>& axes,
                              const GrowthSkeleton& skeleton, const Junction& junction,
                              const GenerateOptions& options) {
  const JunctionCenterline local = JunctionCenterlineMaker(field.centerline(), axes).make(junction);
  const Centerline centerline(local.nodes, local.segments);
  const VesselField local_field(centerline, options.blend);
  const Index start = widest_node(centerline);
  const Index hint = centerline.degree(start) > 0 ? centerline.incident_segments(start)[0] : 0;
  const LatticeSurface lattice =
      grow_in_lattice(local_field, centerline.node(start).position, hint, lattice_spacing(centerline),
                      Eigen::AngleAxisd(0.4, Vec3(2, 3, 6) / 7).toRotationMatrix(), centerline.cycle_rank());
  BoundSurface surface(local_field);
  fill(surface, lattice);
  coarsen(surface, options.around);

  GenerateResult piece;
  surface.export_to(piece);
  JunctionSurface result;
  result.handles = lattice.handles;
  DiscCutter cutter(piece.mesh.vertices, piece.mesh.faces);
  for (const auto& tip : local.tips) {
    const Tube& tube = skeleton.tubes[tip.opening.tube];
    const Ring& ring = tip.opening.at_end ? tube.rings.back() : tube.rings.front();
    std::vector<Index> own;  // vertices on the branch, near the opening
    for (Index v = 0; v < piece.binding.size(); ++v) {
      const auto& origin = local.origins[piece.binding[v].segment];
      const double place = tip.opening.at_end ? origin.begin : origin.end;
      if (origin.branch == tube.branch && axes[tube.branch].apart(place, ring.place) < kOwnReach * ring.radius)
        own.push_back(v);
    }
    result.openings.push_back(tip.opening);
    result.rims.push_back(
        cutter.cut(ring.center, tip.opening.at_end ? Vec3(-ring.normal) : ring.normal, ring.radius, own));
  }
  result.patch.faces = cutter.rest();
  for (std::size_t v = 0; v < piece.binding.size(); ++v) {
    result.patch.vertices.push_back(
        {piece.mesh.vertices[v], original_cone(field, axes, junction, local, piece.binding[v].segment)});
  }
  return result;
}

}  // namespace vmesh
