#include "surface/paper/paper_growth.h"

#include <algorithm>

#include "vmesh/core/ascending.h"
#include "vmesh/volume/crossing.h"

#include "surface/junction/node_frame.h"
#include "surface/paper/geodesic_sphere.h"
#include "surface/paper/growth_paths.h"

namespace vmesh {
namespace {

constexpr double kSeedFraction = 0.5;       // seed radius in vessel radii: "somewhat smaller than the vessel"
constexpr double kSettledTolerance = 0.01;  // distance in vessel radii at which a vertex has reached the boundary
constexpr double kMaxStep = 0.5;            // step in vessel radii
constexpr int kShorterSteps = 3;            // at a step that other faces are in the way of, each half as long
constexpr int kMaxSteps = 100;              // of one vertex, before it is projected
constexpr double kMaxFlight = 2;            // vessel radii a vertex may travel before only the boundary attracts it
constexpr double kBehind = 0.1;             // vessel radii a crossing may lie behind its segment's front
constexpr double kMaxSplits = 20;       // crossings of a segment per vessel radius, about twenty times the usual number
constexpr double kSmallestFace = 0.02;  // longest edge, in radii of the crossing segment, that is still split

class Growth {
 public:
  Growth(BoundSurface& surface, double beta, bool guarded, const Progress& progress)
      : surface_(surface),
        mesh_(surface.mesh),
        field_(surface.field),
        beta_(beta),
        guarded_(guarded),
        progress_(progress),
        paths_(surface.field.relations().centerline()),
        travelled_(mesh_.add_property_map<Vertex, double>("v:travelled", 0.0).first),
        steps_(mesh_.add_property_map<Vertex, int>("v:steps", 0).first) {}

  PaperGrowthReport run() {
    plant_seeds();
    if (guarded_) surface_.guard_crossings(BoundSurface::Axes::none);  // fronts are crossed by axes
    while (!moving_.empty()) {
      report_progress(progress_, "grow", fraction_reached());
      move_vertices();
      split_crossed_faces();
    }
    mesh_.remove_property_map(travelled_);
    mesh_.remove_property_map(steps_);
    return report_;
  }

 private:
  static constexpr int kSettled = -1;  // in steps_

  // One seed per component, at the widest branching node, or the widest node where nothing branches.
  void plant_seeds() {
    const Centerline& centerline = field_.relations().centerline();
    std::vector<Index> widest(centerline.component_count(), kNone);
    const auto rank = [&](Index n) { return std::pair(centerline.degree(n) >= 3, centerline.node(n).radius); };
    for (Index n = 0; n < centerline.nodes().size(); ++n) {
      Index& best = widest[centerline.component_of_node()[n]];
      if (best == kNone || rank(n) > rank(best)) best = n;
    }
    std::vector<Index> ball_of_node(centerline.nodes().size(), kNone);
    for (auto c = static_cast<Index>(centerline.segments().size()); c < field_.relations().cone_count(); ++c) {
      ball_of_node[field_.relations().first_node(c)] = c;
    }
    for (const Index n : widest) {
      paths_.start_at(n);
      const Index cone = centerline.degree(n) > 0 ? centerline.incident_segments(n)[0] : ball_of_node[n];
      const auto& node = centerline.node(n);
      for (const Vertex v :
           add_geodesic_sphere(surface_, node.position, kSeedFraction * node.radius, frame_at(centerline, n), cone)) {
        moving_.push_back(v);
      }
    }
    for (Index s = 0; s < centerline.segments().size(); ++s) report_.unclosed += paths_.direction(s) == 0;
  }

  // Every moving vertex takes one step; those that reached the boundary are settled.
  void move_vertices() {
    std::vector<Vertex> still_moving;
    settled_.clear();
    for (const Vertex v : moving_) {
      const FieldSample here = field_.sample(surface_.position(v), surface_[v].cone);
      const double radius = field_.relations().radius_at(here.cone, here.t);
      const bool forced = ++steps_[v] > kMaxSteps;
      if (forced || here.distance >= -kSettledTolerance * radius) {  // outside: the midpoint of an edge over a crotch
        settle(v, here);
        report_.forced += forced;
        continue;
      }
      const double step = std::min(-here.distance, kMaxStep * radius);
      travelled_[v] += step / radius;
      advance(v, here, step * force(v, here, travelled_[v] > kMaxFlight ? 1 : beta_));
      still_moving.push_back(v);
    }
    moving_.swap(still_moving);
  }

