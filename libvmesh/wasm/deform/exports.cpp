// The functions that the page of `vmesh deform --live` calls: a surface that follows a centerline under forces. Where
// one fails it returns 0 or null, and vmesh_deform_error() tells why. Lengths in mm, times in s; a node's number is the
// centerline's.
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

/// A tree, its simulation and the surface around it.
class vmesh_Deformer {
 public:
  vmesh_Deformer(Centerline tree, const Settings& settings)
      : centerline_(std::move(tree)), simulation_(simulation_of(centerline_, settings)) {}

  void bind(const std::vector<Vec3>& vertices, const std::vector<Vec3>& normals,
            const std::vector<SurfacePlace>& places) {
    binding_.emplace(centerline_, simulation_.tree(), vertices, normals, places);
    lanes_ = binding_->make_surface(SurfaceBinding::Normals::with);
    positions_.resize(3 * vertices.size());
    normals_.resize(positions_.size());
    spread();
  }

  void restart(const Settings& settings) {
    simulation_ = simulation_of(centerline_, settings);
    if (!binding_) return;
    binding_->apply(simulation_.pose(), lanes_);
    spread();
  }

  /// Moves the surface to where the tree is now.
  void follow() {
    if (!binding_) throw InvalidInput("no surface is bound");
    binding_->apply(simulation_.pose(), simulation_.moved(), lanes_);
    simulation_.clear_moved();
    spread();
  }

  CenterlineSimulation& simulation() { return simulation_; }
  const double* origin() const { return lanes_.origin.data(); }
  const float* positions() const { return positions_.data(); }
  const float* normals() const { return normals_.data(); }

  const double* node_positions() {
    node_positions_.clear();
    for (Index n = 0; n < centerline_.nodes().size(); ++n) node_positions_.push_back(simulation_.position(n));
    return node_positions_.front().data();
  }

  StepReport report;

 private:
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

  Centerline centerline_;
  CenterlineSimulation simulation_;
  std::optional<SurfaceBinding> binding_;
  DeformedSurface lanes_;
  std::vector<float> positions_, normals_;
  std::vector<Vec3> node_positions_;
};

namespace {

int done(vmesh_Deformer& deformer, void (CenterlineSimulation::*act)(Index), Index node) {
  return guarded([&] {
    (deformer.simulation().*act)(node);
    return 1;
  });
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* vmesh_deform_error() { return last_error().c_str(); }

/// Three numbers per position, two per segment, and those of Settings.
EMSCRIPTEN_KEEPALIVE vmesh_Deformer* vmesh_deform_create(std::size_t nodes, const double* positions,
                                                         const double* radii, std::size_t segments, const Index* ends,
                                                         const Settings* settings) {
  return guarded([&] {
    std::vector<CenterlineNode> all_nodes;
    for (std::size_t n = 0; n < nodes; ++n) all_nodes.push_back({vector_at(positions, n), radii[n]});
    std::vector<CenterlineSegment> all_segments;
    for (std::size_t s = 0; s < segments; ++s) all_segments.push_back({ends[2 * s], ends[2 * s + 1]});
    return std::make_unique<vmesh_Deformer>(Centerline(std::move(all_nodes), std::move(all_segments)), *settings)
        .release();
  });
}

EMSCRIPTEN_KEEPALIVE void vmesh_deform_destroy(vmesh_Deformer* deformer) { delete deformer; }

/// The surface at rest: three numbers per position and normal, and the place of every vertex.
EMSCRIPTEN_KEEPALIVE int vmesh_deform_bind(vmesh_Deformer* deformer, std::size_t vertices, const double* positions,
                                           const double* normals, const Index* segment, const double* t) {
  return guarded([&] {
    std::vector<SurfacePlace> places;
    for (std::size_t v = 0; v < vertices; ++v) places.push_back({segment[v], t[v]});
    deformer->bind(vectors(positions, vertices), vectors(normals, vertices), places);
    return 1;
  });
}

/// Back to rest, with other numbers; nothing is held.
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

/// Three numbers per node; valid until the next call.
EMSCRIPTEN_KEEPALIVE const double* vmesh_deform_nodes(vmesh_Deformer* deformer) { return deformer->node_positions(); }

/// Moves the surface to where the tree is. Where it is: three numbers per vertex, relative to the origin, that stay
/// where they are.
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
