// Accuracy of the deformer against time.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "vmesh/core/ascending.h"
#include "vmesh/deform/simulation.h"

#include "report/report_table.h"
#include "report/summary.h"

namespace vmesh::tool {

Centerline tree_of(std::size_t segments);

/// A tree in motion. The widest end's node is held, the last node is dragged around a circle of 10 mm, everything hangs
/// in the Earth's gravity: nothing is ever at rest.
class Swing {
 public:
  Swing(const Centerline& centerline, SimulationOptions options);

  StepReport step();
  CenterlineSimulation& simulation() { return simulation_; }
  const std::vector<Vec3>& positions() const { return simulation_.pose().position; }

 private:
  double step_s_, time_ = 0;
  Index tip_;
  CenterlineSimulation simulation_;
  Vec3 from_;
};

/// An integrator setting and its cost.
struct DeformTrade {
  static constexpr double kNoDistance = std::numeric_limits<double>::quiet_NaN();

  std::string integrator;
  double step_ms = 0;
  int iterations = 0;       ///< Gauss-Newton iterations, or substeps, of a step
  double frame_cpu_ms = 0;  ///< per frame of 20 ms
  /// Distances of nodes at the frames of 1 s: from many iterations of the same step, if it iterates, and from
  /// the limit of ever shorter steps.
  double unconverged_mean_mm = kNoDistance, unconverged_max_mm = kNoDistance;
  double off_mean_mm = 0, off_max_mm = 0;
};

std::vector<DeformTrade> measure_deform_trades(std::size_t segments);
ReportTable trade_table(const std::vector<DeformTrade>& trades);
Json to_json(const DeformTrade& trade);
/// An SVG image: distance against time, a curve per integrator and number of iterations.
std::string plot_deform_trades(const std::vector<DeformTrade>& trades);

/// `value` with a suitable number of digits for a table.
std::string fixed(double value);

}  // namespace vmesh::tool