  // Onto the boundary; where other faces are in the way, the vertex stays where it is.
  void settle(Vertex v, const FieldSample& here) {
    const BoundaryPoint target = project_to_boundary(field_, {surface_.position(v), here}, 1e-6, 0);
    if (surface_.may_place(v, target.position)) surface_.place(v, target.position, target.sample);
    steps_[v] = kSettled;
    settled_.push_back(v);
  }

  // As much of the way as other faces leave.
  void advance(Vertex v, const FieldSample& here, Vec3 way) {
    for (int attempt = 0; attempt < kShorterSteps; ++attempt, way *= 0.5) {
      const Vec3 p = surface_.position(v) + way;
      if (!surface_.may_place(v, p)) continue;
      surface_.place(v, p, field_.sample(p, here.cone));
      return;
    }
  }

  // Direction of Eq. 11: F = (1 - beta) n + beta a, n the vertex normal, a towards the closest boundary point.
  Vec3 force(Vertex v, const FieldSample& here, double beta) const {
    const Vec3 f = (1 - beta) * surface_.vertex_normal(v) + beta * here.gradient;
    const double norm = f.norm();
    return norm > 0 ? Vec3(f / norm) : here.gradient;
  }

  // Faces at a vertex that has just settled are split if all three corners are settled and the centerline crosses them.
  void split_crossed_faces() {
    for (const Vertex v : settled_) {
      faces_.assign(mesh_.faces_around_target(mesh_.halfedge(v)).begin(),
                    mesh_.faces_around_target(mesh_.halfedge(v)).end());
      for (const Face f : faces_) {
        if (all_settled(f) && surface_.may_split_edge_centric(f) && crossed(f)) split(f);
      }
    }
  }

  bool all_settled(Face f) const {
    for (const Vertex v : mesh_.vertices_around_face(mesh_.halfedge(f))) {
      if (steps_[v] != kSettled) return false;
    }
    return true;
  }

  // Whether a segment leaves the surface through `f` ahead of what has grown along it already. Only crossings in the
  // direction of growth count; the others belong to a front that met covered vessel.
  bool crossed(Face f) {
    const Halfedge h = mesh_.halfedge(f);
    TriangleCorners triangle;
    candidates_.clear();
    int i = 0;
    for (const Vertex v : mesh_.vertices_around_face(h)) {
      triangle[i++] = surface_.position(v);
      const auto local = field_.relations().local_cones(surface_[v].cone);
      candidates_.insert(candidates_.end(), local.begin(), local.end());
    }
    sort_unique(candidates_);
    const double size2 = std::max({(triangle[0] - triangle[1]).squaredNorm(), (triangle[1] - triangle[2]).squaredNorm(),
                                   (triangle[2] - triangle[0]).squaredNorm()});
    bool ahead = false, behind = false;
    for (const Index s : candidates_) {
      if (s >= field_.relations().centerline().segments().size() || paths_.direction(s) == 0) continue;
      const auto crossing =
          find_crossing(field_.relations().axis_point(s, 0), field_.relations().axis_point(s, 1), triangle);
      if (!crossing || crossing->direction != paths_.direction(s)) continue;
      const double radius = field_.relations().radius_at(s, crossing->t);
      const double depth = paths_.depth(s, crossing->t);
      const double smallest = kSmallestFace * radius;
      const double allowed = kMaxSplits * (1 + field_.relations().centerline().length(s) / radius);
      if (depth < paths_.reached(s) - kBehind * radius || size2 < smallest * smallest ||
          paths_.crossings(s) > allowed) {
        behind = true;
        continue;
      }
      paths_.advance(s, depth);
      ahead = true;
    }
    report_.refused += behind && !ahead;
    return ahead;
  }

  void split(Face f) {
    ++report_.splits;
    for (const Vertex v : surface_.split_edge_centric(f)) {
      steps_[v] = 0;
      travelled_[v] = 0;
      moving_.push_back(v);
    }
  }

  double fraction_reached() const {
    const auto all = static_cast<double>(mesh_.num_vertices());
    return all > 0 ? 1 - static_cast<double>(moving_.size()) / all : 0;
  }

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const VesselField& field_;
  double beta_;
  bool guarded_;
  const Progress& progress_;
  GrowthPaths paths_;
  SurfaceMesh::Property_map<Vertex, double> travelled_;  // in vessel radii
  SurfaceMesh::Property_map<Vertex, int> steps_;
  std::vector<Vertex> moving_, settled_;
  std::vector<Face> faces_;
  std::vector<Index> candidates_;
  PaperGrowthReport report_;
};

}  // namespace

PaperGrowthReport grow_from_single_seeds(BoundSurface& surface, double beta, bool guarded, const Progress& progress) {
  return Growth(surface, beta, guarded, progress).run();
}

}  // namespace vmesh
