#pragma once

#include <vector>

#include "deform/rod_scene.h"

namespace vmesh {

/// A spring from a slot to where it rests, which tears.
struct TissueSpring {
  double stiffness = 0, tear = HUGE_VAL;  ///< mN/mm; mN
  Vec3 rest = Vec3::Zero();

  bool exists() const { return stiffness > 0; }
  double energy(const Vec3& at) const { return 0.5 * stiffness * (at - rest).squaredNorm(); }
  bool tears(const Vec3& at) const { return exists() && stiffness * (at - rest).norm() > tear; }
};

/// The springs of all slots; empty without tissue.
struct Tissue {
  std::vector<TissueSpring> springs;  ///< by slot
  std::size_t torn = 0;
};

}  // namespace vmesh
