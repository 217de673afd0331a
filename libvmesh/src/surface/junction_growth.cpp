#include "surface/junction_growth.h"

#include <map>
#include <numbers>
#include <queue>

#include "vmesh/volume/crossing.h"

#include "surface/docking.h"
#include "surface/geodesic_sphere.h"
#include "surface/relocation.h"
#include "surface/remesher.h"

namespace vmesh {
namespace {

constexpr double kSeedFraction = 0.5;
constexpr double kStep = 0.7;        // radii by which a tip advances at a time
constexpr int kMaxPasses = 12;       // of moving and remeshing per step
constexpr double kReached = 0.01;    // radii from the boundary at which a vertex has reached it
constexpr double kMaxMove = 0.5;     // radii a vertex moves at a time
constexpr double kEmerged = 0.1;     // radii a tip must stand out for faces before it to be refined
constexpr double kFineEnough = 1.4;  // target lengths of the longest edge of a face that a tip crosses

// The part of a centerline that belongs to a junction, cut at its openings, in steps short enough for a tip to advance
// at a time. Segments know the place they come from.
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
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const double r = std::min(axis.at(places[i]).radius, axis.at(places[i + 1]).radius);
      const double length = places[i + 1] - places[i];
      const auto steps = static_cast<int>(std::max(1.0, std::ceil(length / (kStep * r))));
      for (int k = 1; k <= steps; ++k) {
        const double from = places[i] + length * (k - 1) / steps, to = places[i] + length * k / steps;
        const bool is_end = k == steps && i + 2 == places.size();
        const auto point = axis.at(to);
        const Index next = is_end ? end : add_node(point.position, point.radius);
        result_.segments.push_back({last, next});
        result_.origins.push_back({gap.branch, from, to});
        last = next;
      }
    }
  }

  const Centerline& centerline_;
  const std::vector<BranchAxis>& axes_;
  JunctionCenterline result_;
  std::map<Index, Index> nodes_;
};

class JunctionGrowth {
 public:
  JunctionGrowth(VesselField& field, const GenerateOptions& options)
      : field_(field),
        centerline_(field.centerline()),
        surface_(field),
        state_(surface_),
        remesher_(state_),
        beta_(options.beta),
        edge_per_radius_(edge_length_per_radius(options.around)),
        emerged_(field.cone_count(), 0) {}

  BoundSurface& run() {
    field_.deactivate_all();
    const Index start = widest_node();
    plant(start);
    std::vector<char> reached(centerline_.nodes().size(), 0);
    std::vector<Index> fronts = {start};
    reached[start] = 1;
    while (!fronts.empty()) {
      std::vector<Index> next;
      tips_.clear();
      for (const Index n : fronts) {
        for (const Index s : centerline_.incident_segments(n)) {
          const Index m = centerline_.other_node(s, n);
          if (!field_.active(s)) {
            field_.activate(s);
            tips_.push_back({s, n, m});
          }
          if (reached[m]) continue;
          reached[m] = 1;
          next.push_back(m);
        }
      }
      follow_volume();
      fronts = std::move(next);
    }
    return surface_;
  }

 private:
  struct Tip {
    Index cone, from, to;
  };

  Index widest_node() const {
    Index widest = 0;
    for (Index n = 1; n < centerline_.nodes().size(); ++n) {
      if (centerline_.node(n).radius > centerline_.node(widest).radius) widest = n;
    }
    return widest;
  }

  void plant(Index n) {
    Index cone = 0;  // of an isolated node
    for (const Index s : centerline_.incident_segments(n)) {
      field_.activate(s);
      tips_.push_back({s, n, centerline_.other_node(s, n)});
      cone = s;
    }
    if (centerline_.degree(n) == 0) field_.activate(0);
    const auto& node = centerline_.node(n);
    const Eigen::Matrix3d turned(Eigen::AngleAxisd(0.4, Vec3(2, 3, 6) / 7).toRotationMatrix());
    add_geodesic_sphere(surface_, node.position, kSeedFraction * node.radius, turned, cone);
    follow_volume();
  }

