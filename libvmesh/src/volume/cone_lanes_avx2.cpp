#include <cmath>

#include "vmesh/core/avx2_build.h"

#include "volume/cone_lanes.h"

#if VMESH_AVX2_BUILD

#pragma GCC target("avx2")

namespace vmesh {
namespace avx2 {
namespace {

#include "volume/cone_lanes_body.h"

}  // namespace
}  // namespace avx2

LaneSampler avx2_lane_sampler() { return has_avx2() ? avx2::run : nullptr; }

}  // namespace vmesh

#else

vmesh::LaneSampler vmesh::avx2_lane_sampler() { return nullptr; }

#endif
