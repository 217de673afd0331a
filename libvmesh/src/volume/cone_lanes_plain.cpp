#include <cmath>

#include "volume/cone_lanes.h"

namespace vmesh {
namespace plain {
namespace {

#include "volume/cone_lanes_body.h"

}  // namespace
}  // namespace plain

LaneSampler plain_lane_sampler() { return plain::run; }

LaneSampler best_lane_sampler() {
  static const LaneSampler best = avx2_lane_sampler() ? avx2_lane_sampler() : plain_lane_sampler();
  return best;
}

}  // namespace vmesh
