#pragma once

#include <string>
#include <vector>

namespace vmesh {

/// Curves on logarithmic axes.
struct LogPlot {
  struct Curve {
    std::string name;
    std::vector<std::pair<double, double>> points;  ///< joined in this order; points that are not positive are left out
    bool joined = true;
  };
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
};

/// The plots side by side with one legend, as an SVG image. Deterministic.
std::string svg_of(const std::vector<LogPlot>& plots);

}  // namespace vmesh
