#pragma once

#include <vector>

#include "deform/rod_scene.h"
#include "deform/slot_origin.h"

namespace vmesh {

/// The paper's procedure, explicit: springs move the nodes and the tips of the axes, each on its own; then the axes are
/// made orthonormal and the segments aligned with them (Eqs. 4 to 8). See PaperProcedure.
class PaperRods {
 public:
  explicit PaperRods(const RodScene& scene);

  StepReport step(RodScene& scene) noexcept;
  /// Goes on where another one is, after a cut of its scene `old`.
  void carry_on(const PaperRods& before, const RodScene& old, const RodScene& scene,
                const std::vector<SlotOrigin>& origin);

 private:
  void add_forces(const RodScene& scene);
  void add_spring(const RodScene& scene, Index j);
  void add_angular_springs(const RodScene& scene, Index j);
  double move(RodScene& scene);
  void align(RodScene& scene, Index j) const;

  int substeps_;
  double dt_s_;
  std::vector<Vec3> force_, start_;
  std::vector<Mat3> tip_force_, tip_velocity_;
};

}  // namespace vmesh
