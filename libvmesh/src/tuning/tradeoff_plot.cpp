#include "vmesh/tuning/plot.h"
#include "vmesh/tuning/tradeoff.h"

namespace vmesh {
namespace {

constexpr double kNoSurface = 0.5;  // mean error in radii beyond which a point is not plotted

template <class Cost>
LogPlot plot_of(const std::vector<TradeoffPoint>& points, const std::string& title, const std::string& label,
                Cost&& cost) {
  LogPlot plot{title, label, "mean error, mm", {}};
  for (const TradeoffPoint& point : points) {
    if (point.error_mean_relative > kNoSurface) continue;
    if (plot.curves.empty() || plot.curves.back().name != point.curve) plot.curves.push_back({point.curve, {}});
    plot.curves.back().points.emplace_back(cost(point), point.error_mean_mm);
  }
  return plot;
}

}  // namespace

std::string plot_tradeoff(const std::vector<TradeoffPoint>& points) {
  return svg_of({plot_of(points, "Error against time", "time, s", [](const TradeoffPoint& p) { return p.seconds; }),
                 plot_of(points, "Error against vertices", "vertices",
                         [](const TradeoffPoint& p) { return static_cast<double>(p.vertices); })});
}

}  // namespace vmesh
