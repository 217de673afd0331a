// The functions that the page of `vmesh deform --live` calls: a surface that follows a centerline under forces. Where
// one fails it returns 0 or null, and vmesh_deform_error() tells why. Lengths in mm, times in s; a node's number is the
// centerline's.
#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <emscripten.h>

#include "vmesh/core/error.h"
#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"

#include "parted_tree.h"

namespace {

using namespace vmesh;

std::string& last_error() {
  static std::string text;
  return text;
}

/// What `work` returns, or nothing.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    last_error() = "there is not enough memory for this tree";
  } catch (const std::exception& error) {
    last_error() = error.what();
  }
  return {};
}

Vec3 vector_at(const double* numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

std::vector<Vec3> vectors(const double* numbers, std::size_t count) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(vector_at(numbers, i));
  return all;
}

/// Numbers of the material and of the simulation, in this order.
struct Settings {
  double young_Pa, density_kg_m3, poisson_ratio, wall_mm, wall_ratio, damping_s;
  double step_s, iterations, gravity_x_mm_s2, gravity_y_mm_s2, gravity_z_mm_s2, drag_per_s, squeeze_response_s;

  Material material() const { return {young_Pa, density_kg_m3, poisson_ratio, wall_mm, wall_ratio, damping_s}; }

  SimulationOptions options() const {
    SimulationOptions options;
    options.step_s = step_s;
    options.iterations = static_cast<int>(iterations);
    options.gravity_mm_s2 = {gravity_x_mm_s2, gravity_y_mm_s2, gravity_z_mm_s2};
    options.drag_per_s = drag_per_s;
    options.squeeze_response_s = squeeze_response_s;
    return options;
  }
};

CenterlineSimulation simulation_of(const Centerline& centerline, const Settings& settings) {
  return {centerline, segment_properties(centerline, settings.material()), settings.options()};
}

}  // namespace

/// A tree, its simulation and the surface around it. Places are those of the tree before all cuts.
class vmesh_Deformer {
 public:
  vmesh_Deformer(RestTree tree, const Settings& settings)
      : tree_(std::move(tree)), simulation_(simulation_of(tree_.now().centerline, settings)) {
    bind();
  }

  void restart(const Settings& settings) {
    const bool was_whole = tree_.is_whole();
    tree_.restart();
    simulation_ = simulation_of(tree_.now().centerline, settings);
    if (!was_whole) return bind();
    binding_->apply(simulation_.pose(), lanes_);
    spread();
  }

  /// Moves the surface to where the tree is now.
  void follow() {
    binding_->apply(simulation_.pose(), simulation_.moved(), lanes_);
    simulation_.clear_moved();
    spread();
  }

  void cut(const SegmentPlace& at) {
    simulation_.cut(tree_.next_cut(at));
    tree_.go_on();
    bind();
    binding_->apply(simulation_.pose(), lanes_);
    spread();
  }

  Index grasp(const SegmentPlace& at, double slips_N) {
    const SegmentPlace now = tree_.now(at);
    return simulation_.grasp(now.segment, now.t, slips_N);
  }

  /// The nearer node of a place's segment, or the other one.
  Index node_near(const SegmentPlace& at, bool other) const {
    const SegmentPlace now = tree_.now(at);
    const Centerline& centerline = tree_.now().centerline;
    if (now.segment >= centerline.segments().size()) return isolated_node(now.segment - centerline.segments().size());
    const CenterlineSegment& segment = centerline.segment(now.segment);
    return (now.t < 0.5) != other ? segment.a : segment.b;
  }

  CenterlineSimulation& simulation() { return simulation_; }
  const RestTree& tree() const { return tree_.now(); }
  const double* origin() const { return lanes_.origin.data(); }
  const float* positions() const { return positions_.data(); }
  const float* normals() const { return normals_.data(); }
  const Index* place_segments() const { return place_segments_.data(); }
  const double* place_parameters() const { return place_parameters_.data(); }

  const double* node_positions() {
    points_.clear();
    for (Index n = 0; n < tree().centerline.nodes().size(); ++n) points_.push_back(simulation_.position(n));
    return points_.front().data();
  }

  const double* point(const Vec3& p) {
    points_.assign(1, p);
    return points_.front().data();
  }

  StepReport report;

