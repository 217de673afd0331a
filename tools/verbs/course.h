#pragma once

#include <cstddef>
#include <vector>

namespace vmesh::tool {

/// A quantity over time: linear between its points, constant before the first and after the last.
template <class Value>
struct Course {
  std::vector<double> time_s;  ///< ascending, at least one
  std::vector<Value> value;

  Value at(double time) const {
    std::size_t next = 0;
    while (next < time_s.size() && time_s[next] <= time) ++next;
    if (next == 0) return value.front();
    if (next == time_s.size()) return value.back();
    const double part = (time - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
    return value[next - 1] + part * (value[next] - value[next - 1]);
  }
};

}  // namespace vmesh::tool
