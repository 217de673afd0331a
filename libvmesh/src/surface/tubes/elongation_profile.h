#pragma once

#include <span>
#include <vector>

#include "surface/tubes/branch_axis.h"

namespace vmesh {

struct Ring;
struct RingOptions;

/// How much longer than wide triangles may be along a branch: linear between samples, 1 outside. Places are integrals
/// of ds / radius, as in BranchAxis::radii_of(). Samples follow each other; runs of them begin and end with 1.
class ElongationProfile {
 public:
  void add(double radii, double elongation);
  /// Adds a run; where it does not begin or end with 1, the elongation fades to that over `fade` radii.
  void append(const ElongationProfile& next, double fade);
  double at(double radii) const;

  /// Places from the first sample to the last, the next `step` times the elongation farther each, but for rounding to
  /// whole steps.
  std::vector<double> spread(double step) const;

 private:
  std::vector<double> radii_, elongation_;
};

/// The elongation along a run of rings that lie `step` apart: as far as the error allows, at most options.elongation,
/// and 1 at both ends; from one ring to the next it grows by at most a half.
/// The error is the distance of the vessel's axis and wall from what is straight between two rings. It may reach what
/// edges across the vessel cut off anyway; with a limit on the error, what they leave of that.
ElongationProfile elongation_of_run(const BranchAxis& axis, std::span<const Ring> run, double step,
                                    const RingOptions& options);

}  // namespace vmesh