 private:
  void bind() {
    const RestTree& tree = tree_.now();
    std::vector<SurfacePlace> places;
    place_segments_.clear();
    place_parameters_.clear();
    for (const CenterlineBinding& b : tree.binding) {
      places.push_back({b.segment, b.t});
      const SegmentPlace whole = whole_place({b.segment, b.t});
      place_segments_.push_back(whole.segment);
      place_parameters_.push_back(whole.t);
    }
    binding_.emplace(tree.centerline, simulation_.tree(), tree.mesh.vertices, tree.normals, places);
    lanes_ = binding_->make_surface(SurfaceBinding::Normals::with);
    positions_.resize(3 * tree.mesh.vertices.size());
    normals_.resize(positions_.size());
    spread();
  }

  /// A place before all cuts that leads back here: of the end of a part that begins at a cut, a little beyond the cut,
  /// which itself belongs to the other part.
  SegmentPlace whole_place(const SegmentPlace& now) const {
    constexpr double kBeyond = 1e-9;
    SegmentPlace whole = tree_.whole(now);
    if (tree_.now(whole).segment != now.segment) whole.t = std::min(1.0, whole.t + kBeyond);
    return whole;
  }

  /// From lanes to vertices, three numbers each.
  void spread() {
    const std::vector<Index>& lane_of = binding_->lane_of_vertex();
    for (std::size_t v = 0; v < lane_of.size(); ++v) {
      const Index lane = lane_of[v];
      float *p = &positions_[3 * v], *n = &normals_[3 * v];
      p[0] = lanes_.x[lane], p[1] = lanes_.y[lane], p[2] = lanes_.z[lane];
      n[0] = lanes_.normal_x[lane], n[1] = lanes_.normal_y[lane], n[2] = lanes_.normal_z[lane];
    }
  }

  /// By rank.
  Index isolated_node(std::size_t rank) const {
    const Centerline& centerline = tree_.now().centerline;
    for (Index n = 0; n < centerline.nodes().size(); ++n)
      if (centerline.degree(n) == 0 && rank-- == 0) return n;
    return kNone;
  }

  PartedTree tree_;
  CenterlineSimulation simulation_;
  std::optional<SurfaceBinding> binding_;
  DeformedSurface lanes_;
  std::vector<float> positions_, normals_;
  std::vector<Index> place_segments_;
  std::vector<double> place_parameters_;
  std::vector<Vec3> points_;
};

namespace {

int done(vmesh_Deformer& deformer, void (CenterlineSimulation::*act)(Index), Index which) {
  return guarded([&] {
    (deformer.simulation().*act)(which);
    return 1;
  });
}

InstrumentShape chain(std::size_t points, const double* positions, double radius) {
  return {vectors(positions, points), std::vector<double>(points, radius), 0};
}

InstrumentPose at_position(double x, double y, double z) { return {{x, y, z}, Eigen::Quaterniond::Identity()}; }

Centerline centerline_of(std::size_t nodes, const double* positions, const double* radii, std::size_t segments,
                         const Index* ends) {
  std::vector<CenterlineNode> all_nodes;
  for (std::size_t n = 0; n < nodes; ++n) all_nodes.push_back({vector_at(positions, n), radii[n]});
  std::vector<CenterlineSegment> all_segments;
  for (std::size_t s = 0; s < segments; ++s) all_segments.push_back({ends[2 * s], ends[2 * s + 1]});
  return {std::move(all_nodes), std::move(all_segments)};
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* vmesh_deform_error() { return last_error().c_str(); }

/// A tree: three numbers per position, two per segment; the surface at rest: three numbers per position and normal, the
/// place of every vertex, three vertices per face; and the numbers of Settings.
EMSCRIPTEN_KEEPALIVE vmesh_Deformer* vmesh_deform_create(std::size_t nodes, const double* node_positions,
                                                         const double* radii, std::size_t segments, const Index* ends,
                                                         std::size_t vertices, const double* positions,
                                                         const double* normals, const Index* place_segment,
                                                         const double* place_t, std::size_t faces, const Index* corners,
                                                         const Settings* settings) {
  return guarded([&] {
    RestTree tree{centerline_of(nodes, node_positions, radii, segments, ends),
                  {vectors(positions, vertices), {}},
                  vectors(normals, vertices),
                  {}};
    for (std::size_t f = 0; f < faces; ++f)
      tree.mesh.faces.push_back({corners[3 * f], corners[3 * f + 1], corners[3 * f + 2]});
    for (std::size_t v = 0; v < vertices; ++v) tree.binding.push_back({place_segment[v], place_t[v]});
    return std::make_unique<vmesh_Deformer>(std::move(tree), *settings).release();
  });
}

EMSCRIPTEN_KEEPALIVE void vmesh_deform_destroy(vmesh_Deformer* deformer) { delete deformer; }

/// Back to rest and whole, with other numbers; nothing is held or touches.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_restart(vmesh_Deformer* deformer, const Settings* settings) {
  return guarded([&] {
    deformer->restart(*settings);
    return 1;
  });
}

EMSCRIPTEN_KEEPALIVE int vmesh_deform_fix(vmesh_Deformer* deformer, Index node) {
  return done(*deformer, &CenterlineSimulation::fix, node);
}

EMSCRIPTEN_KEEPALIVE int vmesh_deform_clamp(vmesh_Deformer* deformer, Index node) {
  return done(*deformer, &CenterlineSimulation::clamp, node);
}

EMSCRIPTEN_KEEPALIVE int vmesh_deform_release(vmesh_Deformer* deformer, Index node) {
  return done(*deformer, &CenterlineSimulation::release, node);
}

EMSCRIPTEN_KEEPALIVE int vmesh_deform_drag(vmesh_Deformer* deformer, Index node, double x, double y, double z) {
  return guarded([&] {
    deformer->simulation().drag(node, {x, y, z});
    return 1;
  });
}

/// As in a scene's `contact`.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_contact(vmesh_Deformer* deformer, int self, double gap_ratio, double friction,
                                              int iterations, double slip_radii_per_s) {
  return guarded([&] {
    deformer->simulation().set_contact({self != 0, gap_ratio, friction, iterations, slip_radii_per_s});
    return 1;
  });
}

