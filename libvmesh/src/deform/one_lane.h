#pragma once

#include "deform/rod_batch.h"

namespace vmesh {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Reading and writing one lane: linear before angular.
inline Vec3 lane_of(const Lanes3& v, std::size_t i) { return {v.x[i], v.y[i], v.z[i]}; }
inline Vec6 lane_of(const LanesSpatial& v, std::size_t i) {
  Vec6 r;
  r << lane_of(v.linear, i), lane_of(v.angular, i);
  return r;
}
inline void add_lane(Lanes3& to, std::size_t i, const Vec3& v) { to.x[i] += v.x(), to.y[i] += v.y(), to.z[i] += v.z(); }
inline void set_lane_of(Lanes3& to, std::size_t i, const Vec3& v) { to.x[i] = v.x(), to.y[i] = v.y(), to.z[i] = v.z(); }
inline void set_lane_of(LanesSpatial& to, std::size_t i, const Vec6& v) {
  set_lane_of(to.linear, i, v.head<3>());
  set_lane_of(to.angular, i, v.tail<3>());
}

inline Mat6 lane_of(const LanesMatrix& m, std::size_t i) {
  Mat6 r;
  for (int row = 0, k = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column, ++k) r(row, column) = r(column, row) = m.entries[k][i];
  return r;
}
inline void set_lane_of(LanesMatrix& to, std::size_t i, const Mat6& m) {
  for (int row = 0, k = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column, ++k) to.entries[k][i] = m(row, column);
}

}  // namespace vmesh
