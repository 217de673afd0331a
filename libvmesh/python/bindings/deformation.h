#pragma once

#include <array>
#include <memory>
#include <vector>

#include "vmesh/centerline/cut.h"
#include "vmesh/deform/simulation.h"
#include "vmesh/deform/surface_binding.h"

#include "binding.h"
#include "module.h"

namespace vmesh::python {

/// Throws InvalidInput for a surface that is bound to none.
const Centerline& centerline_of(const SurfaceObject& surface);

/// vmesh.Deformation: a centerline that moves, and its surface.
class Deformation {
 public:
  Deformation(SurfacePtr surface, const Material& material, const SimulationOptions& options);

  CenterlineSimulation& simulation() { return simulation_; }
  const SurfacePtr& surface() const { return surface_; }
  double time() const { return static_cast<double>(steps_) * step_s_; }
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Vec3>& normals() const { return normals_; }
  const std::vector<Vec3>& nodes() const { return nodes_; }

  /// Advances without updating the surface.
  StepReport advance();
  /// Cuts centerline and surface; both stay where they are. Returns the nodes at the cut.
  std::array<Index, 2> cut(const CenterlineCut& cut);

  /// Clips a vessel within some time. Returns the nodes at which the profile narrows.
  std::vector<Index> clip(const SegmentPlace& place, const Clip& clip, double closing_s);

  /// Updates the surface.
  void synchronise();

 private:
  /// A node whose profile narrows to `scale`.
  struct Closing {
    Index node;
    double scale, from_s, duration_s;
  };

  void close_clips();

  /// Goes on with another surface at rest around the centerline that the simulation has now.
  void begin_again(SurfacePtr surface);

  void gather();

  SurfacePtr surface_;
  CenterlineSimulation simulation_;
  SurfaceBinding binding_;
  DeformedSurface lanes_;
  double step_s_;
  std::size_t steps_ = 0;
  std::vector<Vec3> vertices_, normals_, nodes_;
  std::vector<Closing> closing_;
  std::vector<std::vector<Vec3>> former_;  // arrays of before cuts and clips
};

}  // namespace vmesh::python