/// On all segments; before any cut.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_tissue(vmesh_Deformer* deformer, double stiffness_N_mm2, double tear_N_mm) {
  return guarded([&] {
    for (Index s = 0; s < deformer->tree().centerline.segments().size(); ++s)
      deformer->simulation().set_tissue(s, {stiffness_N_mm2, tear_N_mm});
    return 1;
  });
}
EMSCRIPTEN_KEEPALIVE std::size_t vmesh_deform_torn(vmesh_Deformer* deformer) { return deformer->simulation().torn(); }

/// An instrument that moves without turning: points of one radius in a frame of its own, and where that is. The gap
/// around it.
EMSCRIPTEN_KEEPALIVE double vmesh_deform_room(vmesh_Deformer* deformer, std::size_t points, const double* positions,
                                              double radius, double x, double y, double z) {
  return guarded([&] {
    return deformer->simulation().room_for_instrument_mm(chain(points, positions, radius), at_position(x, y, z));
  });
}
/// Its number, from 1; 0: it has no room there.
EMSCRIPTEN_KEEPALIVE Index vmesh_deform_enter(vmesh_Deformer* deformer, std::size_t points, const double* positions,
                                              double radius, double x, double y, double z) {
  return guarded([&] {
    return deformer->simulation().add_instrument(chain(points, positions, radius), at_position(x, y, z)) + 1;
  });
}
EMSCRIPTEN_KEEPALIVE int vmesh_deform_guide(vmesh_Deformer* deformer, Index number, double x, double y, double z) {
  return guarded([&] {
    deformer->simulation().move_instrument(number - 1, at_position(x, y, z));
    return 1;
  });
}
EMSCRIPTEN_KEEPALIVE int vmesh_deform_leave(vmesh_Deformer* deformer, Index number) {
  return done(*deformer, &CenterlineSimulation::remove_instrument, number - 1);
}
/// Where it is; valid until the next call.
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_instrument(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->point(deformer->simulation().instrument_pose(number - 1).position_mm); });
}
EMSCRIPTEN_KEEPALIVE double vmesh_deform_instrument_N(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->simulation().instrument_force(number - 1).force_N.norm(); });
}
EMSCRIPTEN_KEEPALIVE double vmesh_deform_instrument_behind_mm(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->simulation().instrument_force(number - 1).behind_mm; });
}

