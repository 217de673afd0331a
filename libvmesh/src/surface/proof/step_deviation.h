#pragma once

#include "surface/proof/kept_proof.h"

namespace vmesh {

/// How far faces are from the boundary that a step would bring, at samples: corners, the middles of edges, and centres,
/// weighted so that cubic functions are integrated exactly.
class StepDeviation {
 public:
  struct Measured {
    double largest = 0;    ///< in limits; corners that stay do not count
    double deviation = 0;  ///< integral of the distance to the power 1.5, mm^3.5
  };

  /// Keeps references.
  StepDeviation(const SweepState& state, const ErrorLimit& limit) : state_(state), limit_(limit) {}

  Measured measure(const SurfaceStep& step) const;

  /// Of a face of the surface.
  Measured measure(Face f) const;

  /// Puts the step's vertex near `p`: on the boundary, then to where the deviation is least by iteratively reweighted
  /// least squares, as if distances changed linearly, but no farther from the boundary than `share` of the limit.
  void place(SurfaceStep& step, const Vec3& p, Index hint, double share) const;

  /// How far the surface may be from the boundary at a place of this radius: never so far that it loses the axis.
  double most(double radius) const;

 private:
  enum class Samples { all, moving };  // moving: those that move with the step's vertex

  Vec3 least_squares_move(const SurfaceStep& step) const;
  double reach_of(const SurfaceStep& step) const;

  template <class Visit>
  void visit_samples(Samples which, const SurfaceStep& step, Visit&& visit) const;

  const SweepState& state_;
  const ErrorLimit& limit_;
};

}  // namespace vmesh
