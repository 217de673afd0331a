#pragma once

#include <span>
#include <vector>

namespace vmesh {

/// Summary statistics of a set of numbers; all zero if it is empty.
struct Distribution {
  std::size_t count = 0;
  double min = 0, max = 0;
  double mean = 0;
  double rms = 0;  ///< root of the mean square, about zero
  /// Percentiles, interpolated linearly between neighbouring values.
  double p5 = 0, p25 = 0, median = 0, p75 = 0, p95 = 0, p99 = 0;
};

/// Takes the values by copy. O(n). Values must not be NaN.
Distribution summarize(std::vector<double> values);

/// Counts in bins of equal width from `low` to `high`; values outside count in the first or last bin, NaN does not
/// count.
struct Histogram {
  double low = 0, high = 0;
  std::vector<std::size_t> counts;
};
Histogram make_histogram(std::span<const double> values, double low, double high, std::size_t bins);

}  // namespace vmesh