/// Closes jaws on a place; their number, from 1.
EMSCRIPTEN_KEEPALIVE Index vmesh_deform_grasp(vmesh_Deformer* deformer, Index segment, double t, double slips_N) {
  return guarded([&] { return deformer->grasp({segment, t}, slips_N) + 1; });
}
EMSCRIPTEN_KEEPALIVE int vmesh_deform_move_jaw(vmesh_Deformer* deformer, Index number, double x, double y, double z) {
  return guarded([&] {
    deformer->simulation().move_jaw(number - 1, {x, y, z});
    return 1;
  });
}
EMSCRIPTEN_KEEPALIVE int vmesh_deform_open_jaw(vmesh_Deformer* deformer, Index number) {
  return done(*deformer, &CenterlineSimulation::open_jaw, number - 1);
}
/// Where they are; valid until the next call.
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_jaw(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->point(deformer->simulation().jaw_position(number - 1)); });
}
EMSCRIPTEN_KEEPALIVE double vmesh_deform_jaw_N(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->simulation().jaw_force(number - 1).force_N.norm(); });
}
/// Whether they have not lost the vessel.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_jaw_holds(vmesh_Deformer* deformer, Index number) {
  return guarded([&] { return deformer->simulation().jaw_force(number - 1).holds ? 1 : 0; });
}

/// Parts the vessel there. The surface has other vertices and faces after it.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_cut(vmesh_Deformer* deformer, Index segment, double t) {
  return guarded([&] {
    deformer->cut({segment, t});
    return 1;
  });
}

/// The slots that are awake; 0: everything is at rest.
EMSCRIPTEN_KEEPALIVE std::size_t vmesh_deform_step(vmesh_Deformer* deformer) {
  deformer->report = deformer->simulation().step();
  return deformer->report.awake;
}

/// Of the last step.
EMSCRIPTEN_KEEPALIVE double vmesh_deform_work_J(vmesh_Deformer* deformer) { return deformer->report.work_J; }
/// Of the last step, of what drags or fixes a node.
EMSCRIPTEN_KEEPALIVE double vmesh_deform_pull_N(vmesh_Deformer* deformer, Index node) {
  return guarded([&] { return deformer->simulation().drag_force(node).force_N.norm(); });
}
EMSCRIPTEN_KEEPALIVE double vmesh_deform_elastic_J(vmesh_Deformer* deformer) {
  return deformer->simulation().elastic_energy_J();
}

/// The nearer node of a place's segment, or the other one.
EMSCRIPTEN_KEEPALIVE Index vmesh_deform_node_near(vmesh_Deformer* deformer, Index segment, double t, int other) {
  return deformer->node_near({segment, t}, other != 0);
}

/// As many as there are now.
EMSCRIPTEN_KEEPALIVE std::size_t vmesh_deform_node_count(vmesh_Deformer* deformer) {
  return deformer->tree().centerline.nodes().size();
}
EMSCRIPTEN_KEEPALIVE std::size_t vmesh_deform_vertex_count(vmesh_Deformer* deformer) {
  return deformer->tree().mesh.vertices.size();
}
EMSCRIPTEN_KEEPALIVE std::size_t vmesh_deform_face_count(vmesh_Deformer* deformer) {
  return deformer->tree().mesh.faces.size();
}
/// The following stay where they are until the next cut or restart.
EMSCRIPTEN_KEEPALIVE const Index* vmesh_deform_corners(vmesh_Deformer* deformer) {
  return deformer->tree().mesh.faces.front().data();
}
EMSCRIPTEN_KEEPALIVE const Index* vmesh_deform_place_segments(vmesh_Deformer* deformer) {
  return deformer->place_segments();
}
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_place_parameters(vmesh_Deformer* deformer) {
  return deformer->place_parameters();
}

/// Three numbers per node; valid until the next call.
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_nodes(vmesh_Deformer* deformer) { return deformer->node_positions(); }

/// Moves the surface to where the tree is. Where it is: three numbers per vertex, relative to the origin.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_follow(vmesh_Deformer* deformer) {
  return guarded([&] {
    deformer->follow();
    return 1;
  });
}
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_origin(vmesh_Deformer* deformer) { return deformer->origin(); }
EMSCRIPTEN_KEEPALIVE const float* vmesh_deform_positions(vmesh_Deformer* deformer) { return deformer->positions(); }
EMSCRIPTEN_KEEPALIVE const float* vmesh_deform_normals(vmesh_Deformer* deformer) { return deformer->normals(); }

}  // extern "C"
