#include "surface/junction_growth.h"

#include <array>
#include <map>

#include "surface/docking.h"
#include "surface/lattice_growth.h"
#include "surface/node_frame.h"
#include "surface/optimize.h"
#include "surface/sweep_state.h"

namespace vmesh {
namespace {

constexpr double kSpacing = 1;            // of the lattice, in the smallest radii ...
constexpr double kFinestSpacing = 0.08;   // ... but at least in the largest
constexpr std::array kFiner = {2, 3, 4};  // halves of the resolution, tried until the surface does not intersect itself
constexpr int kSweeps = 5;                // from the lattice's triangles to those of the size field
constexpr double kShortestPiece = 0.3;    // radii between nodes of a junction's centerline: finer ones do not matter
constexpr double kShortestRimEdge = 0.4;  // intended edges of the surface
constexpr double kRimStep = 0.3;          // radii that a rim's vertex may move onto the boundary
constexpr double kOwnReach = 1.5;         // radii along the branch from which a tip's vertices come

// The part of a centerline that belongs to a junction, cut at its openings. Segments know the place they come from.
struct JunctionCenterline {
  struct Origin {
    Index gap;
    double begin, end;  // places
  };

  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Origin> origins;  // of the segments
};

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

// The finer the safer: narrow places do not bear triangles of every size.
GenerateResult onto_boundary(const VesselField& field, const LatticeSurface& lattice, GenerateOptions options) {
  GenerateResult piece;
  options.sweeps = kSweeps;
  const int around = options.around;
  for (const int finer : kFiner) {
    BoundSurface surface(field);
    fill(surface, lattice);
    options.around = finer * around / 2;
    const double grown_around = std::min<double>(finer * kGrownAround / 2, options.around);
    const bool tangled = optimize(surface, options, grown_around, {}).tangled;
    piece = {};
    surface.export_to(piece);
    if (!tangled) break;
  }
  return piece;
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
  const BranchAxis& axis = axes[junction.gaps[origin.gap].branch];
  return axis.branch().segments[axis.at(0.5 * (origin.begin + origin.end)).piece];
}

// The vertices bound to gap number `g`, near one of its ends and nearer than to the other.
std::vector<Index> vertices_near_end(const GenerateResult& piece, const JunctionCenterline& local, const Gap& gap,
                                     Index g, bool at_end, double reach) {
  std::vector<Index> near;
  for (Index v = 0; v < piece.binding.size(); ++v) {
    const auto& [segment, t] = piece.binding[v];
    const auto& origin = local.origins[segment];
    const double place = origin.begin + t * (origin.end - origin.begin);
    const double away = at_end ? gap.end - place : place - gap.begin;
    if (origin.gap == g && away < reach && away < 0.5 * (gap.end - gap.begin)) near.push_back(v);
  }
  return near;
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
                      frame_at(centerline, start), centerline.cycle_rank());
  const GenerateResult piece = onto_boundary(local_field, lattice, options);

  JunctionSurface result;
  result.handles = lattice.handles;
  DiscCutter cutter(piece.mesh.vertices, piece.mesh.faces);
  for (Index g = 0; g < junction.gaps.size(); ++g) {
    const Gap& gap = junction.gaps[g];
    for (const bool at_end : {false, true}) {
      const Opening& opening = gap.openings[at_end];
      if (opening.tube == kNone) continue;
      const Tube& tube = skeleton.tubes[opening.tube];
      const Ring& ring = opening.at_end ? tube.rings.back() : tube.rings.front();
      result.openings.push_back(opening);
      const CrossSection& section = ring.beside[opening.at_end];
      result.rims.push_back(cutter.cut(section.center, opening.at_end ? Vec3(-section.normal) : section.normal,
                                       vertices_near_end(piece, local, gap, g, at_end, kOwnReach * ring.radius),
                                       kShortestRimEdge * ring.radius * edge_length_per_radius(options.around)));
      for (const Index v : result.rims.back()) {
        const auto at = project_to_boundary(local_field, cutter.vertices()[v], piece.binding[cutter.source(v)].segment);
        if ((at.position - cutter.vertices()[v]).norm() < kRimStep * ring.radius) cutter.move(v, at.position);
      }
    }
  }
  result.patch.faces = cutter.rest();
  for (Index v = 0; v < cutter.vertices().size(); ++v) {
    const Index cone = piece.binding[cutter.source(v)].segment;
    result.patch.vertices.push_back({cutter.vertices()[v], original_cone(field, axes, junction, local, cone)});
  }
  return result;
}

}  // namespace vmesh
