#pragma once

#include <optional>
#include <vector>

#include "surface/proof/kept_proof.h"

namespace vmesh {

/// How far faces are from the boundary that a step would bring: the integral of the distance to the power 1.5, mm^3.5,
/// from samples at corners, the middles of edges, and centres, weighted so that cubic functions are integrated exactly.
/// Samples are taken in single precision.
class StepDeviation {
 public:
  /// The faces around a step's vertex, with what they have in common wherever it goes.
  class Fan {
    friend class StepDeviation;

    struct Sector {
      Vec3 b, c;
      Index cone_of_b, cone_of_c;
      double most;                      // how far its samples may be off, as b and c have it
      double of_b, of_c;                // the distances of b and c, powered
      std::optional<double> of_middle;  // that between b and c, once it has been asked for
      bool is_middle_near = true;       // whether it is near enough
      std::size_t before;               // the sector whose c is this one's b, or none
      bool is_last = true;              // whether no sector begins with its c
    };

    std::vector<Sector> sectors_;
    double share_ = 0;
  };

  /// Keeps references.
  StepDeviation(const SweepState& state, const ErrorLimit& limit);

  /// Of a step whose samples may be off by `share` of the limit.
  Fan fan_of(const SurfaceStep& step, double share) const;

  /// With the step's vertex there; nothing if a sample is too far off. Corners that stay may be.
  std::optional<double> measure(Fan& fan, const BoundaryPoint& at) const;

  /// Of a face of the surface, wherever its samples are.
  double measure(Face f) const;

  /// Where the step's vertex deviates least near `p`: on the boundary, then moved by iteratively reweighted least
  /// squares, as if distances changed linearly, but no farther from the boundary than it may be.
  BoundaryPoint place(const Fan& fan, const Vec3& p, Index hint) const;

 private:
  // A sample that moves with the step's vertex.
  struct Moving {
    double distance = 0;
    Vec3 slope = Vec3::Zero();  // of the distance when the vertex moves
    double part = 0;            // of the vertex in the point
    double area = 0;
  };

  double most(double radius) const;
  double most(const BoundaryPoint& at) const;
  double radius_of(const BoundaryPoint& at) const;
  static std::vector<double> areas(const Fan& fan, const Vec3& p);
  static double area_before(const Fan& fan, const std::vector<double>& areas, std::size_t sector);
  std::vector<Moving> moving_samples(const Fan& fan, const BoundaryPoint& at) const;
  static Vec3 least_squares_move(const std::vector<Moving>& samples, double radius);
  static double reach_of(const Fan& fan, const Vec3& p);

  const SweepState& state_;
  const ErrorLimit& limit_;
  const VesselField rough_;
};

}  // namespace vmesh
