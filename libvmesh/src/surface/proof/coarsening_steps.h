#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "surface/proof/step_deviation.h"
#include "surface/remesh/elongated_metric.h"

namespace vmesh {

/// How many times longer than wide triangles may be at a place of the vessels.
using LongestAt = std::function<Elongation(const CenterlineBinding&)>;

struct CoarseningStep : SurfaceStep {
  double cost = 0;  ///< by how much the deviation grows (StepDeviation)
};

/// The best way to collapse, split or flip an edge or to move a vertex, if there is one that leaves the faces
/// well-shaped and, at samples, within the limit. Neither crossings nor the proof of the limit are looked at.
class CoarseningSteps {
 public:
  /// Keeps references. `worst_skewness`: of a face in the metric of `longest`, unless one that it replaces was worse.
  /// `is_fixed`: faces that no step may replace.
  CoarseningSteps(const SweepState& state, const ErrorLimit& limit, const LongestAt& longest, double worst_skewness,
                  std::function<bool(Face)> is_fixed);

  /// To a vertex at the middle or at either end, from there to where it deviates least. Its vertex is the first of `e`.
  std::optional<CoarseningStep> collapse(Edge e) const;

  /// At the middle, from there to where it deviates least. Its vertex is null_vertex(), as it is yet to be made.
  std::optional<CoarseningStep> split(Edge e) const;

  /// Nothing unless it brings the faces closer.
  std::optional<CoarseningStep> flip(Edge e) const;

  /// Between its neighbours. Nothing unless it brings the faces closer.
  std::optional<CoarseningStep> move(Vertex v) const;

  /// Tells that these vertices and the faces around them have changed.
  void note(const std::vector<Vertex>& changed);

 private:
  BoundaryPoint exact(const BoundaryPoint& at) const;
  bool replaces_fixed(const CoarseningStep& step) const;
  bool measure(CoarseningStep& step, StepDeviation::Fan& fan) const;
  bool is_well_shaped(const CoarseningStep& step) const;
  double enough_gain(const CoarseningStep& step) const;
  double deviation_before(const CoarseningStep& step) const;
  double skewness_of(Face f) const;
  Elongation longest_at(Vertex v) const { return longest_({surface_[v].cone, surface_[v].t}); }

  const SweepState& state_;
  const BoundSurface& surface_;
  const SurfaceMesh& mesh_;
  StepDeviation measure_;
  const LongestAt& longest_;
  double worst_skewness_;
  bool has_limit_;
  std::function<bool(Face)> is_fixed_;
  std::vector<Elongation> elongation_;  // by vertex
  std::vector<double> deviation_;       // by face
};

}  // namespace vmesh
