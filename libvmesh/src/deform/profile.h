#pragma once

#include <vector>

#include "deform/rod_scene.h"
#include "deform/slot_origin.h"

namespace vmesh {

/// The vessel's cross-section at every slot, scaled by the user and by squeezing. The wall responds to a pressure p
/// like a thin-walled tube at small strain, by r p / (E t), and ever less the narrower it is: scale 1 / (1 + r p / (E
/// t)).
class Profile {
 public:
  Profile(const Centerline& centerline, const std::vector<SegmentProperties>& properties,
          const SimulationOptions& options);

  /// Goes on where another one is, after a cut.
  void carry_on(const Profile& before, const std::vector<SlotOrigin>& origin);

  void set_scale(Index slot, double scale, RodScene& scene);
  void set_squeeze(Index slot, double force_N, RodScene& scene);
  /// Follows the squeezes by one time step. Does nothing unless something was set.
  void step(RodScene& scene) noexcept;

 private:
  void set_area_and_stiffness(const Centerline& centerline, const std::vector<SegmentProperties>& properties);
  void enable(RodScene& scene);
  void set(std::vector<double>& values, Index slot, double value, const RodTree& tree);

  double follow_;  // fraction of the difference to the new scale covered in one step
  bool settled_ = true;
  std::vector<double> area_mm2_, stiffness_N_mm2_;  // by node
  std::vector<double> scale_, squeezed_, goal_;     // by slot; empty while off
};

}  // namespace vmesh
