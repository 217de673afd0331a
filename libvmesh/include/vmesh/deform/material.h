#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// Material parameters of a vessel, as measured.
struct Material {
  double young_Pa = 1e6;        ///< Young's modulus, > 0
  double density_kg_m3 = 1060;  ///< > 0
  double poisson_ratio = 0.5;   ///< in [0, 0.5]; 0 gives the paper's equal springs for bending and twist
  double wall_mm = 0;           ///< thickness of the wall; 0: wall_ratio decides
  double wall_ratio = 1;        ///< thickness in local radii, in (0, 1]; 1 is solid
  double damping_s = 0.01;      ///< viscosity over stiffness, the time in which a stretch relaxes; >= 0
};

/// The springs and the mass of one segment between the lumped masses of its nodes.
struct SegmentProperties {
  double stretch_N = 0;       ///< E A
  double bend_N_mm2 = 0;      ///< E J
  double twist_N_mm2 = 0;     ///< G 2J; at most twice bend_N_mm2
  double mass_kg = 0;         ///< half of it at either node
  double inertia_kg_mm2 = 0;  ///< of the cross-sections about a diameter: mass J / A
  double damping_s = 0;       ///< see Material
  double squeeze_N_mm2 = 0;   ///< pressure at which the profile shrinks to half: E t / r
};

/// Springs and masses of every segment from its material (Young's modulus and the tube's area and second moment at the
/// mean radius). A segment shorter than a thousandth of its radius counts as that long. Throws InvalidInput naming the
/// value out of range.
std::vector<SegmentProperties> segment_properties(const Centerline& centerline, const Material& material);

}  // namespace vmesh
