#include "vmesh/quality/distribution.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

// Percentiles requested in ascending order: each search continues after the smaller values.
class Percentiles {
 public:
  explicit Percentiles(std::vector<double>& values) : values_(values), from_(values.begin()) {}

  double at(double share) {
    const double place = share * static_cast<double>(values_.size() - 1);
    const auto below = values_.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(from_, below, values_.end());
    from_ = below;
    if (below + 1 == values_.end()) return *below;
    const double above = *std::min_element(below + 1, values_.end());
    return *below + (place - std::floor(place)) * (above - *below);
  }

 private:
  std::vector<double>& values_;
  std::vector<double>::iterator from_;
};

}  // namespace

Distribution summarize(std::vector<double> values) {
  Distribution d;
  if (values.empty()) return d;
  d.count = values.size();
  double squares = 0;
  for (const double v : values) {
    d.mean += v;
    squares += v * v;
  }
  d.mean /= static_cast<double>(d.count);
  d.rms = std::sqrt(squares / static_cast<double>(d.count));
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  d.min = *min, d.max = *max;
  Percentiles percentiles(values);
  d.p5 = percentiles.at(0.05);
  d.p25 = percentiles.at(0.25);
  d.median = percentiles.at(0.5);
  d.p75 = percentiles.at(0.75);
  d.p95 = percentiles.at(0.95);
  d.p99 = percentiles.at(0.99);
  return d;
}

Histogram make_histogram(std::span<const double> values, double low, double high, std::size_t bins) {
  Histogram histogram{low, high, std::vector<std::size_t>(bins, 0)};
  if (bins == 0) return histogram;
  const double last = static_cast<double>(bins - 1), scale = high > low ? static_cast<double>(bins) / (high - low) : 0;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    ++histogram.counts[static_cast<std::size_t>(std::clamp(std::floor((v - low) * scale), 0.0, last))];
  }
  return histogram;
}

}  // namespace vmesh