  // Until all vertices lie on the boundary of the active volume and every tip that stands out has vertices.
  void follow_volume() {
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      const bool moved = move_vertices();
      const bool refined = find_crossed_faces();
      if (!moved && !refined) return;
      state_.next_sweep();
      state_.update_sizes(edge_per_radius_, wanted_);
      remesher_.repair_strays();
      remesher_.split_long_edges();
      remesher_.collapse_short_edges();
      remesher_.flip_edges(1);
      relocate_vertices(state_);
    }
  }

  bool move_vertices() {
    bool moved = false;
    for (const Vertex v : surface_.mesh.vertices()) {
      const FieldSample here = field_.sample(surface_.position(v), surface_.cone[v]);
      surface_.place(v, surface_.position(v), here);
      emerged_[here.cone] = 1;
      const double radius = field_.radius_at(here.cone, here.t);
      if (here.distance > -kReached * radius) continue;
      const double step = std::min(-here.distance, kMaxMove * radius);
      const Vec3 f = (1 - beta_) * surface_.vertex_normal(v) + beta_ * here.gradient;
      const Vec3 p = surface_.position(v) + step * (f.norm() > 0 ? Vec3(f.normalized()) : here.gradient);
      surface_.place(v, p, field_.sample(p, here.cone));
      state_.stir(v);
      moved = true;
    }
    return moved;
  }

  // Faces before a tip that stands out, unseen because no vertex is near, get a size that lets the surface enter.
  bool find_crossed_faces() {
    wanted_.clear();
    for (const Tip& tip : tips_) {
      if (emerged_[tip.cone]) continue;
      const Vec3 from = centerline_.node(tip.from).position, to = centerline_.node(tip.to).position;
      const double radius = centerline_.node(tip.to).radius;
      const Vec3 apex = to + radius * (to - from).normalized();
      for (const Face f : surface_.mesh.faces()) refine_if_crossed(f, from, apex, radius);
    }
    return !wanted_.empty();
  }

  void refine_if_crossed(Face f, const Vec3& from, const Vec3& apex, double radius) {
    const auto corners = state_.corners(f);
    const TriangleCorners triangle = {state_.point(corners[0]), state_.point(corners[1]), state_.point(corners[2])};
    const auto crossing = find_crossing(from, apex, triangle);
    if (!crossing || crossing->direction < 0) return;
    const Vec3 p = from + crossing->t * (apex - from);
    if ((apex - p).norm() < kEmerged * radius) return;
    const double size = edge_per_radius_ * radius;
    const double longest = std::max(
        {(triangle[0] - triangle[1]).norm(), (triangle[1] - triangle[2]).norm(), (triangle[2] - triangle[0]).norm()});
    if (longest < kFineEnough * size) return;
    for (const Vertex v : corners) {
      wanted_.emplace_back(v, size);
      state_.stir(v);
    }
  }

  VesselField& field_;
  const Centerline& centerline_;
  BoundSurface surface_;
  SweepState state_;
  Remesher remesher_;
  double beta_, edge_per_radius_;
  std::vector<char> emerged_;  // cones that vertices are bound to
  std::vector<Tip> tips_;
  std::vector<std::pair<Vertex, double>> wanted_;
};

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
  VesselField local_field(centerline, options.blend);
  JunctionGrowth growth(local_field, options);
  const BoundSurface& grown = growth.run();

  GenerateResult piece;
  grown.export_to(piece);
  JunctionSurface result;
  DiscCutter cutter(piece.mesh.vertices, piece.mesh.faces);
  for (const auto& tip : local.tips) {
    const Tube& tube = skeleton.tubes[tip.opening.tube];
    const Ring& ring = tip.opening.at_end ? tube.rings.back() : tube.rings.front();
    const Index cone = centerline.incident_segments(tip.node)[0];
    std::vector<Index> candidates;
    for (Index v = 0; v < piece.binding.size(); ++v) {
      if (piece.binding[v].segment == cone) candidates.push_back(v);
    }
    result.openings.push_back(tip.opening);
    result.rims.push_back(
        cutter.cut(ring.center, tip.opening.at_end ? Vec3(-ring.normal) : ring.normal, ring.radius, candidates));
  }
  result.patch.faces = cutter.rest();
  for (std::size_t v = 0; v < piece.binding.size(); ++v) {
    result.patch.vertices.push_back(
        {piece.mesh.vertices[v], original_cone(field, axes, junction, local, piece.binding[v].segment)});
  }
  return result;
}

}  // namespace vmesh
